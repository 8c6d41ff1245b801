#pragma once

import aabb.std;
import aabblab.filters;

namespace aabblab {

class command_parser;

/// Adds the options --groups and --except.
void add_filter_options(const command_parser& command, filter_files* files);

/// Rejects an output that would overwrite a file of the filter.
/// @throws aabb::input_error if both paths refer to the same file.
void require_no_filter(const std::string& out, const filter_files& files);

/// What follows a scene's name in a heading: ", filtered by groups.csv"; empty without a filter.
[[nodiscard]] std::string filter_text(const filter_files& files);

}  // namespace aabblab
