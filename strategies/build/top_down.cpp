module;
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

module aabb.build.top_down;

import aabb.geometry;
import aabb.local_detection;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

namespace aabb {

namespace {

build_element element_of(const mesh& m, std::uint32_t triangle) {
    const triangle3f t = m.triangle(triangle);
    build_element e{bounds_of(t), {}, triangle};
    // In double, so that the sum cannot overflow.
    for (int k = 0; k < 3; ++k)
        e.centroid[k] = static_cast<float>((double{t[0][k]} + double{t[1][k]} + double{t[2][k]}) / 3);
    return e;
}

box bounds_of(std::span<const build_element> range) {
    box all = range[0].bounds;
    for (const build_element& e : range.subspan(1)) all = merged(all, e.bounds);
    return all;
}

/// The number of triangles nearest to `left` that leaves pairs on both sides. A balanced tree grows no deeper by it: of
/// 2m triangles, m odd, above 1 and so below some power of two, m + 1 still fit under that power.
std::size_t paired(std::size_t left, std::size_t all) {
    if (all % 2 != 0 || left % 2 == 0 || all == 2) return left;
    return left + 1 < all ? left + 1 : left - 1;
}

/// A range of elements to become a node.
struct task {
    std::size_t begin;
    std::size_t end;
    std::uint32_t parent;  ///< where this is the right child; else `no_parent`
};
constexpr std::uint32_t no_parent = 0xffffffff;

}  // namespace

std::vector<build_node> build_top_down(const mesh& m, leaf_arrangement arrangement, const split_rule& split) {
    std::vector<build_element> elements;
    elements.reserve(m.triangles.size());
    for (std::uint32_t t = 0; t < m.triangle_count(); ++t) elements.push_back(element_of(m, t));
    std::vector<build_node> nodes;
    nodes.reserve(2 * elements.size() - 1);
    // Deep trees must not cost stack.
    std::vector<task> tasks{{0, elements.size(), no_parent}};
    while (!tasks.empty()) {
        const task now = tasks.back();
        tasks.pop_back();
        const auto here = static_cast<std::uint32_t>(nodes.size());
        const std::span range = std::span(elements).subspan(now.begin, now.end - now.begin);
        const box bounds = bounds_of(range);
        if (now.parent != no_parent) nodes[now.parent].right = here;
        nodes.push_back({bounds, 0, range[0].triangle});
        if (range.size() == 1) continue;
        const std::size_t wanted =
            arrangement == leaf_arrangement::full_left ? std::bit_ceil(range.size()) / 2 : any_number;
        const split_choice chosen = split(range, bounds, wanted);
        const std::size_t left = wanted != any_number                     ? wanted
                                 : arrangement == leaf_arrangement::pairs ? paired(chosen.left, range.size())
                                                                          : chosen.left;
        std::ranges::nth_element(range, range.begin() + static_cast<std::ptrdiff_t>(left), centroid_order{chosen.axis});
        tasks.push_back({now.begin + left, now.end, here});
        tasks.push_back({now.begin, now.begin + left, no_parent});
    }
    return nodes;
}

}  // namespace aabb
