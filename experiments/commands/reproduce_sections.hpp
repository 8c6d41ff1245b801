#pragma once

#include <filesystem>
#include <vector>

import aabblab.reproduction;

// Imports modules, so it is included after every other header.

namespace aabblab {

/// What the reports of `reproduce` have behind the claims, from what was measured in the folder: errors against run
/// time, the extreme scenes, the stiff ones, the atlas.
[[nodiscard]] std::vector<report_section> sections_of_reproduction(const std::filesystem::path& folder, bool quick);

}  // namespace aabblab
