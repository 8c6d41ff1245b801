export module aabb.global_search:spread;

import aabb.std;
import :membership;
import :projection;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

// The distribution of boxes along the axes, by which strategies choose axes.

export namespace aabb {

/// The variance of the boxes' centres and the mean of their extents, by axis.
struct spread {
    std::size_t objects;
    vec3d variance;  ///< of the doubled centres, times the number of objects
    vec3d extent;    ///< mean
};

/// The mean extent of the present objects' boxes on each axis, and the variance of their doubled centres times their
/// number, Σx² - (Σx)² / n. Sums are in the order of ids, so that ties in a sort do not change them, and relative to
/// the first centre, so that no digits cancel far from the origin.
[[nodiscard]] inline spread spread_of(std::span<const box> boxes, const membership& objects) {
    spread result{};
    vec3d first{}, sum{}, squares{};
    for (std::uint32_t id = 0; id < boxes.size(); ++id) {
        if (!objects.contains(id)) continue;
        const box& b = boxes[id];
        for (int k = 0; k < 3; ++k) {
            const double doubled_centre = double{b.min[k]} + double{b.max[k]};
            if (result.objects == 0) first[k] = doubled_centre;
            sum[k] += doubled_centre - first[k];
            squares[k] += (doubled_centre - first[k]) * (doubled_centre - first[k]);
            result.extent[k] += double{b.max[k]} - double{b.min[k]};
        }
        ++result.objects;
    }
    if (result.objects == 0) return result;
    const auto n = static_cast<double>(result.objects);
    for (int k = 0; k < 3; ++k) {
        result.variance[k] = std::max(0.0, squares[k] - sum[k] / n * sum[k]);
        result.extent[k] /= n;
    }
    return result;
}

/// The distance on each axis from the least upper end of the present objects' boxes to the greatest lower end. If it is
/// not positive, all boxes overlap on the axis, so that a sweep along it excludes no pair.
[[nodiscard]] inline vec3d separation_of(std::span<const box> boxes, const membership& objects) {
    vec3f last_lower = empty_box().max;
    vec3f first_upper = empty_box().min;
    for (std::uint32_t id = 0; id < boxes.size(); ++id) {
        if (!objects.contains(id)) continue;
        for (int k = 0; k < 3; ++k) {
            last_lower[k] = std::max(last_lower[k], boxes[id].min[k]);
            first_upper[k] = std::min(first_upper[k], boxes[id].max[k]);
        }
    }
    vec3d separation{};
    for (int k = 0; k < 3; ++k) separation[k] = double{last_lower[k]} - double{first_upper[k]};
    return separation;
}

/// The axes on which some two boxes are disjoint; at least one axis.
[[nodiscard]] constexpr axis_set separating_axes(const vec3d& separation) noexcept {
    axis_set axes = 0;
    for (int k = 0; k < 3; ++k) axes |= static_cast<axis_set>(separation[k] > 0) << k;
    return axes ? axes : axis_set{1};
}

/// The axis with the greatest variance of the boxes' centres. It changes only if the variance on another axis is 50%
/// greater, since a new list is sorted from scratch.
class chosen_axis {
public:
    int choose(std::span<const box> boxes, const membership& objects) {
        return choose(spread_of(boxes, objects), every_axis);
    }

    /// Chooses the axis of greatest variance among some, at least one, but keeps the last choice unless another's is
    /// 50% greater: axes of similar variance would alternate, and each change sorts a new list from scratch.
    int choose(const spread& along, axis_set among) {
        const auto is_among = [among](int k) { return has_axis(among, static_cast<std::size_t>(k)); };
        const double margin = has_chosen_ && is_among(axis_) ? 1.5 : 1.0;
        if (!is_among(axis_)) axis_ = std::countr_zero(among);
        for (int k = 0; k < 3; ++k)
            if (is_among(k) && along.variance[k] > margin * along.variance[axis_]) axis_ = k;
        has_chosen_ |= along.objects > 0;
        return axis_;
    }

    [[nodiscard]] int axis() const noexcept { return axis_; }

private:
    int axis_ = 0;
    bool has_chosen_ = false;
};

}  // namespace aabb
