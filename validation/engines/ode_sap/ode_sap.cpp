module;
#include <memory>

module aabb.engines;

import aabb.pipeline;
import :engine;

namespace aabb {

// Defined in ../ode_hash/boxes.cpp, which is in every build that has this file.
std::unique_ptr<global_stage> make_ode_sap();

engine ode_sap_engine() {
    return {.name = "ode_sap",
            .summary = "ODE's sweep along one axis, sorted by radix in each frame",
            .exact = true,
            .boxes = make_ode_sap};
}

}  // namespace aabb
