module;
#include <memory>

module aabb.engines;

import aabb.pipeline;
import :engine;

namespace aabb {

// Defined in ../embree_meshes/meshes.cpp, which is in every build that has this file.
std::unique_ptr<local_stage> make_embree_meshes_low();

engine embree_meshes_low_engine() {
    return {.name = "embree_meshes_low",
            .summary = "as embree_meshes, with scenes of low quality, which are built faster",
            .meshes = make_embree_meshes_low};
}

}  // namespace aabb
