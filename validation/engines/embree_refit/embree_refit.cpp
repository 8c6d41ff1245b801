module;
#include <memory>

module aabb.engines;

import aabb.pipeline;
import :engine;

namespace aabb {

// Defined in ../embree/boxes.cpp, which is in every build that has this file.
std::unique_ptr<global_stage> make_embree_boxes(bool refit);

engine embree_refit_engine() {
    return {.name = "embree_refit",
            .summary = "the same on a good tree that is refitted while the number of boxes stays; for little motion",
            .exact = true,
            .boxes = [] { return make_embree_boxes(true); }};
}

}  // namespace aabb
