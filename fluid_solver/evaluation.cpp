#include "fluid_solver/evaluation.hpp"

#include "fluid_solver/fluid.hpp"
#include "fluid_solver/shifting.hpp"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <limits>
#include <optional>

namespace duet::fluid {

namespace {

/// A cloud in order has 20 or 21 neighbours: three eights, and some have one more.
constexpr std::size_t usual_chunk_blocks = chunk_size * 3 + chunk_size / 4;
constexpr std::size_t most_chunk_blocks = chunk_size * (most_neighbours / eight);

/// Sums over the neighbours of one particle, by lanes u, v, p, T.
struct PairSums {
    Four gradient_x{}, gradient_y{}; ///< sum w (f_b - f_a)
    Four laplacian{};                ///< sum 2 V F (e.B e)(f_a - f_b)
};

/// laplacian(block, k) is the weight of the neighbour for the Laplacian, by lanes or one for all.
/// Differences are taken in double precision, so that large equal parts cost no digits.
template <class Field, class Weights>
PairSums pair_sums(const std::vector<Field>& fields,
                   std::size_t a,
                   std::span<const PairBlock> pairs,
                   const Weights& laplacian) {
    PairSums even, odd; // two chains of additions, which one would wait for
    const auto add = [](PairSums& sums, float x, float y, const auto& w, const Four& difference) {
        sums.gradient_x += x * difference;
        sums.gradient_y += y * difference;
        sums.laplacian -= w * difference;
    };
    const auto fa = load(fields[a]);
    for (std::size_t b = 0; b < pairs.size(); ++b) {
        const PairBlock& block = pairs[b];
        const auto weights = laplacian(b);
        const auto difference = [&](std::size_t k) {
            return __builtin_convertvector(load(fields[block.index[k]]) - fa, Four);
        };
        for (std::size_t k = 0; k < eight; k += 2) {
            add(even, block.x[k], block.y[k], weights(k), difference(k));
            add(odd, block.x[k + 1], block.y[k + 1], weights(k + 1), difference(k + 1));
        }
    }
    return {even.gradient_x + odd.gradient_x,
            even.gradient_y + odd.gradient_y,
            even.laplacian + odd.laplacian};
}

/// 2 V F (e.B e) of eight neighbours.
struct LaplacianWeights {
    alignas(32) float values[eight];

    LaplacianWeights(const std::array<float, 3>& B, const DirectionWeights& d, std::size_t block) {
        const std::size_t k = block * eight;
        store(values,
              B[0] * load_eight(&d.xx[k]) + B[1] * load_eight(&d.xy[k])
                  + B[2] * load_eight(&d.yy[k]));
    }
    float operator()(std::size_t k) const { return values[k]; }
};

/// The same where the fields have tensors of their own.
struct SeparateLaplacianWeights {
    LaplacianWeights u, v, T;

