#pragma once

#include <random>

#include "testing.hpp"

import aabb;

/// The pairs of boxes that overlap, by the definition, in the tests' own words and ascending order.
/// @param present by id; empty where all are
inline std::vector<aabb::index_pair> overlapping(std::span<const aabb::box> boxes,
                                                 const std::vector<bool>& present = {}) {
    const auto is_there = [&](std::uint32_t id) { return present.empty() || present[id]; };
    std::vector<aabb::index_pair> pairs;
    for (std::uint32_t a = 0; a < boxes.size(); ++a)
        for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
            bool meet = is_there(a) && is_there(b);
            for (int k = 0; k < 3; ++k)
                meet = meet && boxes[a].min[k] <= boxes[b].max[k] && boxes[b].min[k] <= boxes[a].max[k];
            if (meet) pairs.push_back({a, b});
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

/// With whole numbers, so that many touch.
inline aabb::box lattice_box(std::mt19937& random, std::uint32_t side, std::uint32_t extent) {
    aabb::box b{};
    for (int k = 0; k < 3; ++k) {
        b.min[k] = static_cast<float>(random() % side);
        b.max[k] = b.min[k] + static_cast<float>(random() % extent);
    }
    return b;
}

/// Unless they are told to be others, many with equal ends, some flat, some points.
inline std::vector<aabb::box> lattice_boxes(std::mt19937& random, std::size_t n, std::uint32_t side = 8,
                                            std::uint32_t extent = 3) {
    std::vector<aabb::box> boxes(n);
    for (aabb::box& b : boxes) b = lattice_box(random, side, extent);
    return boxes;
}
