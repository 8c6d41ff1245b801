#include <benchmark/benchmark.h>

#include <random>

#include "stages.hpp"

import aabb.build.median;
import aabb.pipeline;
import aabb.std;
import aabb.strategies;
import aabb.tree.canonical;
import aabb.triangle.exact;
import aabblab.cases;
import aabblab.rotated_boxes;
import aabblab.scenes;

namespace aabblab {

namespace {

// The tests of a traversal of two meshes, recorded so that each can be timed separately.

using walked_tree = aabb::canonical_tree;

/// A pair of nodes with a leaf to which the traversal has just come.
struct reached_leaf {
    walked_tree::cursor a;
    walked_tree::cursor b;
    std::uint32_t triangle;  ///< triangle of the leaf
    aabb::box other;         ///< box of the other node in A's frame, which the traversal already has
};

/// Two leaves whose boxes overlap.
struct leaf_pair {
    std::uint32_t a;
    std::uint32_t b;
    aabb::triangle3f b_image;  ///< the triangle of B in A's frame
};

/// The pairs that `local_detection` tests between a noise sphere and a torus knot of about 5,000 triangles each, which
/// penetrate each other as in the scene `mesh_pair`. The traversal is the same, with the tree `canonical`, so the mix
/// of hits and misses and the relative sizes of boxes are representative.
class walked_pairs {
public:
    /// Records the tests of a traversal, and compares their numbers with those of `local_detection`.
    /// @throws std::logic_error if `local_detection` no longer tests as many pairs as recorded
    walked_pairs() {
        traverse();
        aabb::local_detection<walked_tree, aabb::exact_triangle, aabb::work_counters> detection;
        static_cast<void>(detection.count_pairs(a_, poses_[0], b_, poses_[1]));
        if (detection.counters()[aabb::work::box_tests] != box_tests_ ||
            detection.counters()[aabb::work::triangle_tests] != triangles_.size())
            throw std::logic_error("the recorded pairs differ from those that local detection tests");
    }

    [[nodiscard]] const aabb::model<walked_tree>& a() const noexcept { return a_; }
    [[nodiscard]] const aabb::model<walked_tree>& b() const noexcept { return b_; }
    [[nodiscard]] const aabb::relative_pose& to_a() const noexcept { return to_a_; }

    [[nodiscard]] const rotated_boxes& rotated() const noexcept { return rotated_; }

    /// Leaves of A, each with the inner or leaf node of B that it is tested against first; and vice versa.
    [[nodiscard]] const std::vector<reached_leaf>& leaves_of_a() const noexcept { return leaves_of_a_; }
    [[nodiscard]] const std::vector<reached_leaf>& leaves_of_b() const noexcept { return leaves_of_b_; }
    [[nodiscard]] const std::vector<leaf_pair>& triangles() const noexcept { return triangles_; }

private:
    using cursor = walked_tree::cursor;

    struct node_pair {
        cursor a;
        cursor b;
        aabb::box b_bounds;
    };

    [[nodiscard]] static std::vector<aabb::pose> first_poses(aabb::mesh_scene& scene) {
        std::vector<aabb::pose> poses;
        scene.next(poses);
        return poses;
    }

    /// Records the tests in the order of `local_detection`; `open_` is the stack of node pairs whose boxes overlap.
    void traverse() {
        test({a_.root(), b_.root(), to_a_(b_.bounds())});
        while (!open_.empty()) {
            const node_pair nodes = open_.back();
            open_.pop_back();
            const bool a_is_leaf = a_.tree().is_leaf(nodes.a);
            const bool b_is_leaf = b_.tree().is_leaf(nodes.b);
            if (a_is_leaf && b_is_leaf) {
                const std::uint32_t of_b = b_.tree().triangle(nodes.b);
                triangles_.push_back({a_.tree().triangle(nodes.a), of_b, to_a_(b_.triangles().triangle(of_b))});
                continue;
            }
            const bool a_is_longer = longest_edge(a_.tree().bounds(nodes.a)) >= longest_edge(nodes.b_bounds);
            if (b_is_leaf || (!a_is_leaf && a_is_longer))
                for (const cursor child : a_.tree().children(nodes.a, a_.triangles()))
                    reach_child_of_a({child, nodes.b, nodes.b_bounds});
            else
                for (const cursor child : b_.tree().children(nodes.b, b_.triangles()))
                    reach_child_of_b({nodes.a, child, to_a_(b_.tree().bounds(child))});
        }
    }

