module;
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

/// How many pairs come into reach as boxes grow, asked of some boxes by chance.
export module aabb.prepare.reach;

import aabb.geometry;
import aabb.global_search;
import aabb.prepare.glimpse;
import aabb.prepare.grown_boxes;
import aabb.prepare.listed_pairs;

export namespace aabb {

/// @param drawn as `drawn_id` has it
/// @return as many as `of` holds, fewer where some objects are absent
[[nodiscard]] inline std::span<const box> drawn_boxes(std::span<const box> boxes, const membership& objects,
                                                      std::uint32_t& drawn, std::span<box> of) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < of.size() && i < boxes.size(); ++i) {
        const std::uint32_t id = drawn_id(drawn, boxes.size());
        if (objects.contains(id)) of[count++] = boxes[id];
    }
    return of.first(count);
}

/// About how many pairs a list with that margin holds: as many as eight boxes have neighbours.
[[nodiscard]] inline double pairs_in_reach(std::span<const box> boxes, const membership& objects, std::uint32_t& drawn,
                                           double margin) {
    std::array<box, 8> some;
    const std::span<const box> asked = drawn_boxes(boxes, objects, drawn, some);
    if (asked.empty()) return 0;
    std::array<box, 8> reach;
    // Both boxes of a pair are grown.
    grow(asked, 2 * margin, reach);
    std::size_t neighbours = 0;
    for (const box& b : boxes)
        for (std::size_t i = 0; i < asked.size(); ++i) neighbours += static_cast<std::size_t>(meet(b, reach[i]));
    // Each is a neighbour of itself.
    return (static_cast<double>(neighbours) / static_cast<double>(asked.size()) - 1) / 2 *
           static_cast<double>(objects.size());
}

/// Pairs by a rough count: eight boxes against one of thirty-two others.
struct rough_reach {
    double overlapping = 0;
    double in_reach = 0;      ///< when grown by the margin
    std::size_t counted = 0;  ///< of the latter
};
[[nodiscard]] inline rough_reach rough_reach_of(std::span<const box> boxes, const membership& objects,
                                                std::uint32_t& drawn, double margin) {
    std::array<box, 8> some;
    const std::span<const box> asked = drawn_boxes(boxes, objects, drawn, some);
    std::array<box, 8> reach;
    grow(asked, 2 * margin, reach);
    const std::size_t others = std::max<std::size_t>(8, boxes.size() / 32);
    std::size_t overlapping = 0;
    rough_reach found;
    for (std::size_t k = 0; k < others && !boxes.empty(); ++k) {
        const box& b = boxes[drawn_id(drawn, boxes.size())];
        for (std::size_t i = 0; i < asked.size(); ++i) {
            if (!meet(b, reach[i]) || b == asked[i]) continue;
            ++found.counted;
            overlapping += static_cast<std::size_t>(meet(b, asked[i]));
        }
    }
    const auto n = static_cast<double>(objects.size());
    const double each = asked.empty() ? 0 : n / static_cast<double>(asked.size()) * n / static_cast<double>(others) / 2;
    found.overlapping = static_cast<double>(overlapping) * each;
    found.in_reach = static_cast<double>(found.counted) * each;
    return found;
}

}  // namespace aabb
