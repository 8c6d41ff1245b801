/// Compares the results of two runs, A and B: of two commits, or two machines. Times are compared as ratios to a
/// baseline in the same repeat, because speed varies with machine and hour; digests, counts and bytes do not vary.
export module aabblab.comparison;

import aabb.std;
import aabblab.results;
import aabblab.scenes;
import aabblab.statistics;

export namespace aabblab {

/// The results of one or several experiments, as written by `run` and `reproduce`.
struct run_results {
    std::filesystem::path folder;
    std::vector<row> rows;
    std::vector<manifest_summary> manifests;  ///< one per experiment
};
/// Reads the folder of one experiment, or otherwise each of its sub-folders that holds a results.csv.
/// @throws aabb::input_error if results are missing, unreadable or altered, or if an experiment occurs twice.
[[nodiscard]] run_results read_results(const std::filesystem::path& folder);

/// The time per frame of a composition or an engine in a scene, over all seeds: relative to the baseline, or in ms.
struct compared_time {
    std::string label;  ///< the parts of the name that differ within the scene
    double in_a = 0;    ///< means over the cells, as in aabblab.statistics
    double in_b = 0;
    double change = 1;                     ///< the ratio of B to A
    interval change_range{};               ///< 95 % interval of the change, without correction
    outcome verdict = outcome::undecided;  ///< changes are corrected by Holm's rule, `same` is not
    bool lacks_repeats = false;            ///< with so few repeats, even the largest change is insignificant
};

/// A count or a number of bytes that differs in B, summed over the scene's seeds.
struct changed_number {
    std::string label;
    std::string quantity;  ///< its column in results.csv
    std::uint64_t in_a = 0, in_b = 0;
};

/// A scene with the seeds that A and B share.
struct compared_scene {
    std::string experiment;
    scene_choice scene;    ///< `without_seed`
    std::string baseline;  ///< denominator of `ratios`: the first in A that is timed in both; empty if there is none
    std::vector<compared_time> ratios;
    std::vector<compared_time> times;
    std::vector<changed_number> changed;
};

/// A scene whose exact compositions report different pairs in A and B, which is always an error.
struct different_result {
    std::string experiment;
    scene_choice scene;
    std::string in_a;  ///< digests
    std::string in_b;
};

struct comparison {
    std::vector<different_result> different_results;
    std::vector<compared_scene> scenes;  ///< in the order of A
    std::size_t results_compared = 0;    ///< scenes; each seed counts separately
    std::size_t numbers_compared = 0;    ///< counts and bytes
    /// Compositions and engines in a scene that occur on one side only; each seed counts separately.
    std::size_t only_in_a = 0, only_in_b = 0;
};

enum class compared { ratios, ratios_and_times };
/// Scenes match if experiment, kind, parameters and seed are equal.
/// @throws aabb::input_error if A and B have no scene in common.
[[nodiscard]] comparison compare(const run_results& a, const run_results& b, compared quantities);

struct compare_request {
    std::string a, b;       ///< folders
    bool times = false;     ///< milliseconds too
    bool list_all = false;  ///< lists unchanged and undecided ones, too
};

/// Prints the changes.
/// @returns the exit status: 1 if any digest differs
[[nodiscard]] int print_comparison(const compare_request& request);

}  // namespace aabblab
