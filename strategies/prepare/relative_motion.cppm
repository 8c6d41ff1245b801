export module aabb.prepare.relative_motion;

export import aabb.global_search;
export import aabb.simd;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

struct relative_motion {
    double margin;              ///< see `motion_between`
    double in_both_directions;  ///< also bounds the margin by which the earlier boxes, shrunk, lie in the later ones

    bool operator==(const relative_motion&) const = default;
};

}  // namespace aabb

namespace aabb::detail {

/// The least and the greatest displacement of box planes along each axis. The initial values are finite, so that
/// displacements that overflow to infinity yield an infinite range.
struct motion_range {
    vec3f least{std::numeric_limits<float>::max(), std::numeric_limits<float>::max(),
                std::numeric_limits<float>::max()};
    vec3f most{std::numeric_limits<float>::lowest(), std::numeric_limits<float>::lowest(),
               std::numeric_limits<float>::lowest()};
};

/// The displacements of lower and of upper planes.
struct plane_motion {
    motion_range lower;
    motion_range upper;

    /// Extends the ranges of displacements by those of one box, whose planes moved from `from` to `to`.
    void take(const box& from, const box& to) noexcept {
        const auto widen = [](motion_range& range, int k, float moved) {
            range.least[k] = std::min(range.least[k], moved);
            range.most[k] = std::max(range.most[k], moved);
        };
        for (int k = 0; k < 3; ++k) {
            widen(lower, k, to.min[k] - from.min[k]);
            widen(upper, k, to.max[k] - from.max[k]);
        }
    }
};

/// The ranges of displacements of the lower and the upper planes of all boxes, by axis. Three vectors hold a whole
/// number of boxes (`block`) of six floats, so that a lane has the same plane in each block.
[[nodiscard]] inline plane_motion plane_motion_between(std::span<const box> from, std::span<const box> to) noexcept {
    constexpr std::size_t block = simd::width / 2;
    plane_motion motion;
    const std::size_t in_vectors = to.size() / block * block;
    if (in_vectors > 0) {
        // The displacements in vector v of the block that begins at box `row`.
        const auto moved = [&](std::size_t row, std::size_t v) {
            simd::floats a, b;
            const std::size_t at = row * sizeof(box) + v * sizeof a;
            std::memcpy(&a, reinterpret_cast<const char*>(from.data()) + at, sizeof a);
            std::memcpy(&b, reinterpret_cast<const char*>(to.data()) + at, sizeof b);
            return b - a;
        };
        simd::floats least[3], most[3];
        for (std::size_t v = 0; v < 3; ++v) least[v] = most[v] = moved(0, v);
        for (std::size_t row = block; row < in_vectors; row += block)
            for (std::size_t v = 0; v < 3; ++v) {
                const simd::floats d = moved(row, v);
                least[v] = d < least[v] ? d : least[v];
                most[v] = d > most[v] ? d : most[v];
            }
        float down[3 * simd::width], up[3 * simd::width];
        std::memcpy(down, least, sizeof down);
        std::memcpy(up, most, sizeof up);
        // Reduces the boxes of the block to one, halving their number in each step.
        for (std::size_t half = 3 * simd::width / 2; half >= 6; half /= 2)
            for (std::size_t i = 0; i < half; ++i) {
                down[i] = std::min(down[i], down[half + i]);
                up[i] = std::max(up[i], up[half + i]);
            }
        for (int k = 0; k < 3; ++k) {
            motion.lower.least[k] = std::min(motion.lower.least[k], down[k]);
            motion.lower.most[k] = std::max(motion.lower.most[k], up[k]);
            motion.upper.least[k] = std::min(motion.upper.least[k], down[3 + k]);
            motion.upper.most[k] = std::max(motion.upper.most[k], up[3 + k]);
        }
    }
    for (std::size_t i = in_vectors; i < to.size(); ++i) motion.take(from[i], to[i]);
    return motion;
}

/// Half of the range, rounded up by the largest possible rounding error.
[[nodiscard]] inline double margin_between(double least, double most) noexcept {
    return (most - least + 0x1p-23 * (std::abs(most) + std::abs(least))) / 2;
}

/// The margin by which the earlier boxes must grow to contain the later ones, if all are also shifted by one vector. If
/// planes move by `least` to `most` on an axis, a shift by the middle of this range leaves half of it as margin. The
/// margin `in_both_directions` also suffices for the converse: the earlier boxes, shrunk by it, lie in the later ones.
[[nodiscard]] inline relative_motion motion_of(const plane_motion& motion) noexcept {
    relative_motion moved{};
    for (int k = 0; k < 3; ++k) {
        // Boxes extend beyond the earlier ones by lower planes that move down and by upper planes that move up.
        moved.margin = std::max(moved.margin, margin_between(motion.lower.least[k], motion.upper.most[k]));
        moved.in_both_directions =
            std::max(moved.in_both_directions, margin_between(std::min(motion.lower.least[k], motion.upper.least[k]),
                                                              std::max(motion.lower.most[k], motion.upper.most[k])));
    }
    return moved;
}

}  // namespace aabb::detail

