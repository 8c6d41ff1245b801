module;
#include <memory>

module aabb.engines;

import aabb.pipeline;
import :engine;

namespace aabb {

// Defined in meshes.cpp.
std::unique_ptr<local_stage> make_embree_meshes();

engine embree_meshes_engine() {
    return {.name = "embree_meshes",
            .summary =
                "Embree's collision of two scenes of medium quality, built anew for each new pose, with Devillers "
                "and Guigue's test in double",
            .meshes = make_embree_meshes};
}

}  // namespace aabb
