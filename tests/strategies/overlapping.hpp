#pragma once

import aabb.std;
import aabb;

/// By comparing all: the pairs that any search must find, in ascending order.
/// @param present by id; empty where all are
inline std::vector<aabb::index_pair> overlapping(const std::vector<aabb::box>& boxes,
                                                 const std::vector<bool>& present = {}) {
    const auto is_there = [&](std::uint32_t id) { return present.empty() || present[id]; };
    std::vector<aabb::index_pair> pairs;
    for (std::uint32_t a = 0; a < boxes.size(); ++a)
        for (std::uint32_t b = a + 1; b < boxes.size(); ++b)
            if (is_there(a) && is_there(b) && overlaps(boxes[a], boxes[b])) pairs.push_back({a, b});
    return pairs;
}
