module;
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

export module aabb.local_detection:triangle_block;

import aabb.geometry;
import aabb.simd;
import :wide_node;
import :wide_tree_policy;

export namespace aabb {

/// The triangles below a node of level 0, coordinate by coordinate, and their boxes. Where there are less than eight,
/// the last one fills the rest.
struct triangle_block {
    static constexpr std::size_t width = wide_node::most_children;
    using row = std::array<float, width>;

    alignas(32) std::array<std::array<row, 3>, 3> corner;  ///< corner c, axis k: [c][k]
    alignas(32) std::array<row, 3> lower;
    alignas(32) std::array<row, 3> upper;
    std::uint32_t triangles;

    /// As they lie in the mesh.
    template <WideTreePolicy Tree>
    void load(const mesh& m, const Tree& tree, std::uint32_t leaf) noexcept {
        triangles = tree.level(0)[leaf].children;
        std::array<const std::uint32_t*, width> vertices;
        for (std::uint32_t i = 0; i < width; ++i)
            vertices[i] = m.triangles[tree.triangle_at(width * leaf + std::min(i, triangles - 1))].data();
        for (std::size_t c = 0; c < 3; ++c) {
            std::array<const float*, width> points;
            for (std::size_t i = 0; i < width; ++i) points[i] = m.vertices[vertices[i][c]].at;
            simd::store_columns_of_eight_points(points.data(), corner[c][0].data());
        }
    }

    /// Takes them to A's frame.
    void move(const relative_pose& to_a) noexcept {
        for (auto& axes : corner) {
            std::array<simd::eight_doubles, 3> x;
            for (std::size_t k = 0; k < 3; ++k)
                x[k] =
                    __builtin_convertvector(simd::load_eight<simd::eight_floats>(axes[k].data()), simd::eight_doubles);
            x = to_a.images(x);
            for (std::size_t k = 0; k < 3; ++k)
                simd::store_eight(axes[k].data(), __builtin_convertvector(x[k], simd::eight_floats));
        }
    }

    void bound() noexcept {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto at = [&](std::size_t c) { return simd::load_eight<simd::eight_floats>(corner[c][k].data()); };
            const auto low = __builtin_elementwise_min(__builtin_elementwise_min(at(0), at(1)), at(2));
            const auto high = __builtin_elementwise_max(__builtin_elementwise_max(at(0), at(1)), at(2));
            simd::store_eight(lower[k].data(), low);
            simd::store_eight(upper[k].data(), high);
        }
    }
};

}  // namespace aabb
