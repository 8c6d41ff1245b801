module;
#include <concepts>
#include <utility>
#include <vector>

export module aabb.local_detection:build_policy;

import aabb.geometry;
import aabb.policy;
import :balanced_order;
import :build_node;

export namespace aabb {

/// Makes what a layout packs: a binary tree, in which n triangles give n - 1 internal nodes, one triangle a leaf, in
/// the order that `build_node` says; or the order of triangles in a balanced tree. Boxes are the smallest ones. The
/// same for the same mesh on every machine; it ends on any mesh that `require_valid` accepts, however many centroids
/// are equal.
template <class B>
concept TreeBuilder = requires(const B builder, const mesh& m, leaf_arrangement arrangement) {
    { builder.build(m, arrangement) } -> std::same_as<std::vector<build_node>>;
    { builder.order(m) } -> std::same_as<balanced_order>;
};

template <class B>
concept BuildPolicy = Strategy<B> && TreeBuilder<B>;

/// A build whose type is not known where it is used: layouts are compiled apart from builds.
class tree_builder {
public:
    tree_builder() = default;
    tree_builder(const tree_builder&) = delete;
    tree_builder& operator=(const tree_builder&) = delete;
    virtual ~tree_builder() = default;

    [[nodiscard]] virtual std::vector<build_node> build(const mesh& m, leaf_arrangement arrangement) const = 0;
    [[nodiscard]] virtual balanced_order order(const mesh& m) const = 0;
};

template <BuildPolicy Build>
class built_by final : public tree_builder {
public:
    explicit built_by(Build build = {}) : build_(std::move(build)) {}
    [[nodiscard]] std::vector<build_node> build(const mesh& m, leaf_arrangement arrangement) const override {
        return build_.build(m, arrangement);
    }
    [[nodiscard]] balanced_order order(const mesh& m) const override { return build_.order(m); }

private:
    [[no_unique_address]] Build build_;
};

}  // namespace aabb
