export module aabb.geometry:box;

import aabb.base;
import aabb.std;
import :points;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// Axis-aligned bounding box: the closed set min[k] <= x[k] <= max[k].
struct box {
    vec3f min;
    vec3f max;

    friend constexpr bool operator==(const box&, const box&) = default;
};
static_assert(sizeof(box) == 24);

/// The empty box, the neutral element of `merged`.
[[nodiscard]] constexpr box empty_box() noexcept {
    constexpr float huge = std::numeric_limits<float>::infinity();
    return {{huge, huge, huge}, {-huge, -huge, -huge}};
}

/// Boxes are closed, so touching counts as overlapping. Without early exits, so that loops over it vectorize.
[[nodiscard]] constexpr bool overlaps(const box& a, const box& b) noexcept {
    unsigned disjoint = 0;
    for (int k = 0; k < 3; ++k)
        disjoint |= static_cast<unsigned>(a.min[k] > b.max[k]) | static_cast<unsigned>(b.min[k] > a.max[k]);
    return disjoint == 0;
}

[[nodiscard]] constexpr bool contains(const box& outer, const box& inner) noexcept {
    for (int k = 0; k < 3; ++k)
        if (inner.min[k] < outer.min[k] || inner.max[k] > outer.max[k]) return false;
    return true;
}

[[nodiscard]] constexpr box merged(const box& a, const box& b) noexcept {
    return {{std::min(a.min[0], b.min[0]), std::min(a.min[1], b.min[1]), std::min(a.min[2], b.min[2])},
            {std::max(a.max[0], b.max[0]), std::max(a.max[1], b.max[1]), std::max(a.max[2], b.max[2])}};
}

[[nodiscard]] constexpr box bounds_of(const vec3f& p) noexcept {
    return {p, p};
}
[[nodiscard]] constexpr box bounds_of(const triangle3f& t) noexcept {
    return merged(merged(bounds_of(t[0]), bounds_of(t[1])), bounds_of(t[2]));
}

/// The surface area of a box that is not empty, in double to avoid overflow.
[[nodiscard]] constexpr double surface_area(const box& b) noexcept {
    const double x = double{b.max[0]} - double{b.min[0]};
    const double y = double{b.max[1]} - double{b.min[1]};
    const double z = double{b.max[2]} - double{b.min[2]};
    return 2 * (x * y + y * z + z * x);
}

/// The axis with the greatest extent; the lowest such axis.
[[nodiscard]] constexpr int longest_axis(const box& b) noexcept {
    int longest = 0;
    for (int k = 1; k < 3; ++k)
        if (b.max[k] - b.min[k] > b.max[longest] - b.min[longest]) longest = k;
    return longest;
}

/// A finite box with min <= max on every axis.
[[nodiscard]] inline bool is_valid(const box& b) noexcept {
    constexpr float most = std::numeric_limits<float>::max();
    unsigned valid = 1;
    for (int k = 0; k < 3; ++k)
        valid &= static_cast<unsigned>(b.min[k] >= -most) & static_cast<unsigned>(b.min[k] <= b.max[k]) &
                 static_cast<unsigned>(b.max[k] <= most);
    return valid != 0;
}

/// Rejects boxes with NaN, infinity or min > max.
/// @throws input_error with the index of the first such box and its fault
inline void require_valid(std::span<const box> boxes) {
    bool valid = true;
    for (const box& b : boxes) valid &= is_valid(b);
    if (valid) return;
    const auto bad = std::ranges::find_if_not(boxes, is_valid);
    const std::string name = "box " + std::to_string(bad - boxes.begin());
    if (!is_finite(bad->min) || !is_finite(bad->max)) throw input_error(name + " has a coordinate that is not finite");
    throw input_error(name + " is inverted: its minimum is above its maximum");
}

}  // namespace aabb
