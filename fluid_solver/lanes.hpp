// Several numbers in one register. The compiler turns these types into whatever the processor has.

#pragma once

#include <cmath>
#include <cstddef>
#include <cstring>
#ifdef __AVX__
#include <immintrin.h>
#endif

namespace duet::fluid {

/// Velocity, pressure and temperature of one particle side by side: one AVX register. A pass over
/// the neighbours then loads one line of each and treats all fields at once.
struct alignas(32) Fields {
    double u, v, p, T;
};

/// The same four in single precision: slopes.
struct alignas(16) Slope {
    float u, v, p, T;
};

/// Four doubles, or floats, that are added and multiplied lane by lane.
using Lanes = double __attribute__((vector_size(32)));
using Four = float __attribute__((vector_size(16)));
/// Eight neighbours, or particles, at a time.
using Eight = float __attribute__((vector_size(32)));
constexpr std::size_t eight = 8;

inline Four load(const Slope& s) {
    Four r;
    std::memcpy(&r, &s, sizeof r);
    return r;
}

inline Lanes load(const Fields& f) {
    Lanes r;
    std::memcpy(&r, &f, sizeof r);
    return r;
}

inline void store(Slope& f, const Four& r) {
    std::memcpy(&f, &r, sizeof r);
}

inline Eight load_eight(const float* from) {
    Eight r;
    std::memcpy(&r, from, sizeof r);
    return r;
}

inline void store(float* to, const Eight& r) {
    std::memcpy(to, &r, sizeof r);
}

/// 1/sqrt(x) to 4e-7 of it, for normal x > 0.
inline Eight inverse_root(const Eight& x) {
#ifdef __AVX__
    const Eight estimate = _mm256_rsqrt_ps(x); // to 4e-4, and a step of Newton's method
    return estimate * (1.5F - 0.5F * x * estimate * estimate);
#else
    Eight r;
    for (std::size_t k = 0; k < eight; ++k) {
        r[k] = 1 / std::sqrt(x[k]);
    }
    return r;
#endif
}

/// Rows to columns.
inline void transpose(Eight (&rows)[eight]) {
    Eight pairs[eight], fours[eight];
    for (std::size_t i = 0; i < eight; i += 2) {
        pairs[i] = __builtin_shufflevector(rows[i], rows[i + 1], 0, 8, 1, 9, 4, 12, 5, 13);
        pairs[i + 1] = __builtin_shufflevector(rows[i], rows[i + 1], 2, 10, 3, 11, 6, 14, 7, 15);
    }
    for (std::size_t i = 0; i < eight; i += 4) {
        for (std::size_t j = 0; j < 2; ++j) {
            const Eight &p = pairs[i + j], &q = pairs[i + j + 2];
            fours[i + 2 * j] = __builtin_shufflevector(p, q, 0, 1, 8, 9, 4, 5, 12, 13);
            fours[i + 2 * j + 1] = __builtin_shufflevector(p, q, 2, 3, 10, 11, 6, 7, 14, 15);
        }
    }
    for (std::size_t i = 0; i < 4; ++i) {
        const Eight &p = fours[i], &q = fours[i + 4];
        rows[i] = __builtin_shufflevector(p, q, 0, 1, 2, 3, 8, 9, 10, 11);
        rows[i + 4] = __builtin_shufflevector(p, q, 4, 5, 6, 7, 12, 13, 14, 15);
    }
}

/// The sum over the lanes of each of eight registers.
inline Eight lane_sums(const Eight& a,
                       const Eight& b,
                       const Eight& c,
                       const Eight& d,
                       const Eight& e,
                       const Eight& f,
                       const Eight& g,
                       const Eight& h) {
    // Lanes of two registers alternately, then of four, in each half of the register.
    const auto two = [](const Eight& p, const Eight& q) {
        return __builtin_shufflevector(p, q, 0, 8, 1, 9, 4, 12, 5, 13)
               + __builtin_shufflevector(p, q, 2, 10, 3, 11, 6, 14, 7, 15);
    };
    const auto four = [](const Eight& p, const Eight& q) {
        return __builtin_shufflevector(p, q, 0, 1, 8, 9, 4, 5, 12, 13)
               + __builtin_shufflevector(p, q, 2, 3, 10, 11, 6, 7, 14, 15);
    };
    const Eight abcd = four(two(a, b), two(c, d)), efgh = four(two(e, f), two(g, h));
    return __builtin_shufflevector(abcd, efgh, 0, 1, 2, 3, 8, 9, 10, 11)
           + __builtin_shufflevector(abcd, efgh, 4, 5, 6, 7, 12, 13, 14, 15);
}

/// The same of three; the last lane repeats the third.
inline Four lane_sums(const Eight& a, const Eight& b, const Eight& c) {
    const auto fold = [](const Eight& v) {
        return __builtin_shufflevector(v, v, 0, 1, 2, 3)
               + __builtin_shufflevector(v, v, 4, 5, 6, 7);
    };
    const auto two = [](const Four& p, const Four& q) {
        return __builtin_shufflevector(p, q, 0, 4, 1, 5)
               + __builtin_shufflevector(p, q, 2, 6, 3, 7);
    };
    const Four folded = fold(c);
    const Four ab = two(fold(a), fold(b)), cc = two(folded, folded);
    return __builtin_shufflevector(ab, cc, 0, 1, 4, 5)
           + __builtin_shufflevector(ab, cc, 2, 3, 6, 7);
}

} // namespace duet::fluid
