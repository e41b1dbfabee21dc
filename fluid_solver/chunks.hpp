// Loops over particles in fixed chunks: whatever the number of threads, a sum over particles is the
// sum over chunks, in their order, of the sums over each chunk.

#pragma once

#include <algorithm>
#include <cstddef>

namespace duet::fluid {

constexpr std::size_t chunk_size = 128;

inline std::size_t chunks_of(std::size_t n) {
    return (n + chunk_size - 1) / chunk_size;
}

/// Calls body(chunk, first, last) for each chunk of [0, n).
template <class Body>
void for_chunks(std::size_t n, int threads, const Body& body) {
    const auto chunks = static_cast<long>(chunks_of(n));
    // Chunks are handed out in pairs: of one pair a second thread would only wait for the end.
#pragma omp parallel for schedule(dynamic, 2) num_threads(threads) if (threads > 1 && chunks > 2)
    for (long c = 0; c < chunks; ++c) {
        const std::size_t first = static_cast<std::size_t>(c) * chunk_size;
        body(static_cast<std::size_t>(c), first, std::min(n, first + chunk_size));
    }
}

/// Calls body(i) for each i in [0, n).
template <class Body>
void for_particles(std::size_t n, int threads, const Body& body) {
    for_chunks(n, threads, [&](std::size_t, std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            body(i);
        }
    });
}

} // namespace duet::fluid
