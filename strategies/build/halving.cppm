module;
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

/// Builds that split a range of triangles in two, and these again, on several threads.
export module aabb.build.halving;

import aabb.base;

export namespace aabb {

/// How many triangles are worth another thread.
inline constexpr std::size_t least_shared = 2048;

/// Splits the whole, and what comes of it, until there is enough for all threads to end at about the same time; then
/// each thread finishes one part after the other. With one thread the whole is finished at once.
/// @param split returns the two parts of one
template <class Part, class Split, class Finish>
void halve(worker_threads& workers, const Part& whole, Split split, Finish finish) {
    std::vector<Part> parts{whole};
    if (workers.count() > 1) {
        const std::size_t enough = std::max(least_shared, whole.size() / (std::size_t{16} * workers.count()));
        const auto is_large = [&](const Part& p) { return p.size() > enough; };
        for (auto begin = std::size_t{0}; begin < parts.size();) {
            const auto large = std::ranges::partition(parts.begin() + static_cast<std::ptrdiff_t>(begin), parts.end(),
                                                      [&](const Part& p) { return !is_large(p); });
            std::vector<std::array<Part, 2>> halves(large.size());
            workers.for_each_index(large.size(), [&](std::size_t i, std::size_t) { halves[i] = split(large[i]); });
            parts.erase(large.begin(), large.end());
            begin = parts.size();
            for (const auto& two : halves) parts.insert(parts.end(), two.begin(), two.end());
        }
        // The largest first, so that none is left over at the end.
        std::ranges::sort(parts, std::ranges::greater{}, &Part::size);
    }
    workers.for_each_index(parts.size(), [&](std::size_t i, std::size_t) { finish(parts[i]); });
}

}  // namespace aabb
