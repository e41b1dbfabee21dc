// The four fields of a particle side by side: one AVX register of doubles. A pass over the
// neighbours then loads one line of each and treats all fields at once.

#pragma once

#include <cstring>

namespace duet::fluid {

/// Velocity, pressure and temperature of one particle.
struct alignas(32) Fields {
    double u, v, p, T;
};

/// Four doubles that are added and multiplied lane by lane.
using Lanes = double __attribute__((vector_size(32)));

inline Lanes load(const Fields& f) {
    Lanes r;
    std::memcpy(&r, &f, sizeof r);
    return r;
}

inline void store(Fields& f, const Lanes& r) {
    std::memcpy(&f, &r, sizeof r);
}

} // namespace duet::fluid
