module;
#include <bit>
#include <cstddef>
#include <span>

export module aabb.global_search:chosen_axis;

import aabb.geometry;
import :membership;
import :projection;
import :spread;

export namespace aabb {

/// The axis on which the boxes' centres vary most. It changes only when another varies half as much again, since a new
/// list must be sorted from scratch.
class chosen_axis {
public:
    int choose(std::span<const box> boxes, const membership& objects) {
        return choose(spread_of(boxes, objects), every_axis);
    }

    /// One of these; at least one.
    int choose(const spread& along, axis_set among) {
        const auto is_among = [among](int k) { return has_axis(among, static_cast<std::size_t>(k)); };
        const double margin = chosen_ && is_among(axis_) ? 1.5 : 1.0;
        if (!is_among(axis_)) axis_ = std::countr_zero(among);
        for (int k = 0; k < 3; ++k)
            if (is_among(k) && along.variance[k] > margin * along.variance[axis_]) axis_ = k;
        chosen_ |= along.objects > 0;
        return axis_;
    }

    [[nodiscard]] int axis() const noexcept { return axis_; }

private:
    int axis_ = 0;
    bool chosen_ = false;
};

}  // namespace aabb