    void reach_child_of_a(const node_pair& next) {
        if (a_.tree().is_leaf(next.a))
            leaves_of_a_.push_back({next.a, next.b, a_.tree().triangle(next.a), next.b_bounds});
        test(next);
    }

    void reach_child_of_b(const node_pair& next) {
        if (b_.tree().is_leaf(next.b))
            leaves_of_b_.push_back({next.a, next.b, b_.tree().triangle(next.b), a_.tree().bounds(next.a)});
        test(next);
    }

    void test(const node_pair& next) {
        ++box_tests_;
        if (overlaps(a_.tree().bounds(next.a), next.b_bounds)) open_.push_back(next);
    }

    [[nodiscard]] static float longest_edge(const aabb::box& b) noexcept {
        const int k = aabb::longest_axis(b);
        return b.max[k] - b.min[k];
    }

    std::unique_ptr<aabb::mesh_scene> scene_ =
        make_mesh_scene({"mesh_pair",
                         {{"frames", "0"}, {"distance", "0.25"}},
                         {"noise_sphere:triangles=5000", "torus_knot:triangles=5000"}});
    aabb::model<walked_tree> a_{scene_->meshes[0], aabb::median_build()};
    aabb::model<walked_tree> b_{scene_->meshes[1], aabb::median_build()};
    std::vector<aabb::pose> poses_ = first_poses(*scene_);
    aabb::relative_pose to_a_ = pose_relative_to(a_, poses_[0], b_, poses_[1]);
    rotated_boxes rotated_{poses_[0], poses_[1], b_.bounds()};
    std::vector<node_pair> open_;
    std::vector<reached_leaf> leaves_of_a_, leaves_of_b_;
    std::vector<leaf_pair> triangles_;
    std::size_t box_tests_ = 0;
};

/// Shared by all benchmarks: Google Benchmark calls each several times.
const walked_pairs& walked() {
    static const walked_pairs pairs;
    return pairs;
}

/// Repeats the pairs in different random orders, 65,536 in total. In a fixed order, the branch predictor memorises the
/// outcomes of 5,000 tests, and then a box test takes a third of its time.
template <class Pair>
std::vector<Pair> in_random_order(std::vector<Pair> pairs) {
    constexpr std::size_t count = 1 << 16;
    std::mt19937_64 random(1);  // NOLINT(*-msc51-cpp): the same order in every run
    std::vector<Pair> order;
    while (order.size() < count) {
        for (std::size_t left = pairs.size(); left > 1; --left) std::swap(pairs[left - 1], pairs[random() % left]);
        order.insert(order.end(), pairs.begin(), pairs.end());
    }
    order.resize(count);
    return order;
}

/// Times a test and the branch on its result, as in a traversal: mispredicted branches are part of its cost.
/// @param test must be `[[gnu::always_inline]]`, as in a traversal: it is called twice here, and would otherwise be an
/// out-of-line function
template <class Pair, class Test>
void time_tests(benchmark::State& state, const std::vector<Pair>& pairs, const Test& test) {
    std::size_t hits = 0, next = 0;
    for (auto _ : state) {
        if (test(pairs[next])) benchmark::DoNotOptimize(++hits);
        if (++next == pairs.size()) next = 0;
    }
    const auto count = static_cast<double>(pairs.size());
    state.counters["hits"] = static_cast<double>(std::ranges::count_if(pairs, test)) / count;
}

/// The operand is a leaf of B. Its box or triangle is read in B's frame and transformed into A's: the box becomes the
/// AABB of its image, and the corners of the triangle are transformed.
struct leaf_of_b {
    static constexpr std::string_view suffix;
    const walked_pairs& walk;

