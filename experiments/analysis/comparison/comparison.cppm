/// What changed between the results of two runs, A and B: two commits, or two machines. Times are compared as ratios to
/// a peer in the same repeat, for machines and hours differ in speed; answers, counts and bytes do not vary at all.
export module aabblab.comparison;

import aabb.std;
import aabblab.results;
import aabblab.scenes;
import aabblab.statistics;

export namespace aabblab {

/// The results of one experiment, or of several, as `run` and `reproduce` leave them.
struct run_results {
    std::filesystem::path folder;
    std::vector<row> rows;
    std::vector<manifest_summary> manifests;  ///< one an experiment
};
/// From the folder of an experiment, or else from those of its sub-folders that hold a results.csv.
/// @throws aabb::input_error where there are no results, or some cannot be read or were altered, or an experiment is
/// there twice.
[[nodiscard]] run_results read_results(const std::filesystem::path& folder);

/// What made the results: "commit d27dba3, Clang 19.1.7, Intel Xeon". Several where experiments differ in it.
[[nodiscard]] std::string makers_of(const run_results& run);

/// @throws aabb::input_error where the two are of different processors, as far as their manifests tell: what is a
/// millisecond there says nothing here.
void require_one_machine(const run_results& a, const run_results& b);

/// How long a composition or an engine took a frame in a scene, over all its seeds: against the scene's base, or in
/// milliseconds.
struct compared_time {
    std::string label;  ///< the parts of the name that differ within the scene
    double in_a = 0;    ///< means as aabblab.statistics takes them
    double in_b = 0;
    double change = 1;                   ///< B's over A's
    interval around{};                   ///< of the change, 95 %, of this one alone
    outcome found = outcome::undecided;  ///< a change by Holm's rule over all compared with it; `same` alone
    bool too_few = false;                ///< no change, however large, could be told from accident with these repeats
};

/// A count or a number of bytes that is another in B. Sums over the scene's seeds.
struct changed_number {
    std::string label;
    std::string what;  ///< its column
    std::uint64_t in_a = 0;
    std::uint64_t in_b = 0;
};

/// A scene with all the seeds that A and B have both.
struct compared_scene {
    std::string experiment;
    scene_choice scene;  ///< `whatever_seed`
    std::string base;    ///< what `ratios` are to: the first in A that both have times of; empty where there is none
    std::vector<compared_time> ratios;
    std::vector<compared_time> times;
    std::vector<changed_number> changed;
};

/// A scene whose exact answer is not the same in A and B, which it must be.
struct different_answer {
    std::string experiment;
    scene_choice scene;
    std::string in_a;  ///< digests
    std::string in_b;
};

struct comparison {
    std::vector<different_answer> answers;
    std::vector<compared_scene> scenes;  ///< in the order of A
    std::size_t answers_compared = 0;    ///< scenes, each seed for itself
    std::size_t numbers_compared = 0;    ///< counts and bytes
    /// What only one of them has: compositions and engines in a scene, each seed for itself.
    std::size_t only_in_a = 0;
    std::size_t only_in_b = 0;
};

enum class compared { ratios, ratios_and_times };
/// Scenes are the same where experiment, kind, parameters and seed are.
/// @throws aabb::input_error where A and B have no scene in common.
[[nodiscard]] comparison compare(const run_results& a, const run_results& b, compared what);

struct compare_request {
    std::string a, b;    ///< folders
    bool times = false;  ///< milliseconds too
    bool all = false;    ///< also what is unchanged or undecided is listed
};

/// Prints what changed.
/// @returns the exit status: 1 where answers did
[[nodiscard]] int print_comparison(const compare_request& request);

}  // namespace aabblab
