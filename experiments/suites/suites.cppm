/// Runs experiments, studies of errors, the atlas and the suites of `validate`, reports progress and stores results.
export module aabblab.suites;

import aabb.std;
import aabblab.atlas;
import aabblab.configs;
import aabblab.figures;
import aabblab.results;
import aabblab.scenes;
import aabblab.tables;

export namespace aabblab {

/// Reads a config, and notes on standard error which meshes are missing and how they are replaced.
[[nodiscard]] experiment open_experiment(const std::string& config, bool quick);

/// A sentence for each engine that cannot run in a scene.
/// @param scene_name the noun for the scene in these sentences
[[nodiscard]] std::vector<std::string> idle_engines(const experiment& e, const scene_choice& scene,
                                                    const std::string& scene_name);

/// The output of a running experiment: a table per scene and one over all scenes at the end, with or without the work
/// of each composition, or nothing.
enum class printed { tables, tables_and_counts, nothing };

/// Runs an experiment in the configured number of processes, locks the folder meanwhile, and notes failures on standard
/// error. At the end it writes summary.csv next to the results. When interrupted (Ctrl-C), it prints that `resume_with`
/// continues it.
/// @returns a sentence for each composition with wrong results
[[nodiscard]] std::vector<std::string> run_experiment(const experiment& e, const std::filesystem::path& folder,
                                                      existing_results existing, const std::string& resume_with,
                                                      printed shown);

/// Runs the share of one of these processes, appends to existing results, and prints a line per failure.
/// @returns true if there were no failures
[[nodiscard]] bool run_process(const experiment& e, const std::filesystem::path& folder, std::size_t process);

/// The study of triangle tests, the default of `errors`.
[[nodiscard]] std::string default_study();

/// The configs in a folder, sorted by name.
[[nodiscard]] std::vector<std::filesystem::path> configs_in(const std::filesystem::path& folder);
/// The configs of the project's own studies of error against run time.
[[nodiscard]] std::vector<std::filesystem::path> error_configs();

/// Runs a study, and writes its config, errors.csv or results.csv, and intersections.csv to the folder. If shown, also
/// prints tables and statements, and draws plots in a sub-folder.
/// @returns a sentence for each composition with wrong results, and for each test with wrong hits
std::vector<std::string> measure_study(const error_study& study, const std::filesystem::path& folder, printed shown);

/// Runs an experiment of an atlas, and records the measures of its scenes beside its rows.
/// @returns a sentence for each composition with wrong results
[[nodiscard]] std::vector<std::string> measure_part_of_atlas(const experiment& e, const std::filesystem::path& folder);
/// Runs the experiments of an atlas in sub-folders; resumes existing results of the same build and size.
/// @returns a sentence for each composition with wrong results
[[nodiscard]] std::vector<std::string> measure_atlas(const std::filesystem::path& folder, bool quick);

/// Writes times.csv to `out`: every time of the experiments in the folder.
void write_times_of_atlas(const std::filesystem::path& out, const std::filesystem::path& folder);

/// A sentence for each experiment with missing results.
[[nodiscard]] std::vector<std::string> unfinished_parts(const std::filesystem::path& folder);

/// The atlas of the results in the folder, which may be incomplete; empty if there are none.
[[nodiscard]] std::vector<atlas_scene> measured_atlas(const std::filesystem::path& folder);
/// The laws of borders that the results in the folder determine.
[[nodiscard]] std::vector<border_law> measured_laws(const std::filesystem::path& folder);

/// The results of a suite of `validate`, for the report of `reproduce`.
struct suite_report {
    std::vector<std::string> paragraphs;
    std::vector<figure> figures;
    std::vector<named_table> tables;
    std::vector<std::string> failures;  ///< a sentence per failure
};

/// Runs a suite, stores its results in a folder, and prints them if `shown`.
[[nodiscard]] suite_report run_extreme_suite(const std::filesystem::path& folder, const std::string& cases, bool quick,
                                             bool shown);
[[nodiscard]] suite_report run_stiff_suite(const std::filesystem::path& folder, const std::vector<std::string>& studies,
                                           bool quick, bool shown);
/// Compares what each study measures with inexact, stale and lost contacts with what it measures with exact ones.
/// Writes methods.csv after each study, in which rows of other studies stay, and prints it as a table.
void compare_stiff_methods(const std::filesystem::path& folder, const std::vector<std::string>& studies, bool quick);
/// The report from what a suite stored in the folder; empty if that is nothing, or an interrupted extreme suite.
/// @throws aabb::input_error if the files have another format.
[[nodiscard]] std::optional<suite_report> stored_report(const std::filesystem::path& folder);
/// The pairs of triangles that `validate extreme` uses by default.
[[nodiscard]] std::string default_cases();

}  // namespace aabblab
