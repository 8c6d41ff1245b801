#pragma once

#include <string>
#include <vector>

import aabblab.scenes;

namespace aabblab {

/// What a command takes in place of a config, for help texts.
inline constexpr const char* scene_arguments_help =
    "A recording (.aabbs); one or two meshes (files in OFF, OBJ, PLY, STL or glTF, or shapes), which pass through each "
    "other; or a motion file and its meshes";

/// Whether it is the name of a config.
[[nodiscard]] bool names_config(const std::string& argument);

/// The scene that these arguments name.
/// @throws aabb::input_error where they name none.
[[nodiscard]] scene_choice scene_of_arguments(const std::vector<std::string>& arguments);

}  // namespace aabblab
