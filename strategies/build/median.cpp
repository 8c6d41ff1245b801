module;
#include <vector>

module aabb.build.median;

import aabb.geometry;
import aabb.local_detection;
import aabb.build.balanced;
import aabb.build.top_down;

namespace aabb {

std::vector<build_node> median_build::build(const mesh& m, leaf_arrangement arrangement) const {
    return build_top_down(m, arrangement, median_split, threads);
}

balanced_order median_build::order(const mesh& m) const {
    return order_by_halves(m, axis_rule::longest, threads);
}

}  // namespace aabb
