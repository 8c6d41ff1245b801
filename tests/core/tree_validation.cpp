#include "../testing.hpp"

import aabb;

using namespace aabb;

namespace {

/// A tree as it is told to be, right or wrong.
struct told_tree {
    static constexpr std::string_view name = "told";
    static constexpr std::string_view summary = "what a test says";
    static constexpr bool has_leaf_boxes = true;
    using cursor = std::size_t;

    struct node {
        box bounds;
        std::array<std::size_t, 2> child;  // 0 in a leaf
        std::uint32_t triangle;
    };
    std::vector<node> nodes;

    void pack(std::span<const build_node>) {}
    void refit(const mesh&, std::vector<box>&) {}
    [[nodiscard]] static cursor root(const mesh&) { return 0; }
    [[nodiscard]] bool is_leaf(cursor at) const { return nodes[at].child[0] == 0 && nodes[at].child[1] == 0; }
    [[nodiscard]] std::array<cursor, 2> children(cursor at, const mesh&) const { return nodes[at].child; }
    [[nodiscard]] const box& bounds(cursor at) const { return nodes[at].bounds; }
    [[nodiscard]] std::uint32_t triangle(cursor at) const { return nodes[at].triangle; }
    [[nodiscard]] static tree_bytes bytes() { return {}; }
};
static_assert(TreePolicy<told_tree>);

const mesh two{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}}, {{0, 1, 2}, {3, 3, 3}}};
const box all{{0, 0, 0}, {5, 5, 5}};
const box left{{0, 0, 0}, {1, 1, 0}};
const box right{{5, 5, 5}, {5, 5, 5}};

tree_validation validate_tree(std::vector<told_tree::node> nodes) {
    return validate(told_tree{std::move(nodes)}, two);
}

}  // namespace

TEST_CASE("a survey finds nothing wrong with a tree that is right") {
    const tree_validation validated = validate_tree({{all, {1, 2}, 0}, {left, {}, 0}, {right, {}, 1}});
    CHECK(validated.fault.empty());
    CHECK(validated.depth == 1);
    CHECK(validated.tight);
    CHECK(validated.area_inflation == 0);
}

TEST_CASE("a survey tells of boxes that are larger than they must be") {
    const tree_validation validated =
        validate_tree({{{{0, 0, 0}, {5, 5, 10}}, {1, 2}, 0}, {left, {}, 0}, {right, {}, 1}});
    CHECK(validated.fault.empty());
    CHECK_FALSE(validated.tight);
    CHECK(validated.area_inflation == (250.0 + 2) / (150.0 + 2) - 1);
}

TEST_CASE("a survey finds what is wrong with a tree") {
    CHECK(validate_tree({{{{0, 0, 0}, {4, 5, 5}}, {1, 2}, 0}, {left, {}, 0}, {right, {}, 1}}).fault ==
          "a box does not contain the triangles below it");
    CHECK(validate_tree({{all, {1, 2}, 0}, {{{0, 0, 0}, {1, 0.5F, 0}}, {}, 0}, {right, {}, 1}}).fault ==
          "a box does not contain the triangles below it");
    CHECK(validate_tree({{all, {1, 2}, 0}, {left, {}, 0}, {left, {}, 0}}).fault == "triangle 0 is in two leaves");
    CHECK(validate_tree({{all, {1, 2}, 0}, {left, {}, 0}, {right, {}, 7}}).fault ==
          "a leaf holds triangle 7, which the mesh does not have");
    CHECK(validate_tree({{left, {}, 0}}).fault == "triangle 1 is in no leaf");
    CHECK(validate_tree({{all, {0, 1}, 0}, {right, {}, 1}}).fault == "the tree has more levels than triangles");
}
