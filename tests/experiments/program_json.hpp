#pragma once

#include <nlohmann/json.hpp>

#include "program.hpp"

/// The JSON that the program prints; it must succeed.
[[nodiscard]] inline nlohmann::json json_of(std::vector<std::string> arguments) {
    return nlohmann::json::parse(run_well(std::move(arguments)).out);
}
