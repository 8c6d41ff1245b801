#pragma once

#include <filesystem>
#include <string>
#include <vector>

import aabblab.atlas;

// Imports modules, so it is included after every other header.

/// The measuring of an atlas, and where it leaves what: the results of each experiment in a folder of their own.
namespace aabblab {

/// What is there already of the same build and size stays.
/// @returns a sentence for each composition that is wrong
[[nodiscard]] std::vector<std::string> measure_atlas(const std::filesystem::path& folder, bool quick);

/// A sentence for each experiment of which results are missing.
[[nodiscard]] std::vector<std::string> unfinished_parts(const std::filesystem::path& folder);

/// Of the results that are in the folder; none where there are none.
[[nodiscard]] std::vector<atlas_scene> measured_atlas(const std::filesystem::path& folder);

}  // namespace aabblab
