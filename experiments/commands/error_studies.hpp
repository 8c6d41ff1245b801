#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "experiments.hpp"

import aabblab.configs;

// Imports modules, so it is included after every other header.

/// What `errors` and `reproduce` share.
namespace aabblab {

/// Configs of the project's own studies, by name.
[[nodiscard]] std::vector<std::filesystem::path> error_configs();

/// Measures a study into a folder: its config, errors.csv or results.csv and intersections.csv, and what is printed,
/// tables and statements.
/// @returns a sentence for each composition, and for each test's hits, that are wrong
std::vector<std::string> measure_study(const error_study& study, const std::filesystem::path& folder, printed shown);

}  // namespace aabblab
