#include "fluid_solver/paper_formulation.hpp"

#include "fluid_solver/chunks.hpp"
#include "fluid_solver/fluid.hpp"

#include <algorithm>
#include <atomic>

namespace duet::fluid::paper {

Rates::Rates(double spacing, int threads)
    : smoothing_length_(smoothing_length_in_spacings * spacing), threads_(threads) {}

namespace {

/// A ghost as the sums over it need it.
struct Ghost {
    const Contact* contact;
    Vec2 r; ///< from the particle
    double d2, volume;
    WallPoint wall;
};

struct Scratch {
    Surroundings surroundings;
    Neighbours near;
    std::vector<Contact> contacts;
    std::vector<Ghost> ghosts;
};

} // namespace

void Rates::run(const Particles& particles,
                const CellGrid& grid,
                const Boundary& boundary,
                const Ghosts& lattice,
                const Hydrostatics& hydrostatics,
                const Material& material,
                double volume,
                std::span<const Vec2> body_force) {
    const std::size_t n = particles.size();
    const double h = smoothing_length_, mass = material.density * volume;
    const double c2 = material.sound_speed * material.sound_speed;
    const auto density = [&](double p) { return material.density + p / c2; }; // (42)
    acceleration.resize(n);
    heating.resize(n);
    shift.resize(n);
    mean_distance.resize(n);
    transfers.resize(chunks_of(n));
    kept_.resize(chunks_of(n));
    std::atomic<bool> crowded{false};

    const auto one = [&](std::size_t a, std::size_t chunk, Scratch& s) {
        const Vec2 x = particles.position(a);
        const Fields& f = particles.fields[a];
        const double rho = density(f.p);
        if (!s.surroundings.collect(particles, grid, grid.column(x.x), grid.row(x.y))
            || !s.surroundings.find(x, static_cast<float>(support()), s.near)) {
            crowded = true;
            return;
        }
        s.contacts.clear();
        s.ghosts.clear();
        if (boundary.near(x)) {
            boundary.contacts(x, s.contacts);
            s.near.filter([&](std::size_t k) {
                return !Ghosts::hidden(s.contacts, {-s.near.x[k], -s.near.y[k]});
            });
        }
        for (const Contact& contact : s.contacts) {
            lattice.for_each(
                contact,
                s.contacts,
                support(),
                [&](Vec2 r, double d2, double ghost_volume, double fraction) {
                    const double arc = contact.foot + fraction * dot(r, contact.tangent);
                    s.ghosts.push_back(
                        {&contact, r, d2, ghost_volume, boundary.at(*contact.face, arc)});
                });
        }

        // Neighbours are found in single precision; both sides of a pair must see the same distance
        // for its heat to balance.
        // (45)-(47): M = sum V (x_b - x_a) gradW^T.
        Mat2 M;
        double distances = 0;
        for (std::size_t k = 0; k < s.near.count; ++k) {
            const Vec2 x_ab = grid.shortest(x - particles.position(s.near.index[k]));
            distances += norm(x_ab);
            M += outer(-volume * slope_over_r(norm(x_ab), h) * x_ab, x_ab);
        }
        for (const Ghost& g : s.ghosts) {
            M += outer(-g.volume * slope_over_r(norm(g.r), h) * g.r, g.r);
        }
        const Mat2 L = determinant(M) > 0.1 ? inverse(M) : Mat2{1, 0, 0, 1};
        mean_distance[a] = s.near.count > 0 ? distances / static_cast<double>(s.near.count) : 0;

        const Vec2 extra = body_force.empty() ? Vec2{} : body_force[a];
        const Vec2 b = extra + hydrostatics.force(f.T);
        Vec2 accelerated = b, shifted;
        double warmed = 0;
        const double eta2 = 0.01 * h * h;
        for (std::size_t k = 0; k < s.near.count; ++k) {
            const Vec2 x_ab = grid.shortest(x - particles.position(s.near.index[k]));
            const Fields& g = particles.fields[s.near.index[k]];
            const Pair pair{x_ab, slope_over_r(norm(x_ab), h), mass, rho, density(g.p), eta2};
            const Vec2 gradient = L * (pair.F * x_ab);
            accelerated += pressure_acceleration(pair, f.p, g.p, gradient);
            accelerated += viscous_acceleration(pair, material.viscosity, {f.u - g.u, f.v - g.v});
            warmed += paper::heating(pair, material.conductivity, f.T - g.T);
            shifted += shift_term(x_ab, 1);
            kept_[chunk].push_back({static_cast<std::uint32_t>(a),
                                    s.near.index[k],
                                    (mass / pair.density_b) * gradient,
                                    {}});
        }
        for (const Ghost& g : s.ghosts) {
            const Vec2 normal = g.contact->normal, x_ab = -g.r;
            // d1 is bounded where a particle comes close to the wall.
            const double d1 = std::max(g.contact->distance, lattice.least_distance());
            const double p =
                f.p + material.density * dot(b - g.wall.acceleration, normal) * dot(g.r, normal);
            const double rho_b = density(p);
            const Pair pair{x_ab, slope_over_r(norm(x_ab), h), rho_b * g.volume, rho, rho_b, eta2};
            const Vec2 gradient = L * (pair.F * x_ab);
            const Vec2 v_w{g.wall.value[0], g.wall.value[1]}, v_a{f.u, f.v};
            const Vec2 v_b = ghost_value(v_w, v_a, g.d2, d1);
            const Vec2 dv = pressure_acceleration(pair, f.p, p, gradient)
                            + viscous_acceleration(pair, material.viscosity, v_a - v_b);
            const bool heated = g.contact->face->heated;
            const double T_b =
                heated ? ghost_value(static_cast<double>(g.wall.value[3]), f.T, g.d2, d1)
                       : f.T + g.wall.value[3] * dot(g.r, normal); // known slope
            const double dT = paper::heating(pair, material.conductivity, f.T - T_b);
            accelerated += dv;
            warmed += dT;
            shifted += shift_term(x_ab, g.volume / volume);
            const std::uint32_t cell = boundary.cell_at(*g.wall.segment, g.wall.along);
            transfers[chunk].push_back(
                {static_cast<std::uint32_t>(a), cell, -mass * dv, mass * dT});
            kept_[chunk].push_back({static_cast<std::uint32_t>(a),
                                    none,
                                    (g.volume * (1 + g.d2 / d1)) * gradient,
                                    v_w});
        }
        acceleration[a] = accelerated;
        heating[a] = warmed / material.heat_capacity;
        shift[a] = shifted;
    };
    for_chunks(n, threads_, [&](std::size_t chunk, std::size_t first, std::size_t last) {
        static thread_local Scratch s;
        transfers[chunk].clear();
        kept_[chunk].clear();
        for (std::size_t a = first; a < last; ++a) {
            one(a, chunk, s);
        }
    });
    if (crowded) {
        throw Diverged(
            "a fluid particle has too many neighbours: the cloud has collapsed; raise the "
            "sound speed or take the consistent formulation");
    }
}

void Rates::compress(const Particles& particles, const Material& material) {
    const std::size_t n = particles.size();
    const double c2 = material.sound_speed * material.sound_speed;
    pressure_rate.assign(n, 0);
    for_chunks(n, threads_, [&](std::size_t chunk, std::size_t, std::size_t) {
        for (const Kept& pair : kept_[chunk]) {
            const Fields& f = particles.fields[pair.particle];
            Vec2 other = pair.wall_velocity;
            if (pair.neighbour != none) {
                other = {particles.fields[pair.neighbour].u, particles.fields[pair.neighbour].v};
            }
            const double density = material.density + f.p / c2;
            pressure_rate[pair.particle] +=
                c2 * density_rate(density, Vec2{f.u, f.v} - other, pair.gradient);
        }
    });
}

} // namespace duet::fluid::paper
