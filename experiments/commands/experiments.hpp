#pragma once

#include <string>
#include <vector>

import aabblab.config;
import aabblab.results;

// Imports modules, so it is included after every other header.

/// What the commands on experiments share.
namespace aabblab {

/// Reads a config and says on standard error what stands in for meshes that are not there.
[[nodiscard]] experiment open_experiment(const std::string& config, bool quick);

/// Validates and times scene by scene; prints each scene's table when it is done, and failures on standard error.
/// Interrupted (Ctrl-C), it says that `resume_with` continues it.
/// @returns the failures
[[nodiscard]] std::vector<std::string> play_experiment(const experiment& e, results_folder& results,
                                                       const std::string& resume_with);

}  // namespace aabblab
