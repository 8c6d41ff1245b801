#pragma once

import aabb.std;

/// Costs that `calibrate` keeps for the user, and the program takes in place of those that it was shipped with.
namespace aabblab {

/// Where they are kept: $XDG_CONFIG_HOME/aabblab/costs.toml, else ~/.config/aabblab/costs.toml.
/// @returns an empty path where the environment names neither folder.
[[nodiscard]] std::filesystem::path kept_costs_file();

/// Takes them, where there are any, for the whole process; a note says so of those that are of another machine.
/// @throws aabb::input_error as `read_costs`.
void use_kept_costs();

/// "costs as shipped", or "costs calibrated 2026-01-31T12:00:00Z (FILE)".
[[nodiscard]] std::string costs_in_force();

}  // namespace aabblab
