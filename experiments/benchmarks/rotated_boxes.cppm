/// Separating axis tests between a box and a rotated box. AABB trees used them when the paper's references were
/// written, instead of an overlap test with the AABB of the rotated box.
export module aabblab.rotated_boxes;

import aabb.geometry;
import aabb.std;

// Floating-point expressions are evaluated as written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabblab {

/// A SIMD vector of three doubles, the precision in which `relative_pose` transforms boxes, and padding.
using three = double __attribute__((vector_size(32)));

/// The boxes of a pair of nodes: the vector between their centres, and the half extents, each in its box's frame.
struct box_pair {
    three between;  ///< from A's centre to B's, in A's frame
    three half_a;
    three half_b;
};

/// The transform from B's frame to A's, computed once per pair of meshes, and the separating axis tests. The tests are
/// conservative: `relative_pose` rounds the image of a vertex to float once, with an error of at most 2^-24 of B's
/// greatest coordinate in A's frame. A margin of four times that bounds this error along any axis of length at most 1,
/// which holds for all axes here, and all rounding errors in double.
class rotated_boxes {
public:
    /// Computes what all tests of a pair of meshes share: B's axes in A's frame (Aᵀ B), their transpose and absolute
    /// values, the shift between the origins, and the margin for rounding.
    /// @param b_bounds the bounds of B's vertices in B's frame
    rotated_boxes(const aabb::pose& a, const aabb::pose& b, const aabb::box& b_bounds) {
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t k = 0; k < 3; ++k) {
                shift_[i] +=
                    a.rotation[3 * k + i] * (b.translation[static_cast<int>(k)] - a.translation[static_cast<int>(k)]);
                for (std::size_t j = 0; j < 3; ++j) b_axes_[j][i] += a.rotation[3 * k + i] * b.rotation[3 * k + j];
            }
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t j = 0; j < 3; ++j) a_axes_[i][j] = b_axes_[j][i];
            b_magnitudes_[i] = magnitude(b_axes_[i]);
            a_magnitudes_[i] = magnitude(a_axes_[i]);
        }
        const aabb::box image = aabb::relative_pose(a, b, b_bounds)(b_bounds);
        double furthest = 0;
        for (int k = 0; k < 3; ++k)
            furthest = std::max({furthest, std::abs(double{image.min[k]}), std::abs(double{image.max[k]})});
        for (int k = 0; k < 3; ++k) margin_[k] = furthest * 0x1p-22;  // four times the rounding to float, 2^-24
    }

    /// Computes the centres and half extents of a box of A and one of B, in their frames.
    [[nodiscard, gnu::always_inline]] inline box_pair pair_of(const aabb::box& a, const aabb::box& b) const noexcept {
        const three low_a = doubles(a.min);
        const three high_a = doubles(a.max);
        const three low_b = doubles(b.min);
        const three high_b = doubles(b.max);
        const three centre_b = (low_b + high_b) * 0.5;
        const three image = shift_ + b_axes_[0] * centre_b[0] + b_axes_[1] * centre_b[1] + b_axes_[2] * centre_b[2];
        return {image - (low_a + high_a) * 0.5, (high_a - low_a) * 0.5, (high_b - low_b) * 0.5};
    }

    /// Tests the face normals of both boxes, the only axes in van den Bergen 1997.
    [[nodiscard, gnu::always_inline]] inline bool meet_by_faces(const box_pair& p) const noexcept {
        const three radius_a = p.half_a + weighed(b_magnitudes_, p.half_b) + margin_;
        if (any_beyond(p.between, radius_a)) return false;
        const three radius_b = p.half_b + weighed(a_magnitudes_, p.half_a) + margin_;
        return !any_beyond(weighed(a_axes_, p.between), radius_b);
    }

    /// Tests the nine cross products of edges, which complete the fifteen axes (Gottschalk, Lin and Manocha 1996).
    [[nodiscard, gnu::always_inline]] inline bool meet_by_edges(const box_pair& p) const noexcept {
        return !(edge_separates<0>(p) || edge_separates<1>(p) || edge_separates<2>(p));
    }

private:
    [[nodiscard]] static inline three doubles(const aabb::vec3f& v) noexcept { return {v[0], v[1], v[2], 0}; }
    [[nodiscard]] static inline three magnitude(const three& v) noexcept {
        return {std::abs(v[0]), std::abs(v[1]), std::abs(v[2]), 0};
    }
    [[nodiscard]] static inline three weighed(const std::array<three, 3>& axes, const three& by) noexcept {
        return axes[0] * by[0] + axes[1] * by[1] + axes[2] * by[2];
    }
    [[nodiscard]] static inline bool any_beyond(const three& distance, const three& radius) noexcept {
        const auto separated = (distance > radius) | (-distance > radius);
        return (separated[0] | separated[1] | separated[2]) != 0;
    }
    [[nodiscard]] static inline three yzx(const three& v) noexcept { return __builtin_shufflevector(v, v, 1, 2, 0, 3); }
    [[nodiscard]] static inline three zxy(const three& v) noexcept { return __builtin_shufflevector(v, v, 2, 0, 1, 3); }

    /// Whether one of the axes b × e, of B's axis b = J and A's edges e, separates the boxes. The edges are unit
    /// vectors, so cross products permute b's coordinates, and three axes are tested at once.
    template <std::size_t J>
    [[nodiscard]] inline bool edge_separates(const box_pair& p) const noexcept {
        constexpr std::size_t next = (J + 1) % 3;
        constexpr std::size_t last = (J + 2) % 3;
        const three& axis = b_axes_[J];
        const three& size = b_magnitudes_[J];
        const three distance = yzx(axis) * zxy(p.between) - zxy(axis) * yzx(p.between);
        const three radius_a = yzx(size) * zxy(p.half_a) + zxy(size) * yzx(p.half_a);
        const three radius_b = b_magnitudes_[next] * p.half_b[last] + b_magnitudes_[last] * p.half_b[next];
        return any_beyond(distance, radius_a + radius_b + margin_);
    }

    std::array<three, 3> b_axes_{};  // in A's frame
    std::array<three, 3> a_axes_{};  // in B's frame
    std::array<three, 3> b_magnitudes_{};
    std::array<three, 3> a_magnitudes_{};
    three shift_{};  // the origin of B's frame in A's
    three margin_{};
};

}  // namespace aabblab
