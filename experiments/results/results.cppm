/// Reads and writes the results folder of an experiment: results.csv, manifest.json, differences.csv.
export module aabblab.results;

import aabb.counters;
import aabb.policy;
import aabb.registry;
import aabb.std;
import aabblab.scenes;
export import :columns;

export namespace aabblab {

/// The name of a composition or an engine in the columns of every table: the choice of each kind, in the syntax of the
/// command line, or the engine. Parts that do not apply are empty.
struct candidate_name {
    aabb::by_kind<std::string> choices;
    std::string engine;

    /// The engine name of `auto`; strategies that are fixed by name follow it.
    static constexpr std::string_view automatic = "auto";
    [[nodiscard]] bool is_automatic() const { return engine == automatic || engine.starts_with("auto + "); }
    /// True for an engine of another library.
    [[nodiscard]] bool is_reference() const { return !engine.empty() && !is_automatic(); }

    [[nodiscard]] std::string& operator[](aabb::strategy_kind kind) { return choices[kind]; }
    [[nodiscard]] const std::string& operator[](aabb::strategy_kind kind) const { return choices[kind]; }
    friend auto operator<=>(const candidate_name&, const candidate_name&) = default;
};

/// The strategies of a row joined by " + ", without `none` of the kind prepare and `median` of build, which most
/// compositions share. What is left out is fixed: labels of old results must not change with the program's defaults.
[[nodiscard]] inline std::string label_of(const aabb::by_kind<std::string>& choices,
                                          std::span<const aabb::strategy_kind> kinds = aabb::strategy_kinds) {
    std::string label;
    for (const aabb::strategy_kind kind : kinds) {
        const bool is_left_out = (kind == aabb::strategy_kind::prepare && choices[kind] == "none") ||
                                 (kind == aabb::strategy_kind::build && choices[kind] == "median");
        if (!is_left_out && !choices[kind].empty()) label += (label.empty() ? "" : " + ") + choices[kind];
    }
    return label;
}

/// The parts of a stage that have a column of bytes; other parts of an engine count as `engine`. `triangles` and
/// `vertices` belong to the scene's meshes, which compositions share and do not own.
inline constexpr std::array<std::string_view, 12> byte_columns = {"projections", "sort",      "partition", "sweep",
                                                                  "prepare",     "nodes",     "indices",   "stack",
                                                                  "refit",       "triangles", "vertices",  "engine"};

/// One row: one run of a scene, starting from scratch. Metrics that the config does not record are empty.
struct row {
    std::string experiment;
    scene_choice scene;
    std::uint64_t objects = 0;
    std::uint64_t frames = 0;
    candidate_name name;
    std::uint64_t repeat = 0;
    std::uint64_t process = 0;               ///< the process that timed it, from 0
    std::optional<std::uint64_t> triangles;  ///< of the scene's meshes, each counted once; empty in scenes of boxes
    std::optional<double> build_ms;          ///< constructs the stages, inserts the objects, builds the trees
    std::optional<double> first_ms;          ///< frame 0, all stages
    std::optional<double> update_ms;         ///< sums over the frames after frame 0
    std::optional<double> search_ms;
    std::optional<double> detect_ms;
    std::optional<double> build_cpu_ms;  ///< the same in processor time of the thread
    std::optional<double> first_cpu_ms;
    std::optional<double> update_cpu_ms;
    std::optional<double> search_cpu_ms;
    std::optional<double> detect_cpu_ms;
    std::uint64_t candidates = 0;           ///< pairs of boxes, over all frames
    std::optional<std::uint64_t> contacts;  ///< pairs of triangles, over all frames; empty in scenes of boxes
    std::string digest;                     ///< hash of the contacts, or of the pairs in scenes of boxes
    /// Sums over the frames after frame 0, or of frame 0 if it is the only one.
    std::array<std::optional<std::uint64_t>, aabb::work_names.size()> counts;
    std::array<std::optional<std::uint64_t>, byte_columns.size()> bytes;
    std::optional<std::uint64_t> false_negatives;  ///< of contacts, or of pairs in scenes of boxes
    std::optional<std::uint64_t> false_positives;
    std::optional<double> box_inflation;  ///< surface area of a tree's boxes over that of tight boxes, less 1
    std::string status;                   ///< "exact" or "inexact"

