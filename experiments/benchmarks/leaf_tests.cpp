#include <benchmark/benchmark.h>

#include <array>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "stages.hpp"
#include "time_tests.hpp"

import aabb.geometry;
import aabb.local_detection;
import aabb.triangle.exact;
import aabblab.walked_pairs;

namespace aabblab {

namespace {

/// A leaf of B that has just been reached. What is tested of it is read, in B's frame, and carried into A's: the box in
/// its tree becomes the box around it as it stands there, the triangle in its mesh three other corners.
struct leaf_of_b {
    static constexpr std::string_view suffix;
    const walked_pairs& at;

    [[nodiscard]] const std::vector<reached_leaf>& pairs() const { return at.leaves_of_b(); }
    [[nodiscard]] aabb::box box(const reached_leaf& p) const { return at.to_a()(at.b().tree().bounds(p.b)); }
    [[nodiscard]] aabb::triangle3f triangle(const reached_leaf& p) const {
        return at.to_a()(at.b().triangles().triangle(p.triangle));
    }
};

/// A leaf of A that has just been reached. What is tested of it is read; there is nothing to carry.
struct leaf_of_a {
    static constexpr std::string_view suffix = "/frame:a";
    const walked_pairs& at;

    [[nodiscard]] const std::vector<reached_leaf>& pairs() const { return at.leaves_of_a(); }
    [[nodiscard]] const aabb::box& box(const reached_leaf& p) const { return at.a().tree().bounds(p.a); }
    [[nodiscard]] aabb::triangle3f triangle(const reached_leaf& p) const {
        return at.a().triangles().triangle(p.triangle);
    }
};

/// In a tree with leaf boxes.
template <class Leaf>
struct box_test {
    static constexpr std::string_view name = "test/box";
    Leaf leaf;

    [[nodiscard, gnu::always_inline]] bool operator()(const reached_leaf& p) const {
        return overlaps(leaf.box(p), p.other);
    }
};

/// With `leaf_test=triangle_box`.
template <class Leaf>
struct triangle_box_test {
    static constexpr std::string_view name = "test/triangle_box";
    Leaf leaf;

    [[nodiscard, gnu::always_inline]] bool operator()(const reached_leaf& p) const {
        return triangle_meets_box(leaf.triangle(p), p.other);
    }
};

/// With `leaf_test=triangle_aabb`; the making of the box is included.
template <class Leaf>
struct triangle_aabb_test {
    static constexpr std::string_view name = "test/triangle_aabb";
    Leaf leaf;

    [[nodiscard, gnu::always_inline]] bool operator()(const reached_leaf& p) const {
        return overlaps(bounds_of(leaf.triangle(p)), p.other);
    }
};

[[nodiscard]] std::vector<std::uint32_t> triangles_below(const aabb::model<walked_tree>& m, walked_tree::cursor node) {
    std::vector<std::uint32_t> found;
    std::vector<walked_tree::cursor> open{node};
    while (!open.empty()) {
        const walked_tree::cursor at = open.back();
        open.pop_back();
        if (m.tree().is_leaf(at))
            found.push_back(m.tree().triangle(at));
        else
            for (const walked_tree::cursor child : m.tree().children(at, m.triangles())) open.push_back(child);
    }
    return found;
}

[[nodiscard]] bool any_intersect(const walked_pairs& at, const reached_leaf& p) {
    for (const std::uint32_t of_b : triangles_below(at.b(), p.b)) {
        const aabb::triangle3f image = at.to_a()(at.b().triangles().triangle(of_b));
        for (const std::uint32_t of_a : triangles_below(at.a(), p.a))
            if (aabb::exact_triangle::intersects(at.a().triangles().triangle(of_a), image)) return true;
    }
    return false;
}

/// @throws std::logic_error when the test says no to nodes below which triangles intersect.
template <class Test>
void require_no_pair_lost(const Test& test) {
    for (const reached_leaf& p : test.leaf.pairs())
        if (!test(p) && any_intersect(test.leaf.at, p))
            throw std::logic_error(std::string(Test::name) + " says no to triangles that intersect");
}

template <class Test>
void time_leaf_test(benchmark::State& state) {
    const Test test{{walked()}};
    static const std::vector<reached_leaf> pairs = [&] {
        require_no_pair_lost(test);
        return in_random_order(test.leaf.pairs());
    }();
    time_tests(state, pairs, test);
}

template <template <class> class Test, class Leaf>
void add() {
    const std::string name = std::string(Test<Leaf>::name) + std::string(Leaf::suffix);
    benchmark::RegisterBenchmark(name.c_str(), time_leaf_test<Test<Leaf>>);
}

}  // namespace

void add_leaf_test_benchmarks() {
    add<box_test, leaf_of_b>();
    add<triangle_box_test, leaf_of_b>();
    add<triangle_aabb_test, leaf_of_b>();
    add<box_test, leaf_of_a>();
    add<triangle_box_test, leaf_of_a>();
    add<triangle_aabb_test, leaf_of_a>();
}

}  // namespace aabblab
