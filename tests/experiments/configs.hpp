#pragma once

#include "program.hpp"

import aabblab.configs;
import aabblab.results;
import aabblab.scenes;

/// The sentence with which the config of an experiment is refused; "accepted" where it is not.
[[nodiscard]] inline std::string rejection_of(const std::string& text, const std::string& file = "test.toml") {
    return refusal_in<aabb::input_error>(
        [&] { return aabblab::parse_experiment(text, file, aabblab::experiment_size::full); });
}
