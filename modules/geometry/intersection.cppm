export module aabb.geometry:intersection;

import aabb.std;
import :points;

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

}  // namespace aabb
