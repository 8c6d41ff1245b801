export module aabb.geometry:boxd;

import aabb.base;
import aabb.std;
import :box;
import :points;

export namespace aabb {

/// A `box` in double.
struct boxd {
    vec3d min;
    vec3d max;

    friend constexpr bool operator==(const boxd&, const boxd&) = default;

    /// Boxes are closed, so touching counts as overlapping.
    [[nodiscard]] constexpr bool overlaps(const boxd& other) const noexcept {
        for (int k = 0; k < 3; ++k)
            if (min[k] > other.max[k] || other.min[k] > max[k]) return false;
        return true;
    }
};

/// Rejects boxes with NaN, infinity or min > max.
/// @throws input_error with the index of the first such box and its fault
inline void require_valid(std::span<const boxd> boxes) {
    for (const boxd& b : boxes) {
        const auto fail = [&](const char* fault) {
            throw input_error("box " + std::to_string(&b - boxes.data()) + fault);
        };
        if (!is_finite(b.min) || !is_finite(b.max)) fail(" has a coordinate that is not finite");
        for (int k = 0; k < 3; ++k)
            if (b.min[k] > b.max[k]) fail(" is inverted: its minimum is above its maximum");
    }
}

}  // namespace aabb
