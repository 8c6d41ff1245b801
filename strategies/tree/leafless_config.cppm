module;
#include <array>
#include <string_view>
#include <tuple>

export module aabb.tree.leafless_config;

import aabb.local_detection;
import aabb.policy;

export namespace aabb {

/// Parameters of a layout that keeps no leaf boxes.
struct leafless_config {
    leaf_test_choice leaf_test = leaf_test_choice::none;

    /// Möller's original may cull a pair that touches.
    [[nodiscard]] constexpr bool is_exact() const noexcept {
        return leaf_test != leaf_test_choice::moller_triangle_box;
    }
};

inline constexpr std::tuple leafless_parameters{
    choice_parameter{"leaf_test", &leafless_config::leaf_test,
                     std::array<std::string_view, 4>{"none", "triangle_box", "triangle_aabb", "moller_triangle_box"},
                     "what is tested in place of a leaf's box: nothing, the triangle against the other box, or the "
                     "triangle's own box; moller_triangle_box is Möller's original of the second and inexact"}};

}  // namespace aabb
