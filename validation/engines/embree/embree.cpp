module;
#include <memory>

module aabb.engines;

import aabb.pipeline;
import :engine;

namespace aabb {

// Defined in boxes.cpp.
std::unique_ptr<global_stage> make_embree_boxes(bool refit);

engine embree_engine() {
    return {.name = "embree",
            .summary = "Embree's collision of a scene with itself, on a tree of low quality built anew in each frame",
            .exact = true,
            .boxes = [] { return make_embree_boxes(false); }};
}

}  // namespace aabb
