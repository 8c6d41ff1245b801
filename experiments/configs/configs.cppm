/// Config files describe experiments: the scenes, the compositions and engines to run, and what to measure.
export module aabblab.configs;

import aabb.costs;
import aabb.extreme;
import aabb.pipeline;
import aabb.registry;
import aabb.std;
import aabblab.metrics;
import aabblab.scenes;

export namespace aabblab {

/// A third-party program that runs in its own process: it reads a recording and writes box pairs and timings.
struct external_engine {
    std::string name;
    std::vector<std::string> command;  ///< as written in the config; three file names are appended
    std::string program;               ///< the resolved path of the command's first word
    std::string place;                 ///< where the config defines the command, "FILE:LINE"
    bool exact = true;                 ///< a difference from the ground truth is then a failure, not a measurement
    std::uint64_t timeout_s = 600;     ///< the process is killed after this time
};

/// The query that the narrow phase runs, key `ask` of a config.
enum class query_kind : std::uint8_t {
    pairs,  ///< report every pair of intersecting triangles
    count,  ///< report only the number of such pairs
    first   ///< stop at any such pair
};
inline constexpr std::array<std::string_view, 3> query_names{"pairs", "count", "first"};

/// How the queries of a scene are timed.
struct query_settings {
    query_kind kind = query_kind::pairs;
    bool cold = false;        ///< the processor's caches hold other data before each query
    bool says_moved = false;  ///< each method is given the ids of the boxes that have moved, outside its time

    friend bool operator==(const query_settings&, const query_settings&) = default;
};

/// A config with its lists expanded to their Cartesian product. Every name, value and combination is validated.
struct experiment {
    std::string name;
    std::string file;  ///< the path of the config, as the user wrote it
    std::string text;  ///< its contents
    bool quick = false;
    std::vector<std::string> engines;
    std::vector<external_engine> externals;  ///< run on scenes of boxes only
    std::vector<scene_choice> scenes;
    std::string content_digest;                   ///< of the scenes' meshes and of the frames of their files
    std::vector<aabb::composition> compositions;  ///< scenes of boxes use only the broad phase of each
    /// The strategies that each `auto` fixes; the others are selected per scene.
    std::vector<aabb::named_strategies> automatic;
    std::size_t repeats = 9;
    std::size_t processes = 1;  ///< fresh processes, run one after another, that share the repeats
    /// Early stopping: a candidate slower than this multiple of the fastest in the first repeat is not repeated.
    std::optional<std::uint64_t> patience;
    query_settings query;
    /// What each row records beside the pairs and their digest, so that metrics can be computed from it later.
    std::set<metric_group> recorded{metric_group::time, metric_group::counts, metric_group::bytes, metric_group::error};
    std::vector<std::string> shown;  ///< metrics that tables show in additional columns
    std::vector<std::string> notes;  ///< sentences for the user, such as which mesh replaces one that is absent

