#pragma once

#include <rapidcheck.h>
#include <cstdint>
#include <map>
#include <span>

import aabb;

/// Corners on a coarse lattice, so that many lie on planes of a partition, and a few long boxes.
inline aabb::box any_box_among_planes() {
    aabb::box b;
    for (int k = 0; k < 3; ++k) {
        b.min[k] = static_cast<float>(*rc::gen::inRange(0, 30));
        b.max[k] = b.min[k] + static_cast<float>(*rc::gen::element(0, 1, 2, 3, 20));
    }
    return b;
}

/// Subsets of a box, with the axes that each owns.
template <class Partition>
std::map<std::uint32_t, aabb::axis_set> subsets_in(const Partition& partition, std::span<const aabb::box> boxes,
                                                   std::uint32_t id) {
    std::map<std::uint32_t, aabb::axis_set> all;
    partition.for_each_subset(id, boxes[id], [&](std::uint32_t s, aabb::axis_set owned) { all[s] = owned; });
    return all;
}
