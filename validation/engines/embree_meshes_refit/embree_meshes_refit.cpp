module;
#include <memory>

module aabb.engines;

import aabb.pipeline;
import :engine;

namespace aabb {

// Defined in ../embree_meshes/meshes.cpp, which is in every build that has this file.
std::unique_ptr<local_stage> make_embree_meshes_refit();

engine embree_meshes_refit_engine() {
    return {.name = "embree_meshes_refit",
            .summary = "as embree_meshes, with scenes that are refitted for each new pose and when vertices move",
            .meshes = make_embree_meshes_refit};
}

}  // namespace aabb
