#pragma once
#include <optional>
#include <string>
#include <vector>

import aabb.geometry;

namespace aabblab {

/// The pose that an option gives: twelve numbers with commas between, the rows of [R t]. Without one, the mesh is as it
/// is.
/// @throws aabb::input_error that names the option, on anything else or a pose that is not rigid.
[[nodiscard]] aabb::pose pose_of(const std::optional<std::string>& text, const char* option);

/// Poses of a file, one a line, with commas or blanks between numbers; `#` begins a comment.
/// @throws aabb::input_error with file and line, as `pose_of`, and on a file without poses.
[[nodiscard]] std::vector<aabb::pose> read_poses(const std::string& file);

}  // namespace aabblab