    [[nodiscard]] const std::vector<reached_leaf>& pairs() const { return walk.leaves_of_b(); }
    [[nodiscard]] aabb::box box(const reached_leaf& p) const { return walk.to_a()(walk.b().tree().bounds(p.b)); }
    [[nodiscard]] aabb::triangle3f triangle(const reached_leaf& p) const {
        return walk.to_a()(walk.b().triangles().triangle(p.triangle));
    }
};

/// The operand is a leaf of A. Its box or triangle is read, and needs no transform.
struct leaf_of_a {
    static constexpr std::string_view suffix = "/frame:a";
    const walked_pairs& walk;

    [[nodiscard]] const std::vector<reached_leaf>& pairs() const { return walk.leaves_of_a(); }
    [[nodiscard]] const aabb::box& box(const reached_leaf& p) const { return walk.a().tree().bounds(p.a); }
    [[nodiscard]] aabb::triangle3f triangle(const reached_leaf& p) const {
        return walk.a().triangles().triangle(p.triangle);
    }
};

/// A test of a leaf of one mesh, in `Leaf`, against a node of the other.
template <class Test, class Leaf>
struct leaf_test {
    Leaf leaf;

    [[nodiscard, gnu::always_inline]] bool operator()(const reached_leaf& p) const { return Test::meets(leaf, p); }
};

/// The test of trees that store leaf boxes.
struct box_test {
    static constexpr std::string_view name = "test/box";
    [[nodiscard, gnu::always_inline]] static bool meets(const auto& leaf, const reached_leaf& p) {
        return overlaps(leaf.box(p), p.other);
    }
};

/// The test of `leaf_test=triangle_box`.
struct triangle_box_test {
    static constexpr std::string_view name = "test/triangle_box";
    [[nodiscard, gnu::always_inline]] static bool meets(const auto& leaf, const reached_leaf& p) {
        return triangle_meets_box(leaf.triangle(p), p.other);
    }
};

/// The test of `leaf_test=triangle_aabb`, including the computation of the box.
struct triangle_aabb_test {
    static constexpr std::string_view name = "test/triangle_aabb";
    [[nodiscard, gnu::always_inline]] static bool meets(const auto& leaf, const reached_leaf& p) {
        return overlaps(bounds_of(leaf.triangle(p)), p.other);
    }
};

/// Möller's original of `triangle_box` (Akenine-Möller 2001), without the margin against false negatives by rounding.
struct triangle_box_moller_test {
    static constexpr std::string_view name = "test/triangle_box_moller";
    static constexpr bool exact = false;
    [[nodiscard, gnu::always_inline]] static bool meets(const auto& leaf, const reached_leaf& p) {
        return moller_triangle_meets_box(leaf.triangle(p), p.other);
    }
};

/// The separating axis test of both boxes in their own frames, without a new AABB, with six axes.
struct rotated_box_6_test {
    static constexpr std::string_view name = "test/rotated_box_6";
    [[nodiscard, gnu::always_inline]] static bool meets(const auto& leaf, const reached_leaf& p) {
        const walked_pairs& walk = leaf.walk;
        return walk.rotated().meet_by_faces(
            walk.rotated().pair_of(walk.a().tree().bounds(p.a), walk.b().tree().bounds(p.b)));
    }
};

/// The same with all fifteen axes.
struct rotated_box_15_test {
    static constexpr std::string_view name = "test/rotated_box_15";
    [[nodiscard, gnu::always_inline]] static bool meets(const auto& leaf, const reached_leaf& p) {
        const walked_pairs& walk = leaf.walk;
        const box_pair boxes = walk.rotated().pair_of(walk.a().tree().bounds(p.a), walk.b().tree().bounds(p.b));
        return walk.rotated().meet_by_faces(boxes) && walk.rotated().meet_by_edges(boxes);
    }
};

/// The triangles in the leaves below a node, or in it if it is a leaf.
[[nodiscard]] std::vector<std::uint32_t> triangles_below(const aabb::model<walked_tree>& m, walked_tree::cursor node) {
    std::vector<std::uint32_t> triangles;
    std::vector<walked_tree::cursor> open{node};
    while (!open.empty()) {
        node = open.back();
        open.pop_back();
        if (m.tree().is_leaf(node))
            triangles.push_back(m.tree().triangle(node));
        else
            for (const walked_tree::cursor child : m.tree().children(node, m.triangles())) open.push_back(child);
    }
    return triangles;
}

/// Whether triangles below the pair of nodes intersect: if so, a leaf test that rejects it has a false negative.
[[nodiscard]] bool any_intersect(const walked_pairs& walk, const reached_leaf& p) {
    for (const std::uint32_t of_b : triangles_below(walk.b(), p.b)) {
        const aabb::triangle3f image = walk.to_a()(walk.b().triangles().triangle(of_b));
        for (const std::uint32_t of_a : triangles_below(walk.a(), p.a))
            if (aabb::exact_triangle::intersects(walk.a().triangles().triangle(of_a), image)) return true;
    }
    return false;
}

/// The number of negative tests of nodes whose triangles intersect.
template <class Test>
[[nodiscard]] std::size_t false_negatives_of(const Test& test) {
    return static_cast<std::size_t>(std::ranges::count_if(
        test.leaf.pairs(), [&](const reached_leaf& p) { return !test(p) && any_intersect(test.leaf.walk, p); }));
}

/// True if a test may have false negatives, because it says `exact = false`.
template <class Test>
constexpr bool may_miss = requires { requires !Test::exact; };

/// Times a test of a leaf against a node on the recorded pairs; `kept` is one minus its share of false negatives.
/// @throws std::logic_error if an exact test has false negatives
template <class Test, class Leaf>
void time_leaf_test(benchmark::State& state) {
    const leaf_test<Test, Leaf> test{{walked()}};
    static const std::size_t false_negatives = false_negatives_of(test);
    if (false_negatives > 0 && !may_miss<Test>)
        throw std::logic_error(std::string(Test::name) + " has false negatives");
    static const std::vector<reached_leaf> pairs = in_random_order(test.leaf.pairs());
    time_tests(state, pairs, test);
    // Reports the complement, as Google Benchmark computes a NaN spread for a counter that is always zero.
    if (may_miss<Test>)
        state.counters["kept"] =
            1 - static_cast<double>(false_negatives) / static_cast<double>(test.leaf.pairs().size());
}

template <class Leaf, class... Tests>
void add_leaf_tests(aabb::type_list<Tests...>) {
    (benchmark::RegisterBenchmark((std::string(Tests::name) + std::string(Leaf::suffix)).c_str(),
                                  time_leaf_test<Tests, Leaf>),
     ...);
}

/// Transforms the triangle of B into A's frame, as for the first triangle of A that it is tested with, or reuses its
/// image, as for all others.
template <class Triangle, bool ReusesImage>
struct leaf_pair_test {
    Triangle triangle;
    const walked_pairs& walk;