    [[nodiscard]] bool records(metric_group group) const { return recorded.contains(group); }
};

/// Every composition of the experiment, with each `auto` as it is selected without knowledge of the scene.
[[nodiscard]] std::vector<aabb::composition> every_composition(const experiment& e);

/// `quick` applies the config's `quick` settings, which make a short trial run.
enum class experiment_size { full, quick };

/// Reads a config and validates it completely, which includes generating each scene once.
/// @throws aabb::input_error with file and line on malformed TOML (and column), an unknown key or name (with the
/// closest known one), a value of the wrong type, a rejected combination, or a mesh or recording that does not exist or
/// is malformed. A relative path is resolved from the working directory, then from the folder of the config.
[[nodiscard]] experiment read_experiment(const std::filesystem::path& file, experiment_size size);

[[nodiscard]] experiment parse_experiment(const std::string& text, const std::string& file, experiment_size size);

/// Makes a triangle test, a strategy or one from a library, from the name and settings in a config or an option.
/// @throws aabb::input_error on an unknown name, with the closest known one, and on settings that the test lacks.
[[nodiscard]] std::unique_ptr<aabb::triangle_test> triangle_test_named(const aabb::strategy_choice& choice);

/// Names of the tests that also construct the intersection of two triangles: strategies first, then library tests.
[[nodiscard]] std::vector<std::string> constructing_tests();

struct pair_set {
    std::string pair_class;
    bool in_double = false;
    std::uint64_t count = 0, seed = 1;
};

/// A method with its parameters swept, one point per combination of their values; one of the lists is empty.
struct error_curve {
    std::string label;
    std::vector<aabb::strategy_choice> triangles;  ///< tests that run on triangle pairs
    std::vector<aabb::composition> compositions;   ///< compositions that run whole scenes
    std::vector<aabb::named_strategies> named;     ///< what the config names of each composition
};

/// A plot of one metric of the compositions against another, by name.
struct metric_plot {
    std::string x, y;
};

/// A config of `errors`. It measures the errors of triangle tests against their time, on generated pairs and on mesh
/// triangles whose boxes overlap; or, with `scene_experiment`, it runs compositions on scenes and compares their
/// metrics.
struct error_study {
    std::string name;
    std::string text;  ///< the contents of the config
    std::vector<error_curve> curves;
    /// Classes of pairs; `count` hits of each are compared with CGAL's exact construction.
    std::vector<pair_set> hits;
    std::vector<std::string> notes;
    std::vector<pair_set> pairs;
    std::vector<scene_choice> scenes;            ///< mesh scenes
    std::optional<experiment> scene_experiment;  ///< runs the compositions of all curves
    std::vector<metric_plot> plots;
};

/// The curves and plots of a config of `errors`, for results of which only the config is known.
struct study_curves {
    std::vector<error_curve> curves;
    std::vector<metric_plot> plots;
};
/// Reads these alone: no scene is generated, and no mesh needed.
/// @throws aabb::input_error like `read_experiment`.
[[nodiscard]] study_curves read_curves(const std::filesystem::path& file);

/// @throws aabb::input_error like `read_experiment`.
[[nodiscard]] error_study read_error_study(const std::filesystem::path& file, experiment_size size);
[[nodiscard]] error_study parse_error_study(const std::string& text, const std::string& file, experiment_size size);

/// Reads `[[case]]`s of name, source, about, class, first, second, intersect and, if it differs, intersect_double.
/// @throws aabb::input_error with file and line on malformed TOML, an unknown or missing key, a duplicate name, a
/// malformed triangle, or a coordinate beyond the range of float.
[[nodiscard]] std::vector<aabb::triangle_case> read_triangle_cases(const std::filesystem::path& file);
[[nodiscard]] std::vector<aabb::triangle_case> parse_triangle_cases(const std::string& text, const std::string& file);

/// Costs that `calibrate` measured, with the program, processor and instruction set that they depend on.
struct calibrated_costs {
    std::string version;       ///< of the program that measured them
    std::string date;          ///< when they were measured, as "2026-01-31T12:00:00Z"
    std::string processor;     ///< its model name
    std::string instructions;  ///< the instruction set of the build, such as "AVX-512"
    aabb::cost_model costs;

    /// Whether the costs apply to `current`: same version, processor and instruction set.
    [[nodiscard]] bool applies_to(const calibrated_costs& current) const {
        return version == current.version && processor == current.processor && instructions == current.instructions;
    }
};

/// Labels the costs with this program, this machine and the current time.
[[nodiscard]] calibrated_costs label_costs(const aabb::cost_model& costs);
/// Formats the costs as a TOML file.
[[nodiscard]] std::string text_of(const calibrated_costs& costs);
/// Reads the costs, or only the header of a file of another version, whose costs may differ in name and meaning.
/// @throws aabb::input_error with file and line on malformed TOML, an unknown key, or a cost that is not positive.
[[nodiscard]] calibrated_costs read_costs(const std::filesystem::path& file);
[[nodiscard]] calibrated_costs parse_costs(const std::string& text, const std::string& file);

/// The path of the costs that `calibrate` stores: $XDG_CONFIG_HOME/aabblab/costs.toml, else
/// ~/.config/aabblab/costs.toml; empty if the environment names neither folder.
[[nodiscard]] std::filesystem::path calibrated_costs_file();
/// Replaces the shipped costs by calibrated ones in this process; those of another version or machine are ignored.
/// @throws aabb::input_error like `read_costs`.
void use_calibrated_costs();
/// Describes the costs in use: "costs as shipped", or "costs calibrated 2026-01-31T12:00:00Z (FILE)".
[[nodiscard]] std::string costs_in_force();

/// XXH3-64 of everything that determines the results: compositions, engines, measurements, scenes and the contents of
/// their meshes and files. The layout and comments of the config do not matter. 16 hexadecimal digits.
[[nodiscard]] std::string hash_of(const experiment& e);

}  // namespace aabblab
