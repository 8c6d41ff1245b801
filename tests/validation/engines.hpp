#pragma once

#include "support.hpp"

import aabb.pipeline;
import aabb.validation;

// Imports modules, so it is included after every other header.

namespace aabb {

/// Whether this build lacks the engine.
inline bool is_left_out(const char* engine) {
    return std::ranges::find(left_out_engines(), engine, &left_out_engine::name) != left_out_engines().end();
}

/// @param visit is called with a new instance of each engine
template <class Visit>
void for_each_box_engine(Visit visit) {
    for (const engine_info& info : engines()) {
        if (!info.searches_boxes) continue;
        INFO(info.name);
        visit(*make_box_engine(info.name));
    }
}

/// @param visit is called with a new instance of each engine, and its description
template <class Visit>
void for_each_mesh_engine(Visit visit) {
    for (const engine_info& info : engines()) {
        if (!info.collides_meshes) continue;
        INFO(info.name);
        visit(*make_mesh_engine(info.name), info);
    }
}

}  // namespace aabb
