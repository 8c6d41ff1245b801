#pragma once

#include "program.hpp"

import aabblab.configs;
import aabblab.results;
import aabblab.scenes;

/// The message that rejects the config of an experiment; "accepted" if it is valid.
[[nodiscard]] inline std::string rejection_of(const std::string& text, const std::string& file = "test.toml") {
    return refusal_in<aabb::input_error>(
        [&] { return aabblab::parse_experiment(text, file, aabblab::experiment_size::full); });
}
