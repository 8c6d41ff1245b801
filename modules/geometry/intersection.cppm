export module aabb.geometry:intersection;

import aabb.std;
import :pose;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// The kind of intersection of two closed triangles.
enum class intersection_kind : std::uint8_t {
    none,
    point,        ///< they touch in a point
    segment,      ///< they touch along a segment
    transversal,  ///< they pass through each other: their interiors intersect in a segment
    overlap       ///< they are coplanar and share a polygon
};
inline constexpr std::array<std::string_view, 5> intersection_kind_names = {"none", "point", "segment", "transversal",
                                                                            "overlap"};

[[nodiscard]] constexpr std::string_view name_of(intersection_kind kind) noexcept {
    return intersection_kind_names[static_cast<std::uint8_t>(kind)];
}

struct triangle_intersection {
    intersection_kind kind = intersection_kind::none;
    std::uint32_t size = 0;             ///< number of corners: 1 of a point, 2 of a segment, 3 to 6 of a polygon
    std::array<vec3d, 6> corners = {};  ///< the corners of a polygon in their order around it
    /// Bounds the error of a corner on each axis; 0 if all are corners of the triangles, which are not rounded.
    vec3d error = {};
};

/// Transforms an intersection from the frame of a mesh by the mesh's pose. The error bounds the distance from the image
/// of the true corners under the pose in real arithmetic:
///
/// R x + t is summed left to right, so a product rounds at most 4 times and t once: γ₄ (Σ |rⱼ xⱼ| + |t|), u = 2^-53,
/// plus half the smallest denormal for a product that underflows. An error e of the given corner becomes Σ |rⱼ| eⱼ. The
/// last factor covers rounding in the bound itself.
[[nodiscard]] inline triangle_intersection transformed(const triangle_intersection& common, const pose& by) noexcept {
    if (by == pose{}) return common;
    constexpr double unit = std::numeric_limits<double>::epsilon() / 2;
    triangle_intersection moved = common;
    moved.error = {};
    for (std::uint32_t i = 0; i < common.size; ++i)
        for (int k = 0; k < 3; ++k) {
            double sum = 0, magnitude = 0, inherited = 0;
            for (int j = 0; j < 3; ++j) {
                const double r = by.rotation[3 * k + j];
                const double product = r * common.corners[i][j];
                sum = j == 0 ? product : sum + product;
                magnitude += std::abs(product);
                inherited += std::abs(r) * common.error[j];
            }
            moved.corners[i][k] = sum + by.translation[k];
            magnitude += std::abs(by.translation[k]);
            // 5 u exceeds γ₄, and 4 denormals the underflow of three products.
            const double bound =
                (inherited + 5 * unit * magnitude + 4 * std::numeric_limits<double>::denorm_min()) * (1 + 16 * unit);
            if (bound > moved.error[k]) moved.error[k] = bound;
        }
    return moved;
}

}  // namespace aabb
