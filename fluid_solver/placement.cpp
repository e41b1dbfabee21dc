// The particles at t = 0.

#include "fluid_solver/implementation.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace duet::fluid {

/// Puts particles on a square lattice aligned with the region's lower left corner, half a cell off,
/// stretched to fit a whole number of times into a period, and keeps those in the fluid. Where the
/// boundary does not fit the lattice their number is brought as near to area/dx^2 as can be by
/// leaving out those closest to the boundary; a particle's volume is then area/N, and the cloud is
/// relaxed before the start.
void Fluid::Implementation::fill() {
    const double dx = config.spacing;
    Vec2 lower = config.region[0], upper = config.region[0];
    for (const Vec2 c : config.region) {
        lower = {std::min(lower.x, c.x), std::min(lower.y, c.y)};
        upper = {std::max(upper.x, c.x), std::max(upper.y, c.y)};
    }
    struct Place {
        Vec2 x;
        double distance;
    };
    std::vector<Place> places;
    const Vec2 period = grid_.period();
    const Vec2 apart{period.x > 0 ? period.x / std::round(period.x / dx) : dx,
                     period.y > 0 ? period.y / std::round(period.y / dx) : dx};
    for (int j = 0; lower.y + (j + 0.5) * apart.y < upper.y; ++j) {
        for (int i = 0; lower.x + (i + 0.5) * apart.x < upper.x; ++i) {
            const Vec2 x = lower + Vec2{(i + 0.5) * apart.x, (j + 0.5) * apart.y};
            if (boundary_.contains(x)) {
                places.push_back({x, boundary_.distance(x)});
            }
        }
    }
    const double area = boundary_.area();
    const auto wanted = static_cast<std::size_t>(std::llround(area / (apart.x * apart.y)));
    const bool fits =
        places.size() == wanted && std::all_of(places.begin(), places.end(), [&](const Place& p) {
            return p.distance > 0.4 * dx;
        });
    if (!fits) {
        std::vector<double> distances;
        for (const Place& p : places) {
            distances.push_back(p.distance);
        }
        std::sort(distances.begin(), distances.end());
        const std::size_t surplus = places.size() > wanted ? places.size() - wanted : 0;
        const double least = std::max(0.1 * dx, surplus > 0 ? distances[surplus - 1] : 0.0);
        std::erase_if(places, [&](const Place& p) { return p.distance <= least; });
    }
    if (places.empty()) {
        throw SceneError("the fluid's region holds no particle; give it more than one spacing of "
                         "room beside the solids");
    }
    particles.resize(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        particles.x[i] = places[i].x.x;
        particles.y[i] = places[i].x.y;
        particles.identity[i] = static_cast<std::uint32_t>(i);
        particles.compartment[i] = 0;
    }
    volume = area / static_cast<double>(places.size());
    disturb();
    if (!fits) {
        relax();
    }
    for (std::size_t a = 0; a < particles.size(); ++a) {
        const Vec2 x = particles.position(a), v = config.initial_velocity(x, 0);
        particles.fields[a] = {v.x, v.y, 0, config.initial_temperature(x, 0)};
    }
    find_compartments();
}

/// Moves each particle at random by up to `disorder` spacings along x and y.
void Fluid::Implementation::disturb() {
    if (config.disorder == 0) {
        return;
    }
    std::mt19937 random(config.seed);
    const auto symmetric = [&] {
        return 2 * (static_cast<double>(random()) + 0.5) / 4294967296.0 - 1;
    };
    for (std::size_t i = 0; i < particles.size(); ++i) {
        particles.x[i] += config.disorder * config.spacing * symmetric();
        particles.y[i] += config.disorder * config.spacing * symmetric();
    }
    wrap();
    put_inside();
}

/// Puts what lies behind a wall to a tenth of a spacing before it; in a corner, before both sides.
void Fluid::Implementation::put_inside() {
    for_particles(particles.size(), config.threads, [&](std::size_t a) {
        for (int side = 0; side < 2 && boundary_.near(particles.position(a)); ++side) {
            const auto wall = boundary_.nearest(particles.position(a));
            if (wall.distance > 0) {
                break;
            }
            put(a, wall.point - clearance * config.spacing * wall.face->normal);
        }
    });
}

/// Evens out the cloud by shifting alone.
void Fluid::Implementation::relax() {
    const double dx = config.spacing;
    for (int i = 0; i < 200; ++i) {
        particles.sort(grid_);
        evaluation_.run(particles, grid_, boundary_, {dx, volume, 0, 0, 0.3 * dx * dx, false});
        move(0, true);
        put_inside();
    }
}

/// Connected parts of the fluid: particles that are neighbours, and not hidden from each other by a
/// wall, belong together.
void Fluid::Implementation::find_compartments() {
    particles.sort(grid_);
    evaluation_.run(particles, grid_, boundary_, {config.spacing, volume, 0, 0, 0, false});
    const std::size_t n = particles.size();
    std::vector<std::uint32_t> parent(n);
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t i) {
        while (parent[i] != i) {
            i = parent[i] = parent[parent[i]];
        }
        return i;
    };
    for (std::size_t a = 0; a < n; ++a) {
        for (const PairBlock& block : evaluation_.pairs(a)) {
            for (const std::uint32_t b : block.index) {
                const std::uint32_t p = root(static_cast<std::uint32_t>(a)), q = root(b);
                parent[std::max(p, q)] = std::min(p, q);
            }
        }
    }
    std::vector<std::uint32_t> roots;
    for (std::size_t a = 0; a < n; ++a) {
        const std::uint32_t r = root(static_cast<std::uint32_t>(a));
        auto known = std::find(roots.begin(), roots.end(), r);
        if (known == roots.end()) {
            if (roots.size() == 1024) {
                throw SceneError("the fluid falls into more than 1024 separate parts; refine the "
                                 "spacing or close the gaps between the solids");
            }
            known = roots.insert(roots.end(), r);
        }
        particles.compartment[a] = static_cast<std::uint16_t>(known - roots.begin());
    }
    compartments = roots.size();
}

} // namespace duet::fluid
