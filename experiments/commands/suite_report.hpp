#pragma once

#include <filesystem>
#include <string>
#include <vector>

import aabblab.figures;
import aabblab.tables;

// Imports modules, so it is included after every other header.

/// What the suites of `validate` leave for the report of `reproduce`.
namespace aabblab {

struct captioned_table {
    std::string name;  ///< of its files
    std::string caption;
    table content;
};

struct suite_report {
    std::vector<std::string> paragraphs;
    std::vector<figure> figures;
    std::vector<captioned_table> tables;
    std::vector<std::string> failures;  ///< what is not as it must be, a sentence each
};

/// As JSON, so that a report can be written again without playing the suite.
void keep_report(const std::filesystem::path& file, const suite_report& report);
/// The inverse.
/// @throws aabb::input_error where it is not such a file.
[[nodiscard]] suite_report kept_report(const std::filesystem::path& file);

/// Play a suite into a folder and print it, or nothing.
[[nodiscard]] suite_report play_extreme_suite(const std::filesystem::path& folder, const std::string& cases, bool quick,
                                              bool shown);
[[nodiscard]] suite_report play_stiff_suite(const std::filesystem::path& folder,
                                            const std::vector<std::string>& studies, bool quick, bool shown);
/// The pairs of triangles that `validate extreme` takes where nothing is said.
[[nodiscard]] std::string usual_cases();

}  // namespace aabblab
