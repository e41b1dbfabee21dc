// Loops over many like items, cut into contiguous pieces for threads.

#pragma once

#include <algorithm>
#include <cstddef>

namespace duet::solid {

/// Calls work(begin, end) for pieces that cover 0 .. count. Below some thousand items a thread
/// costs more than it does, so that a small body is served by the caller alone. `work` must give
/// the same bits however the range is cut: every item computes its own results alone.
template <class Work>
void in_pieces(std::size_t count, int threads, const Work& work) {
    constexpr std::size_t least = 4096;
    const std::size_t pieces = std::min(static_cast<std::size_t>(std::max(threads, 1)),
                                        std::max<std::size_t>(count / least, 1));
    if (pieces == 1) {
        work(std::size_t{0}, count);
        return;
    }
#pragma omp parallel for num_threads(static_cast <int>(pieces)) schedule(static, 1)
    for (std::size_t piece = 0; piece < pieces; ++piece) {
        work(count * piece / pieces, count * (piece + 1) / pieces);
    }
}

} // namespace duet::solid
