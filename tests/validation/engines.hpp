#pragma once

#include "support.hpp"

import aabb.pipeline;
import aabb.validation;

// Imports modules, so it is included after every other header.

namespace aabb {

/// Is the engine one that this build lacks?
inline bool is_left_out(const char* engine) {
    return std::ranges::find(left_out_engines(), engine, &left_out_engine::name) != left_out_engines().end();
}

/// @param take an engine that has taken nothing yet
template <class Take>
void for_each_box_engine(Take take) {
    for (const engine_info& info : engines()) {
        if (!info.searches_boxes) continue;
        INFO(info.name);
        take(*make_box_engine(info.name));
    }
}

/// @param take an engine that has taken nothing yet, and what is said of it
template <class Take>
void for_each_mesh_engine(Take take) {
    for (const engine_info& info : engines()) {
        if (!info.collides_meshes) continue;
        INFO(info.name);
        take(*make_mesh_engine(info.name), info);
    }
}

}  // namespace aabb
