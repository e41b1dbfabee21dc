// Loops over particles in fixed chunks: whatever the number of threads, a sum over particles is the
// sum over chunks, in their order, of the sums over each chunk.

#pragma once

#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>

namespace duet::fluid {

constexpr std::size_t chunk_size = 128;

inline std::size_t chunks_of(std::size_t n) {
    return (n + chunk_size - 1) / chunk_size;
}

/// The equal parts that a pass falls into, one for each thread; further threads help with these.
constexpr int most_stretches = 16;
inline std::size_t stretches_of(int threads) {
    return static_cast<std::size_t>(std::clamp(threads, 1, most_stretches));
}

/// Chunks that are handed out one by one, in their order, to whoever asks.
struct alignas(64) Stretch {
    std::atomic<std::size_t> next{0};
    std::size_t end = 0;
};

/// Calls body(chunk, first, last) for each chunk of [0, n). Each thread begins with the stretch of
/// chunks that it has in every pass, and so in its cache; then it helps with the others'.
template <class Body>
void for_chunks(std::size_t n, int threads, const Body& body) {
    const std::size_t chunks = chunks_of(n);
    // Of two chunks a second thread would only wait for the end.
    const std::size_t count = chunks > 2 ? stretches_of(threads) : 1;
    std::array<Stretch, most_stretches> stretches;
    for (std::size_t s = 0; s < count; ++s) {
        stretches[s].next = chunks * s / count;
        stretches[s].end = chunks * (s + 1) / count;
    }
    // One loop for any number of threads: of two the compiler might round one in another way.
#pragma omp parallel num_threads(threads) if (count > 1)
    {
        const auto own = static_cast<std::size_t>(omp_get_thread_num());
        for (std::size_t s = 0; s < count; ++s) {
            Stretch& stretch = stretches[(own + s) % count];
            const auto take = [&] { return stretch.next.fetch_add(1, std::memory_order_relaxed); };
            for (std::size_t c = take(); c < stretch.end; c = take()) {
                body(c, c * chunk_size, std::min(n, (c + 1) * chunk_size));
            }
        }
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

/// Calls body(range, first, last) for the equal ranges of [0, n) that threads count and move at
/// once: for what depends on the order of the particles, but not on where it is divided.
template <class Body>
void for_ranges(std::size_t n, int threads, const Body& body) {
    const auto ranges = static_cast<long>(stretches_of(threads));
#pragma omp parallel for num_threads(threads) schedule(static, 1) if (ranges > 1)
    for (long r = 0; r < ranges; ++r) {
        const auto range = static_cast<std::size_t>(r), of = static_cast<std::size_t>(ranges);
        body(range, n * range / of, n * (range + 1) / of);
    }
}

} // namespace duet::fluid
