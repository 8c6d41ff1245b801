#include <benchmark/benchmark.h>

#include "stages.hpp"
#include "time_tests.hpp"

import aabb.geometry;
import aabb.local_detection;
import aabb.std;
import aabb.triangle.exact;
import aabblab.rotated_boxes;
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

/// Möller's original of `triangle_box` (Akenine-Möller 2001), without the margin that keeps rounding from parting what
/// touches.
template <class Leaf>
struct triangle_box_moller_test {
    static constexpr std::string_view name = "test/triangle_box_moller";
    static constexpr bool exact = false;
    Leaf leaf;

    [[nodiscard, gnu::always_inline]] bool operator()(const reached_leaf& p) const {
        return moller_triangle_meets_box(leaf.triangle(p), p.other);
    }
};

/// The boxes of both trees as they stand: nothing is carried or boxed anew, whichever is the leaf. Six axes.
template <class Leaf>
struct rotated_box_6_test {
    static constexpr std::string_view name = "test/rotated_box_6";
    Leaf leaf;

    [[nodiscard, gnu::always_inline]] bool operator()(const reached_leaf& p) const {
        const walked_pairs& at = leaf.at;
        return at.rotated().meet_by_faces(at.rotated().pair_of(at.a().tree().bounds(p.a), at.b().tree().bounds(p.b)));
    }
};

/// The same with all fifteen.
template <class Leaf>
struct rotated_box_15_test {
    static constexpr std::string_view name = "test/rotated_box_15";
    Leaf leaf;

    [[nodiscard, gnu::always_inline]] bool operator()(const reached_leaf& p) const {
        const walked_pairs& at = leaf.at;
        const box_pair boxes = at.rotated().pair_of(at.a().tree().bounds(p.a), at.b().tree().bounds(p.b));
        return at.rotated().meet_by_faces(boxes) && at.rotated().meet_by_edges(boxes);
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

/// How often the test says no to nodes below which triangles intersect.
template <class Test>
[[nodiscard]] std::size_t lost_by(const Test& test) {
    return static_cast<std::size_t>(std::ranges::count_if(
        test.leaf.pairs(), [&](const reached_leaf& p) { return !test(p) && any_intersect(test.leaf.at, p); }));
}

template <class Test>
constexpr bool may_lose = requires { requires !Test::exact; };

/// What a test loses that must not lose anything is an error; of one that may it is reported.
/// @throws std::logic_error
template <class Test>
void time_leaf_test(benchmark::State& state) {
    const Test test{{walked()}};
    static const std::size_t lost = lost_by(test);
    if (lost > 0 && !may_lose<Test>)
        throw std::logic_error(std::string(Test::name) + " says no to triangles that intersect");
    static const std::vector<reached_leaf> pairs = in_random_order(test.leaf.pairs());
    time_tests(state, pairs, test);
    // Not how many are lost: of a zero in every repetition Google Benchmark tells a spread that is no number.
    if (may_lose<Test>)
        state.counters["kept"] = 1 - static_cast<double>(lost) / static_cast<double>(test.leaf.pairs().size());
}

template <template <class> class Test, class Leaf>
void add() {
    const std::string name = std::string(Test<Leaf>::name) + std::string(Leaf::suffix);
    benchmark::RegisterBenchmark(name.c_str(), time_leaf_test<Test<Leaf>>);
}

template <class Leaf>
void add_all() {
    add<box_test, Leaf>();
    add<rotated_box_6_test, Leaf>();
    add<rotated_box_15_test, Leaf>();
    add<triangle_box_test, Leaf>();
    add<triangle_box_moller_test, Leaf>();
    add<triangle_aabb_test, Leaf>();
}

}  // namespace

void add_leaf_test_benchmarks() {
    add_all<leaf_of_b>();
    add_all<leaf_of_a>();
}

}  // namespace aabblab