    Four operator()(std::size_t k) const { return Four{u(k), v(k), 0, T(k)}; }
};

/// Drops the neighbours that walls hide.
void drop_hidden(const std::vector<Contact>& contacts, Neighbours& near) {
    // What is not behind the line of any wall is not hidden either; so it is nearly everywhere.
    bool behind = false;
    for (const Contact& contact : contacts) {
        const auto nx = static_cast<float>(contact.normal.x);
        const auto ny = static_cast<float>(contact.normal.y);
        const auto distance = static_cast<float>(contact.distance * (1 - 1e-6));
        int beyond = 0;
        for (std::size_t k = 0; k < near.count; ++k) {
            beyond |= -near.x[k] * nx - near.y[k] * ny >= distance ? 1 : 0;
        }
        behind = behind || beyond != 0;
    }
    if (behind) {
        near.filter([&](std::size_t k) {
            return !Ghosts::hidden(
                contacts, {-static_cast<double>(near.x[k]), -static_cast<double>(near.y[k])});
        });
    }
}

/// Distance of the particle from the nearest point of a wall that it sees, and of all of them, m.
double distance(const Contact& contact) {
    const double beyond = std::max({0.0, -contact.before(), -contact.after()});
    return beyond > 0 ? std::hypot(contact.distance, beyond) : contact.distance;
}

double nearest_distance(const std::vector<Contact>& contacts) {
    double least = std::numeric_limits<double>::infinity();
    for (const Contact& contact : contacts) {
        least = std::min(least, distance(contact));
    }
    return least;
}

/// The part of a particle's shift that keeps it off the walls: -0.2 (0.3 dx - d1)+ n; before a
/// corner that juts out, where no wall has its foot point, off the corner likewise. (Without that,
/// what slides along a body's side goes round its corner as close as it likes, and into it.)
Vec2 push_off(const std::vector<Contact>& contacts, double spacing) {
    Vec2 push, corner;
    double to_wall = spacing, to_corner = spacing;
    for (const Contact& contact : contacts) {
        if (contact.on_wall()) {
            push -= wall_push(contact.distance, spacing) * contact.normal;
            to_wall = std::min(to_wall, contact.distance);
        } else if (distance(contact) < to_corner) {
            const double along = contact.before() < 0 ? -contact.before() : contact.after();
            to_corner = distance(contact);
            corner = contact.distance * contact.normal + along * contact.tangent;
        }
    }
    if (to_corner < to_wall) {
        push -= (wall_push(to_corner, spacing) / to_corner) * corner;
    }
    return push;
}

/// The share of c^2 with which a particle's pressure may answer to its divergence. One inner step
/// changes the pressure of a particle by -dt^2 c^2 lambda/dx^2 times itself by way of its own and
/// its neighbours' velocities:
///     lambda/dx^2 = sum_b L w.L w - own.L sum_b w,   own = L_v (sum_b w + S): div v = ... -
///     v_a.own,
/// and 4 - 2 delta h c dt sum_b 2 V F is the limit of stability. Inside the fluid lambda is 0.3 to
/// 0.65; beside a wall S grows as d1 falls, and lambda reaches 1.6 at d1 = dx/10. Since the
/// particle is alone with this it is made softer alone: c is free, and a steady state does not
/// depend on it.
float softness(const std::span<const PairBlock> pairs,
               const Mat2& L,
               const Mat2& L_velocity,
               Vec2 weight_sum,
               Vec2 own,
               double spacing) {
    constexpr double largest = 0.75; // stable to inner steps of 2 dx/c
    Eight xx{}, xy{}, yy{};
    for (const PairBlock& block : pairs) {
        const Eight x = load_eight(block.x), y = load_eight(block.y);
        xx += x * x;
        xy += x * y;
        yy += y * y;
    }
    const Four ww = lane_sums(xx, xy, yy);
    const Mat2 squares{ww[0], ww[1], ww[1], ww[2]};
    const Mat2 through_neighbours = L_velocity * squares;
    const double through_itself = dot(own, L * weight_sum);
    const double lambda =
        spacing * spacing * (through_neighbours.xx + through_neighbours.yy - through_itself);
    return lambda > largest ? static_cast<float>(largest / lambda) : 1;
}

/// sum 2 V F (e.B e) by lanes u, v, T.
Four weight_sums(const DirectionWeights& d,
                 std::size_t blocks,
                 const std::array<float, 3>& Bu,
                 const std::array<float, 3>& Bv,
                 const std::array<float, 3>& BT) {
    Eight xx{}, xy{}, yy{};
    for (std::size_t k = 0; k < blocks * eight; k += eight) {
        xx += load_eight(&d.xx[k]);
        xy += load_eight(&d.xy[k]);
        yy += load_eight(&d.yy[k]);
    }
    const Four sums = lane_sums(xx, xy, yy);
    return sums[0] * Four{Bu[0], Bv[0], 0, BT[0]} + sums[1] * Four{Bu[1], Bv[1], 0, BT[1]}
           + sums[2] * Four{Bu[2], Bv[2], 0, BT[2]};
}

/// The viscous term stays as it was at the outer step's start, and where c dt is about three
/// spacings the sound of the inner steps swings round once meanwhile: what should damp a particle's
/// part in it then drives it, and that grows if friction times the step exceeds 0.7. Inside the
/// fluid it is 0.5 at most; beside a wall 0.9 and more, in a corner 1.2. So much may stay frozen,
/// and this is what exceeds it, 1/s:
double following(double friction, double step) {
    constexpr double frozen = 0.5;
    return std::max(0.0, friction - frozen / step);
}

/// The kernel's error along the axes of a lattice, m2: D f = lap f + error lap lap f + ... From
/// D x^2 = 2 (that is what B does) and D x^4 = 24 error: sum F x^4 / (12 sum F x^2), 0.119 dx^2.
double lattice_error(const Kernel& kernel, double spacing) {
    const int reach = static_cast<int>(kernel.support() / spacing);
    double second = 0, fourth = 0;
    for (int i = -reach; i <= reach; ++i) {
        for (int j = -reach; j <= reach; ++j) {
            const double x = i * spacing, r = std::hypot(x, j * spacing);
            const double F = r < kernel.support() ? kernel.slope_over_r(r) : 0;
            second += F * x * x;
            fourth += F * x * x * x * x;
        }
    }
    return fourth / (12 * second);
}

/// sum 2 V F e e f (xx, xy, yy) and sum w f (x, y), m4, of f = z^4 - 4 d z^3, z from the particle
/// towards its only wall, at d: what of (d - z)^4 is more than quadratic.
std::array<float, 5> quartic_moments(const Contact& wall,
                                     const Neighbours& near,
                                     std::span<const PairBlock> pairs,
                                     const DirectionWeights& d) {
    const auto nx = static_cast<float>(wall.normal.x), ny = static_cast<float>(wall.normal.y);
    const auto four_d = static_cast<float>(4 * wall.distance);
    Eight xx{}, xy{}, yy{}, x{}, y{};
    for (std::size_t block = 0; block < pairs.size(); ++block) {
        const std::size_t k = block * eight;
        const Eight z = -nx * load_eight(&near.x[k]) - ny * load_eight(&near.y[k]);
        const Eight f = z * z * z * (z - four_d);
        xx += f * load_eight(&d.xx[k]);
        xy += f * load_eight(&d.xy[k]);
        yy += f * load_eight(&d.yy[k]);
        x += f * load_eight(pairs[block].x);
        y += f * load_eight(pairs[block].y);
    }
    alignas(32) float sums[eight];
    store(sums, lane_sums(xx, xy, yy, x, y, Eight{}, Eight{}, Eight{}));
    return {sums[0], sums[1], sums[2], sums[3], sums[4]};
}

/// What div v makes, m times u_n,nn, of a velocity that is bent beside a wall with the normal n:
/// the gradients err by A_ijk H_jk / 2, and by continuity u_t,nt = -u_n,nn.
double bend_error(const Third& Au, const Third& Av, Vec2 n) {
    const Vec2 t{-n.y, n.x};
    const auto contract = [](const Symmetric& a, Vec2 p, Vec2 q) {
        return a[0] * p.x * q.x + a[1] * (p.x * q.y + p.y * q.x) + a[2] * p.y * q.y;
    };
    return 0.5 * (n.x * contract(Au[0], n, n) + n.y * contract(Av[1], n, n))
           - (t.x * contract(Au[0], n, t) + t.y * contract(Av[1], n, t));
}

Correction narrow(const Mat2& m) {
    return {static_cast<float>(m.xx),
            static_cast<float>(m.xy),
            static_cast<float>(m.yx),
            static_cast<float>(m.yy)};
}

} // namespace

/// What is kept of one particle while the operators of its batch are solved.
struct Evaluation::Work {
    DirectionWeights directions;
    std::vector<Contact> contacts;
    WallSums walls;
    std::optional<std::array<float, 5>> quartic; ///< `quartic_moments`, where they are asked for
    Mat2 pressure;                               ///< near walls: L of the pressure
    std::size_t u = 0, v = 0, temperature = 0;   ///< places in the batch of operators
};

/// What one thread needs for a batch of particles: first the moments of each, then all operators,
/// then the fields of each.
struct Evaluation::Scratch {
    int column = -1, row = -1; ///< of the surroundings
    bool beside_walls = false; ///< walls may be in reach from this cell
    Surroundings surroundings;
    Neighbours near;
    std::array<Work, OperatorBatch::room / 3> work;
    OperatorBatch operators;
    std::size_t blocks = 0; ///< used of the chunk's
};

Evaluation::Evaluation(double spacing, int threads)
    : threads_(threads), kernel_(support_in_spacings * spacing),
      lattice_error_(static_cast<float>(lattice_error(kernel_, spacing))), ghosts_(spacing),
      sample_depth_(1.5 * spacing), chunk_blocks_(usual_chunk_blocks) {}

void Evaluation::resize(std::size_t n) {
    L.resize(n);
    slope_x.resize(n);
    slope_y.resize(n);
    viscous.resize(n);
    heating.resize(n);
    shift.resize(n);
    weight_sum.resize(n);
    near_heated.resize(n);
    count.resize(n);
    first_block_.resize(n);
    wall_slot_.resize(n);
    const std::size_t chunks = chunks_of(n);
    samples.resize(chunks);
    wall_.resize(chunks);
    pairs_.resize(chunks * chunk_blocks_);
}

/// Neighbours, pair weights and moments of one particle, and the operators that they ask for.
template <bool Heat>
bool Evaluation::gather(
    std::size_t a, const Particles& particles, const Scene& scene, Scratch& s, Work& work) {
    const Vec2 x = particles.position(a);
    const int column = scene.grid.column(x.x), row = scene.grid.row(x.y);
    if (column != s.column || row != s.row) {
        s.column = column;
        s.row = row;
        s.beside_walls = scene.boundary.near(x);
        if (!s.surroundings.collect(particles, scene.grid, column, row)) {
            return false;
        }
    }
    const auto support = static_cast<float>(kernel_.support());
    if (!s.surroundings.find(x, support, s.near)) {
        return false;
    }
    work.contacts.clear();
    if (s.beside_walls) {
        scene.boundary.contacts(x, work.contacts);
        drop_hidden(work.contacts, s.near);
    }
    if (s.blocks + s.near.eights() > chunk_blocks_) {
        return false;
    }
    s.near.pad(2 * support, static_cast<std::uint32_t>(a));
    count[a] = static_cast<std::uint8_t>(s.near.count);
    first_block_[a] = static_cast<std::uint16_t>(s.blocks);
    s.blocks += s.near.eights();
    const Moments m = weigh(kernel_,
                            static_cast<float>(scene.input.volume),
                            s.near,
                            &pairs_[a / chunk_size * chunk_blocks_ + first_block_[a]],
                            work.directions);
    weight_sum[a] = {m.wx, m.wy};
    work.u = work.v = work.temperature = s.operators.size();
    if (work.contacts.empty()) {
        s.operators.add(m);
        return true;
    }
    // Velocity and temperature have tensors of their own: not every wall is heated, some slip, and
    // beside two faces their sums differ from the pressure's.
    const WallSums& w = work.walls;
    ghosts_.sums(scene.boundary, work.contacts, work.walls);
    work.quartic.reset();
    if (scene.input.fourth_order && work.contacts.size() == 1 && w.temperature.K != 0
        && work.contacts[0].distance < sample_depth_) {
        work.quartic = quartic_moments(work.contacts[0], s.near, pairs(a), work.directions);
    }
    work.pressure = correction(m, w.N_n);
    s.operators.add(m, w.u.S_xi + w.u_slips.N_n, w.u.S_xi_xi + w.u_slips.N_d_n_n, w.u);
    if (w.slips) {
        work.v = s.operators.size();
        s.operators.add(m, w.v.S_xi + w.v_slips.N_n, w.v.S_xi_xi + w.v_slips.N_d_n_n, w.v);
    }
    if constexpr (Heat) {
        work.temperature = s.operators.size();
        s.operators.add(m,
                        w.temperature.S_xi + w.adiabatic.N_n,
                        w.temperature.S_xi_xi + w.adiabatic.N_d_n_n,
                        w.temperature);
    }
    return true;
}

void Evaluation::store_diffusion(std::size_t a, const EvaluationInput& input, const Four& lap) {
    viscous[a] = {input.viscosity * static_cast<double>(lap[0]),
                  input.viscosity * static_cast<double>(lap[1])};
    heating[a] = input.diffusivity * static_cast<double>(lap[3]);
}

void Evaluation::interior(std::size_t a,
                          const std::vector<Slope>& deferred,
                          const Scene& scene,
                          const Scratch& s,
                          const Work& work) {
    near_heated[a] = 0;
    wall_slot_[a] = no_wall;
    const auto B = s.operators.B(work.u);
    const auto E = s.operators.E(work.u);
    const auto weights = [&](std::size_t block) {
        return LaplacianWeights(B, work.directions, block);
    };
    L[a] = narrow(s.operators.L(work.u));
    struct Derivatives {
        Four x, y, laplacian;
    };
    const auto derivatives = [&](const auto& of) {
        const PairSums sums = pair_sums(of, a, pairs(a), weights);
        const Four x = L[a].xx * sums.gradient_x + L[a].xy * sums.gradient_y;
        const Four y = L[a].yx * sums.gradient_x + L[a].yy * sums.gradient_y;
        return Derivatives{x, y, sums.laplacian - E[0] * x - E[1] * y};
    };
    Derivatives f = derivatives(scene.fields);
    store(slope_x[a], f.x);
    store(slope_y[a], f.y);
    if (scene.input.fourth_order) {
        store(laplacian[a], f.laplacian);
        f.laplacian -= lattice_error_ * derivatives(deferred).laplacian;
    }
    store_diffusion(a, scene.input, f.laplacian);
    shift[a] = shift_vector(
        {weight_sum[a].x, weight_sum[a].y}, {}, scene.input.shift_factor, scene.input.spacing);
}

void Evaluation::beside_walls(std::size_t a,
                              const Scene& scene,
                              const Scratch& s,
                              const Work& work) {
    const WallSums& w = work.walls;
    near_heated[a] = w.temperature.K != 0;
    const DirichletSums& v_known = w.slips ? w.v : w.u;
    const Mat2 Lu = s.operators.L(work.u), Lv = s.operators.L(work.v),
               LT = s.operators.L(work.temperature);
    const auto Bu = s.operators.B(work.u), Bv = s.operators.B(work.v),
               BT = s.operators.B(work.temperature);
    const auto Eu = s.operators.E(work.u), Ev = s.operators.E(work.v),
               ET = s.operators.E(work.temperature);
    const PairSums sums = pair_sums(scene.fields, a, pairs(a), [&](std::size_t block) {
        const LaplacianWeights u(Bu, work.directions, block);
        return SeparateLaplacianWeights{u,
                                        w.slips ? LaplacianWeights(Bv, work.directions, block) : u,
                                        LaplacianWeights(BT, work.directions, block)};
    });
    const auto wide = [](const Four& f) { return __builtin_convertvector(f, Lanes); };
    const Lanes fa = load(scene.fields[a]);
    const Lanes Sx{w.u.S.x, v_known.S.x, 0, w.temperature.S.x};
    const Lanes Sy{w.u.S.y, v_known.S.y, 0, w.temperature.S.y};
    const Lanes K{w.u.K, v_known.K, 0, w.temperature.K};
    const Lanes rx = wide(sums.gradient_x) + w.Sx_value - Sx * fa;
    const Lanes ry = wide(sums.gradient_y) + w.Sy_value - Sy * fa;
    // (The pressure's slope is made by the inner steps, with the body force of the moment.)
    const Lanes Lxx{Lu.xx, Lv.xx, 0, LT.xx}, Lxy{Lu.xy, Lv.xy, 0, LT.xy};
    const Lanes Lyx{Lu.yx, Lv.yx, 0, LT.yx}, Lyy{Lu.yy, Lv.yy, 0, LT.yy};
    const Lanes gx = Lxx * rx + Lxy * ry, gy = Lyx * rx + Lyy * ry;
    store(slope_x[a], __builtin_convertvector(gx, Four));
    store(slope_y[a], __builtin_convertvector(gy, Four));
    const Lanes Ex = wide(Four{Eu[0], Ev[0], 0, ET[0]});
    const Lanes Ey = wide(Four{Eu[1], Ev[1], 0, ET[1]});
    const Four lap = __builtin_convertvector(
        wide(sums.laplacian) - (w.K_value - K * fa) - Ex * gx - Ey * gy, Four);
    if (scene.input.fourth_order) {
        store(laplacian[a], lap);
    }
    store_diffusion(a, scene.input, lap);
    L[a] = narrow(work.pressure);
    const Vec2 sum_w{weight_sum[a].x, weight_sum[a].y};
    const Mat2 L_velocity{Lu.xx, Lu.xy, Lv.yx, Lv.yy}; // what makes div v of both gradients
    const Vec2 L_S{(Lu * w.u.S).x, (Lv * v_known.S).y};
    // What one more of u, v or T here changes of its Laplacian, 1/m2.
    const Lanes qx = sum_w.x + Sx, qy = sum_w.y + Sy;
    const Lanes own = wide(weight_sums(work.directions, pairs(a).size(), Bu, Bv, BT)) + K
                      + Ex * (Lxx * qx + Lxy * qy) + Ey * (Lyx * qx + Lyy * qy);
    const double step = scene.input.step, nu = scene.input.viscosity;
    // Beside a wall of known temperature, closer than d1 = 0.2 dx or so, T would overshoot it.
    heating[a] /= std::max(1.0, -scene.input.diffusivity * step * own[3]);
    auto& terms = wall_[a / chunk_size];
    wall_slot_[a] = static_cast<std::uint8_t>(terms.size());
    terms.push_back({narrow(L_velocity),
                     work.pressure * w.N_n,
                     work.pressure * w.N_acceleration,
                     L_S,
                     Lu.xx * w.Sx_value[0] + Lu.xy * w.Sy_value[0] + Lv.yx * w.Sx_value[1]
                         + Lv.yy * w.Sy_value[1],
                     softness(pairs(a),
                              work.pressure,
                              L_velocity,
                              sum_w,
                              L_velocity * sum_w + L_S,
                              scene.input.spacing),
                     {following(-nu * own[0], step), following(-nu * own[1], step)},
                     nearest_distance(work.contacts)});
    shift[a] = shift_vector(sum_w + w.C,
                            push_off(work.contacts, scene.input.spacing),
                            scene.input.shift_factor,
                            scene.input.spacing);
}

/// What D makes of d^4 beside the only wall beyond its Laplacian, 12 d^2, m2: all of it in the
/// first row, less in the second, since in layers of a few spacings T departs from d^4 there.
double Evaluation::quartic_error(const Scratch& s, const Work& work) const {
    if (!work.quartic) {
        return 0;
    }
    const DirichletSums& w = work.walls.temperature;
    const double d = work.contacts[0].distance, at_wall = -3 * d * d * d * d;
    const auto B = s.operators.B(work.temperature);
    const auto E = s.operators.E(work.temperature);
    const auto& f = *work.quartic;
    const Vec2 gradient =
        s.operators.L(work.temperature) * Vec2{f[3] + w.S.x * at_wall, f[4] + w.S.y * at_wall};
    const double pairs = B[0] * f[0] + B[1] * f[1] + B[2] * f[2];
    const double share = std::min(1.0, 2 * sample_weight(d));
    return share * (-pairs - w.K * at_wall - E[0] * gradient.x - E[1] * gradient.y);
}

void Evaluation::take_samples(std::size_t a,
                              const Scene& scene,
                              const Scratch& s,
                              const Work& work,
                              std::vector<WallSample>& out) const {
    std::size_t nearest = none;
    for (const Contact& contact : work.contacts) {
        if (contact.distance < sample_depth_ && contact.on_wall()) {
            const WallPoint point = scene.boundary.at(*contact.face, contact.foot);
            const std::uint32_t cell = scene.boundary.cell_at(*point.segment, point.along);
            if (nearest == none || contact.distance < out[nearest].distance) {
                nearest = out.size();
            }
            out.push_back(
                {static_cast<std::uint32_t>(a),
                 cell,
                 contact.distance,
                 (point.along - scene.boundary.cells()[cell].centre) * point.segment->length,
                 point.value,
                 load(scene.fields[a]),
                 dot(point.acceleration, contact.normal)});
        }
    }
    if (nearest != none) {
        const Vec2 n = scene.boundary.cells()[out[nearest].cell].normal;
        out[nearest].bend_error = bend_error(s.operators.A(work.u), s.operators.A(work.v), n);
        out[nearest].quartic_error = quartic_error(s, work);
    }
}

template <bool Heat>
bool Evaluation::run_chunk(std::size_t chunk,
                           std::size_t first,
                           std::size_t last,
                           const Particles& particles,
                           const Scene& scene) {
    static thread_local Scratch s;
    s.column = -1; // another cloud may have been here
    s.blocks = 0;
    samples[chunk].clear();
    wall_[chunk].clear();
    for (std::size_t start = first; start < last; start += s.work.size()) {
        const std::size_t end = std::min(last, start + s.work.size());
        s.operators.clear();
        for (std::size_t a = start; a < end; ++a) {
            if (!gather<Heat>(a, particles, scene, s, s.work[a - start])) {
                return false;
            }
        }
        s.operators.solve();
        for (std::size_t a = start; a < end; ++a) {
            const Work& work = s.work[a - start];
            if (work.contacts.empty()) {
                interior(a, particles.laplacian, scene, s, work);
            } else {
                beside_walls(a, scene, s, work);
                take_samples(a, scene, s, work, samples[chunk]);
            }
        }
    }
    return true;
}

void Evaluation::correct_samples(std::span<const double> bends,
                                 std::span<const double> quartics,
                                 double diffusivity,
                                 double smooth) {
    for_chunks(count.size(), threads_, [&](std::size_t chunk, std::size_t, std::size_t) {
        for (const WallSample& sample : samples[chunk]) {
            const std::size_t a = sample.particle;
            wall_[chunk][wall_slot_[a]].value -= smooth * sample.bend_error * bends[sample.cell];
            heating[a] -= diffusivity * sample.quartic_error * quartics[sample.cell];
        }
    });
}

/// The fields `ahead` seconds on, by their rates of late. Diffusion that a step takes from its
/// start is too strong by (diffusivity dt/2) lap lap f, and the Laplacian of second order too weak
/// by lattice_error lap lap f: at the largest steps most of that is the same, so only together
/// with the correction of the latter is the former one.
void Evaluation::predict(const Particles& particles, double ahead) {
    predicted_.resize(particles.size());
    for_particles(particles.size(), threads_, [&](std::size_t a) {
        const Fields& f = particles.fields[a];
        const Slope& rate = particles.rate[a];
        predicted_[a] = {f.u + ahead * static_cast<double>(rate.u),
                         f.v + ahead * static_cast<double>(rate.v),
                         f.p,
                         f.T + ahead * static_cast<double>(rate.T)};
    });
}

void Evaluation::run(const Particles& particles,
                     const CellGrid& grid,
                     const Boundary& boundary,
                     const EvaluationInput& input) {
    laplacian.resize(input.fourth_order ? particles.size() : 0);
    if (input.fourth_order) {
        predict(particles, 0.5 * input.step);
    }
    const Scene scene{grid, boundary, input, input.fourth_order ? predicted_ : particles.fields};
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
        if (chunk_blocks_ == most_chunk_blocks) {
            throw Diverged("a fluid particle has more than " + std::to_string(most_neighbours)
                           + " neighbours: the cloud has collapsed; check that the solids leave "
                             "the fluid its room, or raise the sound speed");
        }
        chunk_blocks_ = most_chunk_blocks; // once in a run at most
    }
}

} // namespace duet::fluid
