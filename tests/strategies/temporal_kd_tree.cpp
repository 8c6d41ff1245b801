// The kd-tree that keeps pairs of boxes at rest: what it tests again, and which boxes its planes keep apart.

#include "searches.hpp"

import aabb.strategies;

using namespace aabb;

namespace {

/// A tree with its objects, which counts the work of each frame.
class counted_tree {
public:
    explicit counted_tree(const temporal_kd_tree_sweep::config& c, std::size_t n) : tree(c) { insert_all(objects, n); }

    /// The pairs of a frame, in ascending order.
    std::vector<index_pair> run(const std::vector<box>& boxes) {
        counts = {};
        tree.update(boxes, objects, sort_, counts);
        objects.settle();
        std::vector<index_pair> pairs;
        tree.search(pairs);
        return sorted(pairs);
    }
    [[nodiscard]] std::uint64_t tests() const { return counts[work::box_tests]; }

    temporal_kd_tree_sweep tree;
    membership objects;
    work_counters counts;

private:
    std_sort sort_;
};

std::vector<box> shifted_by(std::vector<box> boxes, const vec3f& by, std::size_t one_in = 1) {
    for (std::size_t id = 0; id < boxes.size(); id += one_in) boxes[id] = moved(boxes[id], by);
    return boxes;
}

}  // namespace

TEST_CASE("pairs of boxes at rest are kept, unless more than half of the boxes move") {
    constexpr std::size_t n = 3000;
    const std::vector<box> boxes = cubes(n, {40, 40, 40});
    counted_tree search({.leaf = 64}, n);
    CHECK(search.run(boxes) == overlapping(boxes));
    CHECK_FALSE(search.tree.keeps_pairs());
    const std::uint64_t all_tests = search.tests();
    // At rest: one test per pair of grown boxes, of which a few more overlap, and nothing is sorted.
    CHECK(search.run(boxes) == overlapping(boxes));
    CHECK(search.counts[work::comparisons] == 0);
    CHECK_BETWEEN(overlapping(boxes).size() - 1, search.tests(), overlapping(boxes).size() * 11 / 10);
    const std::uint64_t tests_at_rest = search.tests();
    const std::vector<box> few_moved = shifted_by(boxes, {1, 0, 0}, 100);
    CHECK(search.run(few_moved) == overlapping(few_moved));
    CHECK(search.tree.keeps_pairs());
    CHECK_BETWEEN(tests_at_rest, search.tests(), tests_at_rest + all_tests / 20);
    // Exactly half at rest do not suffice.
    const std::vector<box> half_moved = shifted_by(few_moved, {1, 1, 0}, 2);
    CHECK(search.run(half_moved) == overlapping(half_moved));
    CHECK_FALSE(search.tree.keeps_pairs());
    CHECK(search.tests() > all_tests / 2);
}

TEST_CASE("a move within the margin is not searched again, and the pairs are still those of the boxes") {
    constexpr std::size_t n = 2000;
    const std::vector<box> boxes = cubes(n, {25, 25, 25});
    counted_tree search({.margin = 0.1}, n);
    search.run(boxes);
    std::mt19937 random(1);
    std::vector<box> shaken = boxes;
    for (box& b : shaken)
        b = moved(b, {static_cast<float>(random() % 100) / 1024, static_cast<float>(random() % 100) / 1024, 0});
    CHECK(overlapping(shaken) != overlapping(boxes));
    CHECK(search.run(shaken) == overlapping(shaken));
    CHECK(search.counts[work::comparisons] == 0);
    const std::vector<box> farther = shifted_by(boxes, {0.2F, 0, 0});
    CHECK(search.run(farther) == overlapping(farther));
    CHECK(search.counts[work::comparisons] > 0);
}

TEST_CASE("leaves are split where boxes come and removed where they go") {
    constexpr std::size_t n = 4000;
    counted_tree search({.leaf = 100}, n);
    const std::vector<box> spread_out = cubes(n, {60, 60, 60});
    search.run(spread_out);
    const std::size_t nodes = search.tree.nodes();
    CHECK_BETWEEN(60, nodes, 400);
    // A tree divides 16 times the tests away that one leaf takes.
    const std::uint64_t tests = search.tests();
    counted_tree in_one_leaf({.leaf = 5000}, n);
    in_one_leaf.run(spread_out);
    CHECK(in_one_leaf.tree.nodes() == 1);
    CHECK(8 * tests < in_one_leaf.tests());
    // The same places again and again need no other nodes.
    for (std::uint32_t seed = 2; seed < 6; ++seed) {
        const std::vector<box> elsewhere = cubes(n, {60, 60, 60}, seed);
        CHECK(search.run(elsewhere) == overlapping(elsewhere));
        CHECK_BETWEEN(nodes / 2, search.tree.nodes(), 2 * nodes);
        CHECK(search.tests() < 2 * tests);
    }
    // All boxes go to one corner: planes follow them.
    const std::vector<box> in_corner = cubes(n, {20, 20, 20}, 9);
    CHECK(search.run(in_corner) == overlapping(in_corner));
    counted_tree anew({.leaf = 100}, n);
    anew.run(in_corner);
    CHECK(search.tests() < 2 * anew.tests());
    for (std::uint32_t id = 50; id < n; ++id) search.objects.remove(id);
    search.run(in_corner);
    CHECK(search.tree.nodes() == 1);
}

TEST_CASE("boxes that touch a plane from both sides are a pair") {
    std::mt19937 random(1);
    std::size_t touching = 0;
    for (int scene = 0; scene < 300; ++scene) {
        constexpr std::uint32_t n = 40;
        // Without a margin the planes, at means of lattice points, often lie on faces.
        const auto leaf = static_cast<std::uint32_t>(1 + random() % 4);
        counted_tree search({.leaf = leaf, .margin = 0}, n);
        std::vector<box> boxes = lattice_boxes(random, n, 12, 4);
        std::vector<bool> present(n, true);
        for (int frame = 0; frame < 8; ++frame) {
            const std::uint32_t one_in = std::array{1U, 3U, 10U}[random() % 3];
            for (std::uint32_t id = 0; id < n; ++id) {
                if (random() % one_in == 0) boxes[id] = lattice_box(random, 12, 4);
                if (random() % 20 != 0) continue;
                present[id] ? search.objects.remove(id) : search.objects.insert(id);
                present[id] = !present[id];
            }
            const std::vector<index_pair> pairs = search.run(boxes);
            REQUIRE(pairs == overlapping(boxes, present));
            for (const index_pair p : pairs) touching += boxes[p.a].max[0] == boxes[p.b].min[0];
        }
    }
    CHECK(touching > 1000);
}

TEST_CASE("boxes that no plane separates stay in one node, and the tree is not deep without end") {
    counted_tree search({.leaf = 8}, 1000);
    CHECK(search.run(std::vector<box>(1000, cube(0, 1))).size() == 1000 * 999 / 2);
    CHECK(search.tree.nodes() == 1);
    // At each split of these, one box stands alone.
    std::vector<box> boxes;
    for (int i = 0; i < 1000; ++i) boxes.push_back(cube(std::ldexp(1.0F, i % 250 - 125), 0));
    CHECK(search.run(boxes) == overlapping(boxes));
    CHECK(search.tree.nodes() < 2000);
}
