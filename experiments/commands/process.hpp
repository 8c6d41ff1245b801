#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace aabblab {

/// Runs a program to its end and takes the lines that it prints. It does not outlive this process.
/// @param log of what it says on standard error; empty: goes to ours
/// @throws aabb::input_error where it cannot be run, or ends otherwise than with 0 or 1.
[[nodiscard]] std::vector<std::string> lines_of_process(const std::filesystem::path& program,
                                                        const std::vector<std::string>& arguments,
                                                        const std::filesystem::path& log);

/// The same of this program, started afresh.
[[nodiscard]] std::vector<std::string> lines_of_own_process(const std::vector<std::string>& arguments);

/// The folder of this program.
[[nodiscard]] std::filesystem::path own_folder();

}  // namespace aabblab
