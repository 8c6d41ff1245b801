#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

import aabb.geometry;

namespace aabblab {

/// The pose that an option gives: twelve numbers with commas between, the rows of [R t]. Without one, the mesh is as it
/// is.
/// @throws aabb::input_error that names the option, on anything else or a pose that is not rigid.
[[nodiscard]] aabb::pose pose_of(const std::optional<std::string>& text, const char* option);

struct poses_of_file {
    std::vector<aabb::pose> poses;
    std::vector<std::size_t> lines;  ///< on which each stands, from 1
};
/// One a line, with commas or blanks between numbers; `#` begins a comment.
/// @throws aabb::input_error with file and line, as `pose_of`, and on a file without poses.
[[nodiscard]] poses_of_file read_poses(const std::string& file);

}  // namespace aabblab
