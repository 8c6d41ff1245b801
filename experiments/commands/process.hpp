#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace aabblab {

/// What a program that ended by itself left.
struct ended_process {
    int status;
    std::vector<std::string> lines;  ///< that it printed
};

/// Runs a program to its end. It does not outlive this process.
/// @param log of what it says on standard error; empty: goes to ours
/// @throws aabb::input_error where it cannot be run, or ends otherwise than with 0 or 1.
[[nodiscard]] ended_process run_to_end(const std::filesystem::path& program, const std::vector<std::string>& arguments,
                                       const std::filesystem::path& log);

/// This program started afresh, which must print a line for all that is wrong.
/// @throws aabb::input_error also where it ends with 1 and has not said why.
[[nodiscard]] std::vector<std::string> lines_of_own_process(const std::vector<std::string>& arguments);

/// The folder of this program.
[[nodiscard]] std::filesystem::path own_folder();

}  // namespace aabblab