export namespace aabb {

/// The overload for scenes in which all objects are present.
[[nodiscard]] inline relative_motion motion_between(std::span<const box> from, std::span<const box> to) noexcept {
    return detail::motion_of(detail::plane_motion_between(from, to));
}

/// The motion of the present objects' boxes relative to their common motion: the least margin by which the earlier
/// boxes, grown on every side and shifted together, contain the later ones. A common motion such as free fall counts as
/// none. Never less than the exact margin: each difference has an error of at most half a unit in the last place.
///
/// As long as the later boxes lie in the earlier ones thus grown and shifted, any two that overlap now also overlapped
/// when grown. The result is unspecified for invalid boxes.
/// @param from, to boxes by id, of equal number
[[nodiscard]] inline relative_motion motion_between(std::span<const box> from, std::span<const box> to,
                                                    const membership& objects) noexcept {
    if (objects.size() == to.size()) return motion_between(from, to);
    detail::plane_motion motion;
    for (std::uint32_t id = 0; id < to.size(); ++id)
        if (objects.contains(id)) motion.take(from[id], to[id]);
    return detail::motion_of(motion);
}

/// Grows valid boxes on every side by at least a margin. All rounding errors total at most 2^-23 of the margin and
/// 2^-24 of the coordinate, so 2^-22 of both is added: lower ends fall and upper ends rise by (1 + 2^-22) margin +
/// 2^-22 |coordinate|, computed in float. Results are clamped to the greatest float.
/// @param margin at least 0
/// @param grown output, as long as `boxes`
inline void grow(std::span<const box> boxes, double margin, std::span<box> grown) {
    constexpr float greatest = std::numeric_limits<float>::max();
    const double with_rounding = margin * (1 + 0x1p-22) + double{std::numeric_limits<float>::min()};
    const auto wide = static_cast<float>(std::min(with_rounding, double{greatest}));
    // Three vectors hold an integer number of boxes, as in `plane_motion_between`.
    constexpr std::size_t block = simd::width / 2;
    constexpr std::size_t numbers = 3 * simd::width;
    simd::floats sign[3];
    // A box is three lower ends, which fall, and three upper ends, which rise.
    for (std::size_t i = 0; i < numbers; ++i) sign[i / simd::width][i % simd::width] = i % 6 < 3 ? -1.0F : 1.0F;
    for (std::size_t begin = 0; begin < boxes.size(); begin += block) {
        const std::size_t bytes = std::min(block, boxes.size() - begin) * sizeof(box);
        simd::floats rows[3]{};
        std::memcpy(rows, &boxes[begin], bytes);
        for (std::size_t v = 0; v < 3; ++v) {
            const simd::floats x = rows[v];
            const simd::floats size = x < 0.0F ? -x : x;
            simd::floats moved = x + sign[v] * (wide + 0x1p-22F * size);
            moved = moved < greatest ? moved : simd::broadcast(greatest);
            rows[v] = moved > -greatest ? moved : simd::broadcast(-greatest);
        }
        std::memcpy(&grown[begin], rows, bytes);
    }
}

}  // namespace aabb