    /// Equal keys identify the same measurement.
    [[nodiscard]] std::string key() const;
};

/// The settings and meshes of a scene as a JSON object, for the column `scene_parameters`.
[[nodiscard]] std::string parameters_json(const scene_choice& scene);

/// Reads a results.csv, except a last row that was only partly written when the program ended.
/// @param on_row is called with each row and the line at which it begins
/// @throws aabb::input_error with file and line if it is not a results.csv, or if two rows have the same key.
[[nodiscard]] std::vector<row> read_rows(const std::filesystem::path& file,
                                         const std::function<void(const row&, std::size_t)>& on_row = {});

/// Reads the rows of a results folder and verifies them against its manifest: every scene is listed, and exact rows
/// have the digest of their scene. If the run was finished, so that the manifest has a seal, the rows must be complete
/// and unaltered; they are then sorted by scene, repeat and candidate, whatever their order in the file.
/// @throws aabb::input_error if the verification fails, with the file, and the line if there is one.
[[nodiscard]] std::vector<row> verified_rows(const std::filesystem::path& folder);

/// A line of differences.csv: the number of false negatives or false positives of one class and candidate in a scene.
struct difference {
    scene_choice scene;
    candidate_name name;
    std::string what;  ///< a false negative or a false positive, as named in the file
    std::string kind;  ///< a class of aabb::difference_class_names, or "boxes" for pairs of boxes
    std::uint64_t count = 0;
};
[[nodiscard]] std::vector<difference> read_differences(const std::filesystem::path& file);

/// Locks a results folder, which it creates, until it and all processes started meanwhile have ended.
class folder_lock {
public:
    /// @throws aabb::input_error if another process holds the lock, or the folder cannot be created.
    explicit folder_lock(const std::filesystem::path& folder);
    folder_lock(const folder_lock&) = delete;
    folder_lock& operator=(const folder_lock&) = delete;
    ~folder_lock();

private:
    int descriptor_;
};

/// The treatment of existing results: `replace` resumes them if config, build and machine are the same, and otherwise
/// renames them to results.csv.old.
enum class existing_results { reject, resume, replace };

struct experiment_record {
    std::string name;
    std::string file;  ///< the path of the config, as given by the user
    std::string text;  ///< the content of the config
    std::string hash;  ///< the hash of all inputs of the results
    bool quick;
    std::vector<scene_choice> scenes;
    std::vector<std::string> notes;  ///< a sentence each
};

/// The digest of the ground truth, by scene.
using scene_digests = std::map<scene_choice, std::string>;

/// The folder of a running experiment; this process, or the one that started it, must hold the lock. Written rows
/// survive a crash of the program.
class results_folder {
public:
    /// Creates the folder and its manifest, or resumes existing results.
    /// @throws aabb::input_error if there are results and `existing` does not permit to resume or replace them, if they
    /// are of another config or build and must not be replaced, or if the folder cannot be written.
    results_folder(std::filesystem::path folder, experiment_record e, existing_results existing);
    results_folder(const results_folder&) = delete;
    results_folder& operator=(const results_folder&) = delete;
    ~results_folder();

    [[nodiscard]] const std::filesystem::path& path() const { return folder_; }
    /// The reason why results were replaced; empty if none were.
    [[nodiscard]] const std::string& replaced() const { return replaced_; }
    [[nodiscard]] std::span<const row> rows() const { return rows_; }
    [[nodiscard]] bool has(const row& wanted) const { return keys_.contains(wanted.key()); }

    /// Appends a row and flushes the file.
    void add(const row& finished);
    /// Deletes the rows that match, and rewrites the file.
    void drop(const std::function<bool(const row&)>& is_dropped);
    /// Records the digest of the ground truth of a scene in the manifest.
    void set_digest(const scene_choice& scene, const std::string& digest);
    /// Replaces the differences of these candidates in this scene.
    void set_differences(const scene_choice& scene, std::span<const candidate_name> names,
                         std::span<const difference> differences);
    /// Seals a finished experiment: adds checksums to the manifest, by which missing or altered rows are detected
    /// later. Opening the results again removes the seal.
    void seal();

private:
    void open_table();
    void write_manifest() const;
    [[noreturn]] void fail_table() const;

    std::filesystem::path folder_;
    experiment_record experiment_;
    std::string date_;
    std::string replaced_;
    std::vector<row> rows_;
    std::set<std::string> keys_;  // of the rows
    std::vector<difference> differences_;
    scene_digests digests_;
    std::FILE* file_ = nullptr;
};

/// The parts of a manifest that reports show.
struct manifest_summary {
    std::string date;
    std::string commit;  ///< with "(changed)" if files differed from it
    std::string compiler;
    std::string flags;
    std::string cpu;
    std::vector<std::string> notes;
    std::string config;  ///< its content
    bool quick = false;
    bool finished = false;  ///< all scenes were run
    std::string text;       ///< the whole manifest, formatted as the program writes it
};
/// @throws aabb::input_error if it is not a manifest.
[[nodiscard]] manifest_summary read_manifest(const std::filesystem::path& folder);

/// The defaults of the parameters of a kind of scene with which a finished run completed its config.
struct scene_defaults {
    std::string kind;
    std::vector<aabb::setting> parameters;
};
/// Those of all its kinds of scenes; empty in results of earlier versions.
[[nodiscard]] std::vector<scene_defaults> read_scene_defaults(const std::filesystem::path& folder);

/// The build and machine in the format of a manifest: times of different ones must not be mixed.
[[nodiscard]] std::string build_description();

}  // namespace aabblab

// Shared by the units of the module; comments are at the definitions.
namespace aabblab {

[[nodiscard]] bool set_parameters(scene_choice& scene, const std::string& text);
[[nodiscard]] std::string csv_header_of_rows();
[[nodiscard]] std::string csv_of(const row& r);
[[nodiscard]] std::string csv_of(std::span<const difference> differences);

/// Detects alterations of a table, except of the order of its rows and of its line endings.
struct table_seal {
    std::size_t rows;
    std::string checksum;  ///< SHA-256 of its sorted lines, including the header
    friend bool operator==(const table_seal&, const table_seal&) = default;
};
[[nodiscard]] table_seal seal_of(const std::filesystem::path& table);

struct results_seal {
    table_seal results;
    std::optional<table_seal> differences;
    std::vector<candidate_name> candidates;  ///< in the order in which they were run
};

[[nodiscard]] std::string manifest_text(const experiment_record& e, const std::string& date,
                                        const scene_digests& digests, const std::optional<results_seal>& seal);

struct sealed_manifest {
    std::string experiment;
    std::vector<std::pair<scene_choice, std::string>> scenes;  ///< with their digests, which may be empty
    std::optional<results_seal> seal;
};
[[nodiscard]] sealed_manifest read_sealed_manifest(const std::filesystem::path& file);

[[nodiscard]] std::string rejection_to_resume(const std::filesystem::path& manifest, const experiment_record& e);
[[nodiscard]] std::pair<std::string, scene_digests> resume_manifest(const std::filesystem::path& file,
                                                                    const experiment_record& e);

}  // namespace aabblab
