#include <algorithm>
#include <bit>
#include <catch2/catch_template_test_macros.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

import aabb;
import aabb.strategies;

using namespace aabb;

namespace {

/// A wavy sheet of 2 n² triangles, with a few of them repeated and a few of zero area.
mesh sheet(std::uint32_t n) {
    mesh m;
    for (std::uint32_t i = 0; i <= n; ++i)
        for (std::uint32_t j = 0; j <= n; ++j)
            m.vertices.push_back(
                {static_cast<float>(i), static_cast<float>(j), static_cast<float>((i * 7 + j * 13) % 5)});
    for (std::uint32_t i = 0; i < n; ++i)
        for (std::uint32_t j = 0; j < n; ++j) {
            const std::uint32_t v = i * (n + 1) + j;
            m.triangles.push_back({v, v + 1, v + n + 1});
            m.triangles.push_back({v + 1, v + n + 2, v + n + 1});
        }
    m.triangles.push_back(m.triangles[0]);
    m.triangles.push_back({0, 0, 1});
    return m;
}

mesh many_equal(std::uint32_t n) {
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {n, {0, 1, 2}}};
}

struct findings {
    std::vector<int> seen;  // by triangle
    std::size_t depth = 0;
};

/// Walks the whole tree and holds each box against the triangles below it.
template <class Tree>
box walk(const Tree& tree, const mesh& m, typename Tree::cursor at, std::size_t depth, findings& found) {
    found.depth = std::max(found.depth, depth);
    box below;
    if (tree.is_leaf(at)) {
        const std::uint32_t t = tree.triangle(at);
        REQUIRE(t < m.triangle_count());
        ++found.seen[t];
        below = bounds_of(m.triangle(t));
    } else {
        below = merged(walk(tree, m, tree.child(at, 0, m), depth + 1, found),
                       walk(tree, m, tree.child(at, 1, m), depth + 1, found));
    }
    REQUIRE(contains(tree.bounds(at), below));
    // The layouts so far keep every box they have exactly.
    if (tree.has_own_bounds(at)) REQUIRE(tree.bounds(at) == below);
    return below;
}

template <class List>
struct tuple_of;
template <class... Types>
struct tuple_of<type_list<Types...>> {
    using type = std::tuple<Types...>;
};

}  // namespace

TEMPLATE_LIST_TEST_CASE("a tree holds every triangle once, in exact boxes, at the least depth", "",
                        tuple_of<trees>::type) {
    for (const mesh& m :
         {sheet(1), sheet(2), sheet(9), sheet(40), many_equal(1), many_equal(2), many_equal(3), many_equal(1000)}) {
        TestType tree;
        tree.build(m);
        findings found{std::vector<int>(m.triangle_count()), 0};
        CHECK(walk(tree, m, tree.root(m), 0, found) == bounds_of(m));
        CHECK(found.seen == std::vector<int>(m.triangle_count(), 1));
        CHECK(found.depth == static_cast<std::size_t>(std::bit_width(m.triangle_count() - 1U)));
    }
}

TEST_CASE("layouts take the bytes that the paper says") {
    const mesh m = sheet(40);
    const std::size_t n = m.triangles.size();
    canonical_tree canonical;
    canonical.build(m);
    CHECK(canonical.bytes() == 32 * (n - 1) + 28 * n);
    leafless_tree leafless;
    leafless.build(m);
    CHECK(leafless.bytes() == 32 * (n - 1));
}
