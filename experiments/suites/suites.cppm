/// What is played into a folder, told on the way and kept: experiments, studies of errors, the atlas, the suites of
/// `validate`.
export module aabblab.suites;

import aabb.std;
import aabblab.atlas;
import aabblab.configs;
import aabblab.figures;
import aabblab.results;
import aabblab.scenes;
import aabblab.tables;

export namespace aabblab {

/// Reads a config and says on standard error what stands in for meshes that are not there.
[[nodiscard]] experiment open_experiment(const std::string& config, bool quick);

/// A sentence for each engine that a scene has no use for.
/// @param called what they say of the scene
[[nodiscard]] std::vector<std::string> idle_engines(const experiment& e, const scene_choice& scene,
                                                    const std::string& called);

/// What is printed while an experiment is played: a table a scene, and one over all scenes at the end; with or without
/// the work of each composition; or nothing.
enum class printed { tables, tables_and_counts, nothing };

/// Plays an experiment into a folder, which it keeps others from writing into, in as many fresh processes as it asks
/// for, and says on standard error what is wrong. At the end a summary.csv stands beside the results. Interrupted
/// (Ctrl-C), it says that `resume_with` continues it.
/// @returns a sentence for each composition that is wrong
[[nodiscard]] std::vector<std::string> play_experiment(const experiment& e, const std::filesystem::path& folder,
                                                       existing_results existing, const std::string& resume_with,
                                                       printed shown);

/// One of these processes: plays its share of the repeats into results that are there. What is wrong goes to standard
/// output, a line each.
/// @returns whether nothing is
[[nodiscard]] bool play_share(const experiment& e, const std::filesystem::path& folder, std::size_t process);

/// The study of triangle tests, which `errors` measures where nothing is said.
[[nodiscard]] std::string usual_study();

/// Configs in a folder, by name.
[[nodiscard]] std::vector<std::filesystem::path> configs_in(const std::filesystem::path& folder);
/// Of the project's own studies of error against run time.
[[nodiscard]] std::vector<std::filesystem::path> error_configs();

/// Measures a study into a folder: its config, errors.csv or results.csv and intersections.csv; and what is printed,
/// tables and statements, with plots in a folder below.
/// @returns a sentence for each composition, and for each test's hits, that are wrong
std::vector<std::string> measure_study(const error_study& study, const std::filesystem::path& folder, printed shown);

/// Measures an atlas, the results of each experiment in a folder of their own. What is there already of the same build
/// and size stays.
/// @returns a sentence for each composition that is wrong
[[nodiscard]] std::vector<std::string> measure_atlas(const std::filesystem::path& folder, bool quick);

/// A sentence for each experiment of which results are missing.
[[nodiscard]] std::vector<std::string> unfinished_parts(const std::filesystem::path& folder);

/// Of the results that are in the folder; none where there are none.
[[nodiscard]] std::vector<atlas_scene> measured_atlas(const std::filesystem::path& folder);

/// What the suites of `validate` leave for the report of `reproduce`.
struct suite_report {
    std::vector<std::string> paragraphs;
    std::vector<figure> figures;
    std::vector<named_table> tables;
    std::vector<std::string> failures;  ///< what is not as it must be, a sentence each
};

/// Play a suite into a folder and print it, or nothing.
[[nodiscard]] suite_report play_extreme_suite(const std::filesystem::path& folder, const std::string& cases, bool quick,
                                              bool shown);
[[nodiscard]] suite_report play_stiff_suite(const std::filesystem::path& folder,
                                            const std::vector<std::string>& studies, bool quick, bool shown);
/// Of the rows that a suite left in a folder, or of what it drew, as earlier versions did; empty where there are none.
/// @throws aabb::input_error where they are something else.
[[nodiscard]] std::optional<suite_report> kept_report(const std::filesystem::path& folder);
/// The pairs of triangles that `validate extreme` takes where nothing is said.
[[nodiscard]] std::string usual_cases();

}  // namespace aabblab
