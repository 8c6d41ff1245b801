/// Boxes of a tree's nodes in the world, in double.
export module aabb.distance.placed_boxes;

export import aabb.geometry;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// Moves boxes of a mesh's floats to the world: a moved box contains R v + t for each vertex v whose float is in the
/// box, with t relative to a translation that both meshes share.
///
/// On an axis, let M be the sum of magnitudes of |R| v for the vertices with the greatest coordinates in the mesh's
/// box, of its frame's origin, and of t. Bounds of vertices, the centre and half the extent of the box, their products
/// and sums round any term at most twelve times: 2^-46 of M, 128 u, is ample. Underflow of a bound is multiplied by
/// |R|, and that of a product is not: 2^-1070 of each. Where M could overflow, the margin is infinite.
class placed_boxes {
public:
    /// @param translation rounded at most once
    /// @param bounds of all boxes that will be moved
    placed_boxes(const pose& at, const vec3d& translation, const vertex_frame& frame, const box& bounds) noexcept
        : rotation_(at.rotation), translation_(translation), frame_(frame), rounding_(in_double(frame.rounding)) {
        for (int k = 0; k < 3; ++k) {
            double magnitude = std::abs(translation[k]), sum = 1;
            for (int j = 0; j < 3; ++j) {
                const double greatest =
                    std::max(std::abs(double{bounds.min[j]}), std::abs(double{bounds.max[j]})) + rounding_[j];
                const double size = std::abs(entry(k, j));
                magnitude += size * (std::abs(frame.origin[j]) + frame.scale * greatest);
                sum += size;
            }
            margin_[k] =
                magnitude <= 0x1p1020 ? 0x1p-46 * magnitude + 0x1p-1070 * sum : std::numeric_limits<double>::infinity();
        }
    }

    [[nodiscard]] inline boxd operator()(const box& b) const noexcept {
        const vec3d low = frame_.vertex(in_double(b.min) - rounding_);
        const vec3d high = frame_.vertex(in_double(b.max) + rounding_);
        boxd world{};
        for (int k = 0; k < 3; ++k) {
            double centre = translation_[k], radius = margin_[k];
            for (int j = 0; j < 3; ++j) {
                centre += entry(k, j) * (low[j] / 2 + high[j] / 2);
                radius += std::abs(entry(k, j)) * (high[j] / 2 - low[j] / 2);
            }
            world.min[k] = centre - radius;
            world.max[k] = centre + radius;
        }
        return world;
    }

private:
    [[nodiscard]] inline double entry(int k, int j) const noexcept {
        return rotation_[static_cast<std::size_t>(3 * k + j)];
    }

    std::array<double, 9> rotation_;
    vec3d translation_;
    vertex_frame frame_;
    vec3d rounding_;
    vec3d margin_{};
};

/// The square of a lower bound on the distance of two such boxes; 0 where a bound is infinite or NaN. The gaps round
/// once, so that the result is at most 1 + 2^-49 of the true square, or 2^-1073 more.
[[nodiscard]] inline double squared_gap(const boxd& a, const boxd& b) noexcept {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
        const double above = b.min[k] - a.max[k], below = a.min[k] - b.max[k];
        const double gap = above > below ? above : below;
        sum += gap > 0 ? gap * gap : 0;
    }
    return sum;
}

/// A bound with which `squared_gap` is compared: greater only if the distance is more than d.
[[nodiscard]] inline double square_not_below(double d) noexcept {
    return d * d * (1 + 0x1p-40) + 0x1p-1060;
}

/// The length by which the node to open first is chosen.
[[nodiscard]] inline double longest_extent(const boxd& b) noexcept {
    return std::max({b.max[0] - b.min[0], b.max[1] - b.min[1], b.max[2] - b.min[2]});
}

}  // namespace aabb
