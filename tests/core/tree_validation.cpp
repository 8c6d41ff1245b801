#include "../testing.hpp"

import aabb;

using namespace aabb;

namespace {

/// A tree as the test gives it, valid or not.
struct given_tree {
    static constexpr std::string_view name = "given";
    static constexpr std::string_view summary = "what a test gives";
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
static_assert(TreePolicy<given_tree>);

const mesh two_triangles{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, 5}}, {{0, 1, 2}, {3, 3, 3}}};
const box root_box{{0, 0, 0}, {5, 5, 5}};
const box left{{0, 0, 0}, {1, 1, 0}};
const box right{{5, 5, 5}, {5, 5, 5}};

tree_validation validate_tree(std::vector<given_tree::node> nodes) {
    return validate(given_tree{std::move(nodes)}, two_triangles);
}

}  // namespace

TEST_CASE("validation finds no fault in a valid tree") {
    const tree_validation validation = validate_tree({{root_box, {1, 2}, 0}, {left, {}, 0}, {right, {}, 1}});
    CHECK(validation.fault.empty());
    CHECK(validation.depth == 1);
    CHECK(validation.tight);
    CHECK(validation.area_inflation == 0);
}

TEST_CASE("validation reports boxes that are larger than necessary") {
    const tree_validation validation =
        validate_tree({{{{0, 0, 0}, {5, 5, 10}}, {1, 2}, 0}, {left, {}, 0}, {right, {}, 1}});
    CHECK(validation.fault.empty());
    CHECK_FALSE(validation.tight);
    CHECK(validation.area_inflation == (250.0 + 2) / (150.0 + 2) - 1);
}

TEST_CASE("validation finds the fault of an invalid tree") {
    CHECK(validate_tree({{{{0, 0, 0}, {4, 5, 5}}, {1, 2}, 0}, {left, {}, 0}, {right, {}, 1}}).fault ==
          "a box does not contain the triangles below it");
    CHECK(validate_tree({{root_box, {1, 2}, 0}, {{{0, 0, 0}, {1, 0.5F, 0}}, {}, 0}, {right, {}, 1}}).fault ==
          "a box does not contain the triangles below it");
    CHECK(validate_tree({{root_box, {1, 2}, 0}, {left, {}, 0}, {left, {}, 0}}).fault == "triangle 0 is in two leaves");
    CHECK(validate_tree({{root_box, {1, 2}, 0}, {left, {}, 0}, {right, {}, 7}}).fault ==
          "a leaf holds triangle 7, which the mesh does not have");
    CHECK(validate_tree({{left, {}, 0}}).fault == "triangle 1 is in no leaf");
    CHECK(validate_tree({{root_box, {0, 1}, 0}, {right, {}, 1}}).fault == "the tree has more levels than triangles");
}
