#pragma once

import aabb.std;
import aabb;

/// n × n squares, each cut into two triangles.
/// @param place where corner (i, j) is, i and j from 0 to n
template <class Place>
aabb::mesh sheet_of(std::uint32_t n, const Place& place) {
    aabb::mesh m;
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t j = 0; j <= n; ++j) m.vertices.push_back(place(i, j));
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t v = i * (n + 1) + j;
            m.triangles.push_back({v, v + 1, v + n + 1});
            m.triangles.push_back({v + 1, v + n + 2, v + n + 1});
        }
    return m;
}
