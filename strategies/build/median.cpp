module;
#include <vector>

module aabb.build.median;

import aabb.geometry;
import aabb.local_detection;
import aabb.build.top_down;

namespace aabb {

std::vector<build_node> median_build::build(const mesh& m, leaf_arrangement arrangement) {
    return build_top_down(m, arrangement, median_split);
}

}  // namespace aabb
