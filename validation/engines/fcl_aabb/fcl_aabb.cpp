module;
#include <memory>

module aabb.engines;

import aabb.pipeline;
import :engine;

namespace aabb {

// Defined in ../fcl/meshes.cpp, which is in every build that has this file.
std::unique_ptr<local_stage> make_fcl_aabb_meshes();

engine fcl_aabb_engine() {
    return {
        .name = "fcl_aabb",
        .summary =
            "FCL's trees of axis-aligned boxes, the second mesh's refitted for each new pose, with vertices rounded "
            "to float in the first one's frame",
        .exact = false,
        .meshes = make_fcl_aabb_meshes};
}

}  // namespace aabb
