/// The reproduction from its configs to its report: what is measured, and where it leaves what.
export module aabblab.measuring;

import aabb.std;
import aabblab.configs;
import aabblab.reproduction;

export namespace aabblab {

struct reproduce_request {
    std::optional<std::string> out;
    std::optional<std::string> archive;  ///< to be written, of what was judged
    std::vector<std::string> sources;    ///< folders and archives to judge, in place of the one of `out`
    bool quick = false;
    bool judge = false;  ///< results that are there
};

/// Measures, judges and reports, and prints the verdicts.
/// @returns the exit status: 1 where anything is wrong
/// @throws aabb::input_error where results are not there, are damaged or do not go together.
[[nodiscard]] int reproduce(const reproduce_request& request);

}  // namespace aabblab

// What the parts of the module share.
namespace aabblab {

/// Plays every experiment of the paper, and the studies and suites of the report, into a folder, and keeps what is
/// wrong as soon as it is found. What is there already of the same build and size stays. At the end the folder is
/// sealed.
void measure_reproduction(const std::filesystem::path& folder, bool quick);

/// What was wrong, a sentence each.
[[nodiscard]] std::vector<std::string> kept_failures(const std::filesystem::path& folder);

/// The project's studies of error against run time, as far as they have something to plot.
[[nodiscard]] std::vector<error_study> studies_with_curves(bool quick);
[[nodiscard]] inline std::filesystem::path folder_of_study(const std::filesystem::path& folder,
                                                           const error_study& study) {
    return folder / "errors" / study.name;
}

/// The suites of `validate` that stand in the report: "extreme", "stiff".
[[nodiscard]] inline std::filesystem::path file_of_suite(const std::filesystem::path& folder,
                                                         const std::string& suite) {
    return folder / suite / "report.json";
}

/// What the reports have behind the claims, from what was measured in the folder: errors against run time, the extreme
/// scenes, the stiff ones, the atlas.
[[nodiscard]] std::vector<report_section> sections_of_reproduction(const std::filesystem::path& folder, bool quick);

}  // namespace aabblab
