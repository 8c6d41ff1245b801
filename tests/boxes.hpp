#pragma once

#include <random>

#include "testing.hpp"

import aabb;

/// The pairs of overlapping boxes by the definition, independent of the library, in ascending order.
/// @param present by id; empty if all are present
inline std::vector<aabb::index_pair> overlapping(std::span<const aabb::box> boxes,
                                                 const std::vector<bool>& present = {}) {
    const auto is_present = [&](std::uint32_t id) { return present.empty() || present[id]; };
    std::vector<aabb::index_pair> pairs;
    for (std::uint32_t a = 0; a < boxes.size(); ++a)
        for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
            bool overlap = is_present(a) && is_present(b);
            for (int k = 0; k < 3; ++k)
                overlap = overlap && boxes[a].min[k] <= boxes[b].max[k] && boxes[b].min[k] <= boxes[a].max[k];
            if (overlap) pairs.push_back({a, b});
        }
    return pairs;
}

/// The pairs that a search finds in a frame, in ascending order.
template <class Search>
std::vector<aabb::index_pair> found_by(Search& search, std::span<const aabb::box> boxes) {
    std::vector<aabb::index_pair> pairs;
    search.update(boxes);
    search.search(pairs);
    return sorted(pairs);
}

/// The ids of the boxes that differ from those of the previous frame, twice, descending and with one that may not.
inline std::vector<std::uint32_t> ids_of_moved(std::span<const aabb::box> before, std::span<const aabb::box> boxes) {
    std::vector<std::uint32_t> ids;
    for (auto id = static_cast<std::uint32_t>(std::min(before.size(), boxes.size())); id-- > 0;)
        if (boxes[id] != before[id] || id == 3) ids.insert(ids.end(), {id, id});
    return ids;
}

/// With integer coordinates, so that many boxes touch.
inline aabb::box lattice_box(std::mt19937& random, std::uint32_t side, std::uint32_t extent) {
    aabb::box b{};
    for (int k = 0; k < 3; ++k) {
        b.min[k] = static_cast<float>(random() % side);
        b.max[k] = b.min[k] + static_cast<float>(random() % extent);
    }
    return b;
}

/// By default many boxes have equal ends, some are flat, some are points.
inline std::vector<aabb::box> lattice_boxes(std::mt19937& random, std::size_t n, std::uint32_t side = 8,
                                            std::uint32_t extent = 3) {
    std::vector<aabb::box> boxes(n);
    for (aabb::box& b : boxes) b = lattice_box(random, side, extent);
    return boxes;
}
