/// Experiments as config files: which scenes, which compositions and engines, what to measure.
export module aabblab.configs;

import aabb.costs;
import aabb.extreme;
import aabb.pipeline;
import aabb.registry;
import aabb.std;
import aabblab.metrics;
import aabblab.scenes;

export namespace aabblab {

/// A program of others, in a process of its own: it is given a recording, and writes pairs of boxes and its times.
struct external_engine {
    std::string name;
    std::vector<std::string> command;  ///< as it is written; the names of three files are added
    std::string program;               ///< the first word of it, where it was found
    std::string place;                 ///< where the command stands in the config, "FILE:LINE"
    bool exact = true;                 ///< a difference from the exact answer is a failure, not a measurement
    std::uint64_t timeout_s = 600;     ///< after which it is killed
};

/// What is asked of local detection, and timed.
enum class question : std::uint8_t {
    pairs,  ///< every pair of intersecting triangles
    count,  ///< how many there are
    first   ///< any one
};
inline constexpr std::array<std::string_view, 3> question_names{"pairs", "count", "first"};

/// How the queries of a scene of meshes are timed.
struct asking {
    question ask = question::pairs;
    bool cold = false;  ///< the processor's caches hold other things before each query

    friend bool operator==(const asking&, const asking&) = default;
};

/// A config with its lists multiplied out. All names, values and combinations in it are known to be good.
struct experiment {
    std::string name;
    std::string file;  ///< the config, as the user named it
    std::string text;  ///< what stands in it
    bool quick = false;
    std::vector<std::string> engines;
    std::vector<external_engine> externals;  ///< have no part in scenes of meshes
    std::vector<scene_choice> scenes;
    std::string content_digest;                   ///< of the scenes' meshes, and of the frames of files that they play
    std::vector<aabb::composition> compositions;  ///< scenes of boxes use the global search of each only
    /// What each `auto` names itself; the rest is selected scene by scene.
    std::vector<aabb::named_strategies> automatic;
    std::size_t repeats = 9;
    std::size_t processes = 1;  ///< fresh ones, one after the other, that share the repeats
    /// Who takes so many times as long as the fastest in the first repeat is not repeated.
    std::optional<std::uint64_t> patience;
    asking how;
    /// What rows hold beside the pairs and their digest; compute metrics later what they will.
    std::set<metric_group> recorded{metric_group::time, metric_group::counts, metric_group::bytes, metric_group::error};
    std::vector<std::string> shown;  ///< metrics that tables have columns of beside the usual ones
    std::vector<std::string> notes;  ///< what stands in for meshes that are not there, a sentence each