    [[nodiscard, gnu::always_inline]] bool operator()(const leaf_pair& p) const {
        const aabb::triangle3f of_a = walk.a().triangles().triangle(p.a);
        if constexpr (ReusesImage)
            return triangle.intersects(of_a, p.b_image);
        else
            return triangle.intersects(of_a, walk.to_a()(walk.b().triangles().triangle(p.b)));
    }
};

template <class Triangle, bool ReusesImage>
void add_triangle_test(const std::string& name, const aabb::strategy_choice& choice) {
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
        static const std::vector<leaf_pair> pairs = in_random_order(walked().triangles());
        time_tests(state, pairs, leaf_pair_test<Triangle, ReusesImage>{make_configured<Triangle>(choice), walked()});
    });
}

}  // namespace

void add_leaf_test_benchmarks() {
    constexpr aabb::type_list<box_test, rotated_box_6_test, rotated_box_15_test, triangle_box_test,
                              triangle_box_moller_test, triangle_aabb_test>
        tests{};
    add_leaf_tests<leaf_of_b>(tests);
    add_leaf_tests<leaf_of_a>(tests);
}

/// Adds each triangle test with the transform of B's triangle and, "/frame:a", with its cached image.
void add_triangle_test_benchmarks() {
    for_each_strategy(aabb::triangles{}, []<class Triangle>(aabb::type_list<Triangle>) {
        for (const aabb::strategy_choice& choice : choices_of<Triangle>()) {
            const std::string name = "test/triangle/" + to_text(choice);
            add_triangle_test<Triangle, /*ReusesImage=*/false>(name, choice);
            add_triangle_test<Triangle, /*ReusesImage=*/true>(name + "/frame:a", choice);
        }
    });
}

}  // namespace aabblab
