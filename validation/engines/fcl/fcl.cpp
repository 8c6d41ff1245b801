module;
#include <memory>

module aabb.engines;

import aabb.pipeline;
import :engine;

namespace aabb {

// Defined in boxes.cpp and meshes.cpp.
std::unique_ptr<global_stage> make_fcl_boxes();
std::unique_ptr<local_stage> make_fcl_meshes();

engine fcl_engine() {
    return {.name = "fcl",
            .summary = "FCL's dynamic AABB tree for boxes, and its trees of oriented boxes in double for meshes",
            .exact = false,
            .boxes = make_fcl_boxes,
            .meshes = make_fcl_meshes};
}

}  // namespace aabb
