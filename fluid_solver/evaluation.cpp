#include "fluid_solver/evaluation.hpp"

#include "fluid_solver/fluid.hpp"
#include "fluid_solver/shifting.hpp"

#include <atomic>
#include <cstring>

namespace duet::fluid {

Evaluation::Evaluation(double spacing, int threads)
    : threads_(threads), kernel_(support_in_spacings * spacing), ghosts_(spacing),
      sample_depth_(1.5 * spacing) {}

void Evaluation::resize(std::size_t n) {
    L.resize(n);
    slope_x.resize(n);
    slope_y.resize(n);
    viscous.resize(n);
    heating.resize(n);
    shift.resize(n);
    wall.resize(n);
    near_wall.resize(n);
    near_heated.resize(n);
    count.resize(n);
    samples.resize(chunks_of(n));
    pairs_.resize(n * stride_);
}

namespace {

/// Sums over the neighbours of one particle, by lanes u, v, p, T.
struct PairSums {
    Lanes gradient_x{}, gradient_y{}; ///< sum w (f_b - f_a)
    Lanes laplacian{};                ///< sum 2 V F (e.B e)(f_a - f_b)
};

/// weight(k) is a number, or four where the temperature has a tensor B of its own.
template <class Weight>
PairSums pair_sums(const Particles& particles,
                   std::size_t a,
                   const Neighbours& near,
                   const Weights& w,
                   const Weight& weight) {
    PairSums sums;
    const Lanes fa = load(particles.fields[a]);
    for (int i = 0; i < near.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const Lanes difference = load(particles.fields[near.index[k]]) - fa;
        sums.gradient_x += w.x[k] * difference;
        sums.gradient_y += w.y[k] * difference;
        sums.laplacian -= weight(k) * difference;
    }
    return sums;
}

/// 2 V F (e.B e) of every neighbour.
void laplacian_weights(const Symmetric& B,
                       const Neighbours& near,
                       const Weights& w,
                       std::array<double, most_neighbours>& out) {
    for (int i = 0; i < near.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const double x = near.x[k], y = near.y[k];
        out[k] = 2 * w.F[k] * (B[0] * x * x + 2 * B[1] * x * y + B[2] * y * y) / near.r2[k];
    }
}

/// Lays the weights of the neighbours out pair by pair, four pairs at a time (the room for a
/// particle's pairs is a multiple of four).
void interleave(const Weights& w, const Neighbours& near, PairWeight* pairs) {
    using Four = float __attribute__((vector_size(16)));
    const auto take = [](const auto& from, std::size_t k) {
        Four values;
        std::memcpy(&values, &from[k], sizeof values);
        return values;
    };
    for (std::size_t k = 0; k < static_cast<std::size_t>(near.count); k += 4) {
        const Four x = take(w.x_float, k), y = take(w.y_float, k), F = take(w.F_float, k);
        const Four index = take(near.index, k);
        const Four xy01 = __builtin_shufflevector(x, y, 0, 4, 1, 5);
        const Four xy23 = __builtin_shufflevector(x, y, 2, 6, 3, 7);
        const Four Fi01 = __builtin_shufflevector(F, index, 0, 4, 1, 5);
        const Four Fi23 = __builtin_shufflevector(F, index, 2, 6, 3, 7);
        const Four rows[4] = {__builtin_shufflevector(xy01, Fi01, 0, 1, 4, 5),
                              __builtin_shufflevector(xy01, Fi01, 2, 3, 6, 7),
                              __builtin_shufflevector(xy23, Fi23, 0, 1, 4, 5),
                              __builtin_shufflevector(xy23, Fi23, 2, 3, 6, 7)};
        std::memcpy(static_cast<void*>(pairs + k), rows, sizeof rows);
    }
}

void drop_hidden(const std::vector<Contact>& contacts, Neighbours& near) {
    for (int i = near.count - 1; i >= 0; --i) {
        const auto k = static_cast<std::size_t>(i);
        if (Ghosts::hidden(contacts, {-near.x[k], -near.y[k]})) {
            near.drop(i);
        }
    }
}

/// The part of a particle's shift that keeps it off the walls: -0.2 (0.3 dx - d1)+ n.
Vec2 push_off(const std::vector<Contact>& contacts, double spacing) {
    Vec2 push;
    for (const Contact& contact : contacts) {
        if (contact.on_face()) {
            push -= wall_push(contact.distance, spacing) * contact.face->normal;
        }
    }
    return push;
}

} // namespace

/// What one thread needs for one particle at a time.
struct Evaluation::Scratch {
    Neighbours near;
    Weights weights;
    Moments moments;
    alignas(32) std::array<double, most_neighbours> laplacian, laplacian_T;
    std::vector<Contact> contacts;
    WallSums walls;
};

bool Evaluation::gather(std::size_t a, const Particles& particles, const Scene& scene, Scratch& s) {
    const Vec2 x = particles.position(a);
    if (!find_neighbours(particles, scene.grid, kernel_.support(), a, s.near)) {
        return false;
    }
    s.contacts.clear();
    if (scene.boundary.near(x)) {
        scene.boundary.contacts(x, s.contacts);
    }
    near_wall[a] = !s.contacts.empty();
    if (near_wall[a]) {
        drop_hidden(s.contacts, s.near);
    }
    count[a] = static_cast<std::uint8_t>(s.near.count);
    if (count[a] > stride_) {
        return false;
    }
    weigh(kernel_, scene.input.volume, s.near, s.weights);
    interleave(s.weights, s.near, &pairs_[a * stride_]);
    s.moments = moments(s.near, s.weights);
    return true;
}

void Evaluation::store_diffusion(std::size_t a, const EvaluationInput& input, const Lanes& lap) {
    viscous[a] = {input.viscosity * lap[0], input.viscosity * lap[1]};
    heating[a] = input.diffusivity * lap[3];
}

void Evaluation::interior(std::size_t a,
                          const Particles& particles,
                          const Scene& scene,
                          Scratch& s) {
    const Moments& m = s.moments;
    near_heated[a] = 0;
    L[a] = correction(m, {});
    const LaplacianTensor t = laplacian_tensor(m, gradient_error(m, L[a], {}), {});
    laplacian_weights(t.B, s.near, s.weights, s.laplacian);
    const PairSums sums =
        pair_sums(particles, a, s.near, s.weights, [&](std::size_t k) { return s.laplacian[k]; });
    const Lanes gx = L[a].xx * sums.gradient_x + L[a].xy * sums.gradient_y;
    const Lanes gy = L[a].yx * sums.gradient_x + L[a].yy * sums.gradient_y;
    store(slope_x[a], gx);
    store(slope_y[a], gy);
    store_diffusion(a, scene.input, sums.laplacian - t.E.x * gx - t.E.y * gy);
    shift[a] = shift_vector(
        m.gradient_of_concentration, {}, scene.input.shift_factor, scene.input.spacing);
}

template <bool Heat>
void Evaluation::beside_walls(std::size_t a,
                              const Particles& particles,
                              const Scene& scene,
                              Scratch& s) {
    const Moments& m = s.moments;
    const WallSums& w = s.walls;
    ghosts_.sums(particles.position(a), scene.boundary, s.contacts, s.walls);
    near_heated[a] = w.temperature.K != 0;

    // Velocity and temperature have tensors of their own: not every wall is heated, and beside two
    // faces their sums differ from the pressure's.
    L[a] = correction(m, w.N_n);
    const Mat2 Lv = correction(m, w.velocity.S_xi);
    const LaplacianTensor v =
        laplacian_tensor(m, gradient_error(m, Lv, w.velocity.S_xi_xi), w.velocity);
    laplacian_weights(v.B, s.near, s.weights, s.laplacian);
    Mat2 LT = Lv;
    LaplacianTensor T = v;
    if constexpr (Heat) {
        LT = correction(m, w.temperature.S_xi + w.adiabatic.N_n);
        T = laplacian_tensor(
            m, gradient_error(m, LT, w.temperature.S_xi_xi + w.adiabatic.N_d_n_n), w.temperature);
        laplacian_weights(T.B, s.near, s.weights, s.laplacian_T);
    } else {
        s.laplacian_T = s.laplacian;
    }
    const PairSums sums = pair_sums(particles, a, s.near, s.weights, [&](std::size_t k) {
        return Lanes{s.laplacian[k], s.laplacian[k], 0, s.laplacian_T[k]};
    });
    const Lanes fa = load(particles.fields[a]);
    const Lanes Sx{w.velocity.S.x, w.velocity.S.x, 0, w.temperature.S.x};
    const Lanes Sy{w.velocity.S.y, w.velocity.S.y, 0, w.temperature.S.y};
    const Lanes K{w.velocity.K, w.velocity.K, 0, w.temperature.K};
    const Lanes rx = sums.gradient_x + w.Sx_value - Sx * fa;
    const Lanes ry = sums.gradient_y + w.Sy_value - Sy * fa;
    // (The pressure's slope is made by the inner steps, with the body force of the moment.)
    const Lanes gx = Lanes{Lv.xx, Lv.xx, 0, LT.xx} * rx + Lanes{Lv.xy, Lv.xy, 0, LT.xy} * ry;
    const Lanes gy = Lanes{Lv.yx, Lv.yx, 0, LT.yx} * rx + Lanes{Lv.yy, Lv.yy, 0, LT.yy} * ry;
    store(slope_x[a], gx);
    store(slope_y[a], gy);
    const Lanes Ex{v.E.x, v.E.x, 0, T.E.x}, Ey{v.E.y, v.E.y, 0, T.E.y};
    store_diffusion(a, scene.input, sums.laplacian - (w.K_value - K * fa) - Ex * gx - Ey * gy);
    wall[a] = {Lv,
               L[a] * w.N_n,
               L[a] * w.N_acceleration,
               Lv * w.velocity.S,
               Lv.xx * w.Sx_value[0] + Lv.xy * w.Sy_value[0] + Lv.yx * w.Sx_value[1]
                   + Lv.yy * w.Sy_value[1]};
    shift[a] = shift_vector(m.gradient_of_concentration + w.C,
                            push_off(s.contacts, scene.input.spacing),
                            scene.input.shift_factor,
                            scene.input.spacing);
}

void Evaluation::take_samples(std::size_t a,
                              const Boundary& boundary,
                              const std::vector<Contact>& contacts,
                              std::vector<WallSample>& out) const {
    for (const Contact& contact : contacts) {
        if (contact.distance < sample_depth_ && contact.on_face()) {
            const WallPoint point = boundary.at(*contact.face, contact.foot);
            const std::uint32_t cell = boundary.cell_at(*point.segment, point.along);
            out.push_back({static_cast<std::uint32_t>(a),
                           cell,
                           contact.distance,
                           (point.along - boundary.cells()[cell].centre) * point.segment->length,
                           point.value,
                           dot(point.acceleration, contact.face->normal)});
        }
    }
}

template <bool Heat>
bool Evaluation::run_chunk(std::size_t chunk,
                           std::size_t first,
                           std::size_t last,
                           const Particles& particles,
                           const Scene& scene) {
    static thread_local Scratch s;
    samples[chunk].clear();
    for (std::size_t a = first; a < last; ++a) {
        if (!gather(a, particles, scene, s)) {
            return false;
        }
        if (near_wall[a]) {
            beside_walls<Heat>(a, particles, scene, s);
            take_samples(a, scene.boundary, s.contacts, samples[chunk]);
        } else {
            interior(a, particles, scene, s);
        }
    }
    return true;
}

void Evaluation::run(const Particles& particles,
                     const CellGrid& grid,
                     const Boundary& boundary,
                     const EvaluationInput& input) {
    const Scene scene{grid, boundary, input};
    for (;;) {
        resize(particles.size());
        std::atomic<bool> fits{true};
        for_chunks(
            particles.size(), threads_, [&](std::size_t c, std::size_t first, std::size_t last) {
                if (!(input.heat ? run_chunk<true>(c, first, last, particles, scene)
                                 : run_chunk<false>(c, first, last, particles, scene))) {
                    fits = false;
                }
            });
        if (fits) {
            return;
        }
        if (stride_ == most_neighbours) {
            throw Diverged("a fluid particle has more than " + std::to_string(most_neighbours)
                           + " neighbours: the cloud has collapsed; check that the solids leave "
                             "the fluid its room, or raise the sound speed");
        }
        stride_ = most_neighbours; // once in a run at most
    }
}

} // namespace duet::fluid
