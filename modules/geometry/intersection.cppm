export module aabb.geometry:intersection;

import aabb.std;
import :pose;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// What two closed triangles have in common.
enum class intersection_kind : std::uint8_t {
    none,
    point,        ///< they touch in a point
    segment,      ///< they touch along a segment
    transversal,  ///< they pass through each other: their interiors meet, in a segment
    overlap       ///< they lie in one plane and share a part of it, a polygon
};
inline constexpr std::array<std::string_view, 5> intersection_kind_names = {"none", "point", "segment", "transversal",
                                                                            "overlap"};

[[nodiscard]] constexpr std::string_view name_of(intersection_kind kind) noexcept {
    return intersection_kind_names[static_cast<std::uint8_t>(kind)];
}

/// The geometry of a hit.
struct triangle_intersection {
    intersection_kind kind = intersection_kind::none;
    std::uint32_t size = 0;             ///< corners: 1 of a point, 2 of a segment, 3 to 6 of a polygon
    std::array<vec3d, 6> corners = {};  ///< those of a polygon in their order around it
    /// No coordinate of a corner is off by more than this on its axis; 0 where all corners are corners of the
    /// triangles, which are given as they are.
    vec3d error = {};
};

/// What two triangles have in common in the frame of a mesh, carried to where its pose takes it. The error is held
/// against the image of the true corners under the pose as it is written, in real numbers:
///
/// R x + t is summed left to right, so a product rounds at most 4 times and t once: γ₄ (Σ |rⱼ xⱼ| + |t|), u = 2^-53,
/// and half the smallest denormal for a product that underflows. The error e that the corner brings with it becomes
/// Σ |rⱼ| eⱼ. The last factor stands for what rounds in the bound itself.
[[nodiscard]] inline triangle_intersection carried(const triangle_intersection& common, const pose& by) noexcept {
    if (by == pose{}) return common;
    constexpr double unit = std::numeric_limits<double>::epsilon() / 2;
    triangle_intersection made = common;
    made.error = {};
    for (std::uint32_t i = 0; i < common.size; ++i)
        for (int k = 0; k < 3; ++k) {
            double sum = 0;
            double magnitude = 0;
            double brought = 0;
            for (int j = 0; j < 3; ++j) {
                const double r = by.rotation[3 * k + j];
                const double product = r * common.corners[i][j];
                sum = j == 0 ? product : sum + product;
                magnitude += std::abs(product);
                brought += std::abs(r) * common.error[j];
            }
            made.corners[i][k] = sum + by.translation[k];
            magnitude += std::abs(by.translation[k]);
            const double bound =
                (brought + 5 * unit * magnitude + 4 * std::numeric_limits<double>::denorm_min()) * (1 + 16 * unit);
            if (bound > made.error[k]) made.error[k] = bound;
        }
    return made;
}

}  // namespace aabb