    [[nodiscard]] bool records(metric_group group) const { return recorded.contains(group); }
};

/// All of it, that of each `auto` as it is for a scene of which nothing is known.
[[nodiscard]] std::vector<aabb::composition> every_composition(const experiment& e);

/// `quick` takes what the config says under `quick`, for a first look.
enum class experiment_size { full, quick };

/// Reads a config and checks all of it, down to making each scene once.
/// @throws aabb::input_error with file and line on malformed TOML (column too), an unknown key or name (with the
/// nearest one), a value of a wrong type, a refused combination, a mesh or a file that is not there or cannot be played
/// to its end. A relative path to such a file is taken as given, else from the folder of the config.
[[nodiscard]] experiment read_experiment(const std::filesystem::path& file, experiment_size size);

/// The same from text. `file` is for messages.
[[nodiscard]] experiment parse_experiment(const std::string& text, const std::string& file, experiment_size size);

/// A triangle test by the name and the settings that configs and options give it: a strategy, or one of a library.
/// @throws aabb::input_error on an unknown name, with the nearest one, and on settings that it has not.
[[nodiscard]] std::unique_ptr<aabb::triangle_test> triangle_test_named(const aabb::strategy_choice& choice);

/// Those that construct what two triangles have in common too: strategies, then tests of libraries.
[[nodiscard]] std::vector<std::string> constructing_tests();

struct pair_set {
    std::string pair_class;
    bool in_double = false;
    std::uint64_t count = 0;
    std::uint64_t seed = 1;
};

/// A method over its knob, with every value of the parameters that have several; one of the lists is empty.
struct error_curve {
    std::string label;
    std::vector<aabb::strategy_choice> triangles;  ///< tests that are held against pairs of triangles
    std::vector<aabb::composition> compositions;   ///< that play scenes whole
};

/// One metric of compositions over another, by their names.
struct metric_plot {
    std::string x;
    std::string y;
};

/// A config of `errors`. Either what triangle tests get wrong, against the time they take, on generated pairs and on
/// the triangles of meshes whose boxes overlap; or, with `whole`, metrics of compositions that play scenes.
struct error_study {
    std::string name;
    std::string text;  ///< what stands in the config
    std::vector<error_curve> curves;
    /// Whose hits, `count` of each, are held against CGAL's exact construction.
    std::vector<pair_set> hits;
    std::vector<std::string> notes;
    std::vector<pair_set> pairs;
    std::vector<scene_choice> scenes;  ///< of meshes
    std::optional<experiment> whole;   ///< with the compositions of all curves
    std::vector<metric_plot> plots;
};

/// @throws aabb::input_error as `read_experiment`.
[[nodiscard]] error_study read_error_study(const std::filesystem::path& file, experiment_size size);
[[nodiscard]] error_study parse_error_study(const std::string& text, const std::string& file, experiment_size size);

/// `[[case]]`s with name, source, about, class, first, second, intersect and, where doubles differ, intersect_double.
/// @throws aabb::input_error with file and line on malformed TOML, an unknown or missing key, a name that stands twice,
/// what is no triangle, or a coordinate beyond the range of float.
[[nodiscard]] std::vector<aabb::triangle_case> read_triangle_cases(const std::filesystem::path& file);
/// The same from text. `file` is for messages.
[[nodiscard]] std::vector<aabb::triangle_case> parse_triangle_cases(const std::string& text, const std::string& file);

/// Costs that were measured, and on what: who computes otherwise has others.
struct kept_costs {
    std::string version;       ///< of the program that measured
    std::string date;          ///< "2026-01-31T12:00:00Z"
    std::string processor;     ///< its model
    std::string instructions;  ///< "AVX-512"; what the program was built for
    aabb::cost_model costs;

    /// Whether they hold for a program of that version, on that processor, built for those instructions.
    [[nodiscard]] bool serve(const kept_costs& here) const {
        return version == here.version && processor == here.processor && instructions == here.instructions;
    }
};

/// Those of this program on this machine, dated now, with the costs that are given.
[[nodiscard]] kept_costs costs_here(const aabb::cost_model& costs);
/// As a TOML file.
[[nodiscard]] std::string text_of(const kept_costs& kept);
/// @throws aabb::input_error with file and line on malformed TOML, an unknown key (with the nearest one), a cost that
/// is not there or not a number above 0. Of another version, whose costs may be others, all but the costs is read.
[[nodiscard]] kept_costs read_costs(const std::filesystem::path& file);
/// The same from text. `file` is for messages.
[[nodiscard]] kept_costs parse_costs(const std::string& text, const std::string& file);

/// Where `calibrate` keeps the user's: $XDG_CONFIG_HOME/aabblab/costs.toml, else ~/.config/aabblab/costs.toml.
/// @returns an empty path where the environment names neither folder.
[[nodiscard]] std::filesystem::path kept_costs_file();
/// Takes them, where there are any, for the whole process in place of those that the program was shipped with; a note
/// says so of those that are of another machine.
/// @throws aabb::input_error as `read_costs`.
void use_kept_costs();
/// "costs as shipped", or "costs calibrated 2026-01-31T12:00:00Z (FILE)".
[[nodiscard]] std::string costs_in_force();

/// XXH3-64 of all that decides the results: compositions, engines, what is measured, the scenes and what is in their
/// meshes and files. How the config is written, and its comments, do not matter. 16 hexadecimal digits.
[[nodiscard]] std::string hash_of(const experiment& e);

}  // namespace aabblab
