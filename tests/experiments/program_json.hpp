#pragma once

#include <nlohmann/json.hpp>

#include "program.hpp"

/// What the program prints where it succeeds.
[[nodiscard]] inline nlohmann::json json_of(std::vector<std::string> arguments) {
    return nlohmann::json::parse(run_well(std::move(arguments)).out);
}
