#pragma once

#include <algorithm>

import aabb.validation;

namespace aabb {

/// Is the engine one that this build lacks?
inline bool is_left_out(const char* engine) {
    return std::ranges::find(left_out_engines(), engine, &left_out_engine::name) != left_out_engines().end();
}

}  // namespace aabb
