module;
#include <array>
#include <cstdint>
#include <vector>

export module aabb.local_detection:leaf_order;

import aabb.geometry;
import :balanced_order;

export namespace aabb {

/// The mesh with its triangles in this order, and its vertices in the order in which these come upon them; those of
/// none stand last. What is near in space is then near in memory, and a layout need not say which triangle stands
/// where.
[[nodiscard]] inline mesh in_leaf_order(const mesh& m, const balanced_order& order) {
    constexpr std::uint32_t unseen = 0xffffffff;
    std::vector<std::uint32_t> number(m.vertices.size(), unseen);
    mesh made;
    made.vertices.reserve(m.vertices.size());
    made.triangles.reserve(m.triangles.size());
    const auto place = [&](std::uint32_t v) {
        if (number[v] == unseen) {
            number[v] = static_cast<std::uint32_t>(made.vertices.size());
            made.vertices.push_back(m.vertices[v]);
        }
        return number[v];
    };
    for (const std::uint32_t t : order.triangles) {
        std::array<std::uint32_t, 3> corners = m.triangles[t];
        for (std::uint32_t& v : corners) v = place(v);
        made.triangles.push_back(corners);
    }
    for (std::uint32_t v = 0; v < m.vertices.size(); ++v) static_cast<void>(place(v));
    return made;
}

}  // namespace aabb
