module;
#include <memory>

module aabb.engines;

import aabb.pipeline;
import :engine;

namespace aabb {

// Defined in boxes.cpp.
std::unique_ptr<global_stage> make_ode_hash();

engine ode_hash_engine() {
    return {
        .name = "ode_hash",
        .summary = "ODE's hashed grid with cells of several sizes; with a bit for each pair, for 131,071 boxes at most",
        .exact = true,
        .boxes = make_ode_hash};
}

}  // namespace aabb
