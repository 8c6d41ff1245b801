module;
#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

export module aabb.local_detection:tree_build;

import aabb.geometry;
import aabb.policy;
import :build_node;

export namespace aabb {

/// How a node's triangles are split; see `median_split`, `mean_split` and `sah_split`.
enum class build_method : std::uint8_t { median, mean, sah };

/// Whether a node of an even number of triangles has two children of even numbers, so that leaves come in pairs: the
/// split moves by one triangle where it must. For layouts in which a leaf beside an internal node wastes memory.
enum class leaf_pairing : std::uint8_t { any, even };

/// The parameter `build` of a tree layout.
template <class Config>
[[nodiscard]] constexpr auto build_parameter(build_method Config::* field) {
    return choice_parameter{"build", field, std::array<std::string_view, 3>{"median", "mean", "sah"},
                            "where a node is split: at the median or the mean of its triangles' centroids along its "
                            "longest axis, or by the surface-area heuristic"};
}

/// Builds a tree with one triangle a leaf: n triangles give n - 1 internal nodes. With `median` the depth is ⌈log₂ n⌉,
/// paired or not. The same tree for the same mesh on every machine; it ends on any mesh, however many centroids are
/// equal, and deep trees cost heap, not stack.
/// @param m a mesh that `require_valid` accepts.
[[nodiscard]] std::vector<build_node> build_tree(const mesh& m, build_method method, leaf_pairing pairing);

}  // namespace aabb
