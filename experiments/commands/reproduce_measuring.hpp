#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "error_studies.hpp"

import aabblab.configs;

// Imports modules, so it is included after every other header.

/// The measuring of `reproduce`, and where it leaves what.
namespace aabblab {

/// Plays every experiment of the paper, and the studies and suites of the report, into a folder, and keeps what is
/// wrong as soon as it is found. What is there already of the same build and size stays. At the end the folder is
/// sealed.
void measure_reproduction(const std::filesystem::path& folder, bool quick);

/// What was wrong, a sentence each.
[[nodiscard]] std::vector<std::string> kept_failures(const std::filesystem::path& folder);

/// The project's studies of error against run time, as far as they have something to plot.
[[nodiscard]] std::vector<error_study> studies_with_curves(bool quick);
[[nodiscard]] std::filesystem::path folder_of_study(const std::filesystem::path& folder, const error_study& study);

/// The small atlas that stands in the report.
[[nodiscard]] std::filesystem::path folder_of_atlas(const std::filesystem::path& folder);

/// The suites of `validate` that stand in the report: "extreme", "stiff".
[[nodiscard]] std::filesystem::path file_of_suite(const std::filesystem::path& folder, const std::string& suite);

}  // namespace aabblab
