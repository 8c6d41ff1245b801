module;
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
        const spread along = spread_of(boxes, objects);
        const double margin = chosen_ ? 1.5 : 1.0;
        for (int k = 0; k < 3; ++k)
            if (along.variance[k] > margin * along.variance[axis_]) axis_ = k;
        chosen_ |= along.objects > 0;
        return axis_;
    }

    [[nodiscard]] int axis() const noexcept { return axis_; }

private:
    int axis_ = 0;
    bool chosen_ = false;
};

}  // namespace aabb
