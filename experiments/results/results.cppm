/// Results of an experiment in a folder: results.csv, manifest.json, differences.csv.
export module aabblab.results;

import aabb.counters;
import aabb.registry;
import aabb.std;
import aabblab.scenes;
export import :columns;

export namespace aabblab {

/// What played a scene, as it stands in the columns of every table: the choice of each kind, as the command line takes
/// it, and an engine. Empty where there is no such part.
struct contender_name {
    aabb::by_kind<std::string> choices;
    std::string engine;

    /// What `auto` has in place of an engine; what is named with it stands behind.
    static constexpr std::string_view automatic = "auto";
    [[nodiscard]] bool is_automatic() const { return engine == automatic || engine.starts_with("auto + "); }
    /// Whether any of it is of a system that is not ours.
    [[nodiscard]] bool is_reference() const { return !engine.empty() && !is_automatic(); }

    [[nodiscard]] std::string& operator[](aabb::strategy_kind kind) { return choices[kind]; }
    [[nodiscard]] const std::string& operator[](aabb::strategy_kind kind) const { return choices[kind]; }
    friend auto operator<=>(const contender_name&, const contender_name&) = default;
};

/// Parts of a stage that have a column; what an engine calls otherwise is under `engine`. `triangles` and `vertices`
/// are the scene's meshes, which every composition reads and none of them holds.
inline constexpr std::array<std::string_view, 12> byte_columns = {"projections", "sort",      "partition", "sweep",
                                                                  "prepare",     "nodes",     "indices",   "stack",
                                                                  "refit",       "triangles", "vertices",  "engine"};

/// One row: one scene played once from a fresh start. Metrics that were not asked for are empty.
struct row {
    std::string experiment;
    scene_choice scene;
    std::uint64_t objects = 0;
    std::uint64_t frames = 0;
    contender_name name;
    std::uint64_t repeat = 0;
    std::uint64_t process = 0;               ///< that timed it, from 0
    std::optional<std::uint64_t> triangles;  ///< of the scene's meshes, each counted once; empty in scenes of boxes
    std::optional<double> build_ms;          ///< making the stages, taking the objects, building the trees
    std::optional<double> first_ms;          ///< frame 0, whole
    std::optional<double> update_ms;         ///< sums over the frames after frame 0
    std::optional<double> search_ms;
    std::optional<double> detect_ms;
    std::optional<double> build_cpu_ms;  ///< the same of the thread's processor time
    std::optional<double> first_cpu_ms;
    std::optional<double> update_cpu_ms;
    std::optional<double> search_cpu_ms;
    std::optional<double> detect_cpu_ms;
    std::uint64_t candidates = 0;           ///< pairs of boxes, over all frames
    std::optional<std::uint64_t> contacts;  ///< pairs of triangles, over all frames; empty in scenes of boxes
    std::string digest;                     ///< of the contacts, or of the pairs in scenes of boxes
    /// Over the frames after frame 0; of frame 0 where there is no other.
    std::array<std::optional<std::uint64_t>, aabb::work_names.size()> counts;
    std::array<std::optional<std::uint64_t>, byte_columns.size()> bytes;
    std::optional<std::uint64_t> missing;   ///< pairs or contacts of the exact answer that are not there
    std::optional<std::uint64_t> invented;  ///< those that are there but not in the exact answer
    std::optional<double> box_inflation;    ///< area of the tree's boxes over that of the smallest ones, less 1
    std::string status;                     ///< "exact" or "inexact"

    /// Equal keys name the same measurement.
    [[nodiscard]] std::string key() const;
};

/// The settings of a scene, and its meshes, as a JSON object: what stands in the column `scene_parameters`.
[[nodiscard]] std::string parameters_json(const scene_choice& scene);

/// Rows of a results.csv. A last one that was cut off in the middle of being written is left out.
/// @param seen hears each row with the line that it begins in
/// @throws aabb::input_error with file and line where it is not a results.csv, or two rows are of the same measurement.
[[nodiscard]] std::vector<row> read_rows(const std::filesystem::path& file,
                                         const std::function<void(const row&, std::size_t)>& seen = {});

/// Rows of a folder of results, held against its manifest: the scenes are the manifest's, and an exact row has the
/// digest that the manifest has for its scene. Where the run was finished, so that the manifest has a seal, all rows
/// are there, none was altered, and they stand in the order of scenes, repeats and contenders, whatever the file's.
/// @throws aabb::input_error where that is not so, with file, and line where there is one.
[[nodiscard]] std::vector<row> verified_rows(const std::filesystem::path& folder);

/// A line of differences.csv: how many pairs of one class a contender missed or invented in a scene.
struct difference {
    scene_choice scene;
    contender_name name;
    std::string what;  ///< "missing" or "invented"
    std::string kind;  ///< a class of aabb::difference_class_names, or "boxes" for pairs of boxes
    std::uint64_t count = 0;
};
[[nodiscard]] std::vector<difference> read_differences(const std::filesystem::path& file);

/// Keeps others from writing results into a folder, which it makes, while it or a process started meanwhile lives.
class folder_lock {
public:
    /// @throws aabb::input_error where another process has it, or the folder cannot be made.
    explicit folder_lock(const std::filesystem::path& folder);
    folder_lock(const folder_lock&) = delete;
    folder_lock& operator=(const folder_lock&) = delete;
    ~folder_lock();

private:
    int descriptor_;
};

/// What is done with results that are there already: `replace` resumes those of the same config, build and machine and
/// sets others aside, as results.csv.old.
enum class existing_results { refuse, resume, replace };

struct experiment_record {
    std::string name;
    std::string file;  ///< the config, as the user named it
    std::string text;  ///< what stands in it
    std::string hash;  ///< of all that decides the results
    bool quick;
    std::vector<scene_choice> scenes;
    std::vector<std::string> notes;  ///< a sentence each
};

/// Of the exact answers.
using scene_digests = std::map<scene_choice, std::string>;

/// The folder of a running experiment, which holds its lock, or was started by a process that does. What is written
/// stays, whatever happens to the program afterwards.
class results_folder {
public:
    /// Creates the folder and its manifest, or takes up what is there.
    /// @throws aabb::input_error when results are there and are not to be resumed, or are of another config or build
    /// and not to be replaced, or when the folder cannot be written.
    results_folder(std::filesystem::path folder, experiment_record e, existing_results existing);
    results_folder(const results_folder&) = delete;
    results_folder& operator=(const results_folder&) = delete;
    ~results_folder();

    [[nodiscard]] const std::filesystem::path& path() const { return folder_; }
    /// Says which results were replaced and why; empty where none were.
    [[nodiscard]] const std::string& replaced() const { return replaced_; }
    [[nodiscard]] std::span<const row> rows() const { return rows_; }
    [[nodiscard]] bool has(const row& wanted) const;

    /// Appends a row and flushes it.
    void add(const row& finished);
    /// Deletes the rows of a contender in a scene.
    void drop(const scene_choice& scene, const contender_name& name);
    void drop(const scene_choice& scene, std::uint64_t repeat);
    /// Notes the exact digest of a scene in the manifest.
    void set_digest(const scene_choice& scene, const std::string& digest);
    /// Replaces the differences of these contenders in this scene.
    void set_differences(const scene_choice& scene, std::span<const contender_name> of,
                         std::span<const difference> found);
    /// Of an experiment that is finished: its manifest gets what later shows whether a row is missing or was altered.
    /// It loses that when the results are opened again.
    void seal();

private:
    void drop_where(const std::function<bool(const row&)>& dropped);
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

/// The manifest of a results folder, as far as reports show it.
struct manifest_summary {
    std::string date;
    std::string commit;  ///< with "(changed)" where files differed from it
    std::string compiler;
    std::string flags;
    std::string cpu;
    std::vector<std::string> notes;
    std::string config;  ///< what stands in it
    bool quick = false;
    bool finished = false;  ///< all was played
    std::string text;       ///< the manifest as the program wrote it, however it came here
};
/// @throws aabb::input_error where it is not a manifest.
[[nodiscard]] manifest_summary read_manifest(const std::filesystem::path& folder);

/// What made results of this program, as a manifest says it: times of different builds or machines must not meet.
[[nodiscard]] std::string build_description();

}  // namespace aabblab

// What the parts of the module share.
namespace aabblab {

/// The inverse of `parameters_json`.
/// @returns false where the text is not such an object
[[nodiscard]] bool set_parameters(scene_choice& scene, const std::string& json);

[[nodiscard]] std::string csv_header_of_rows();
[[nodiscard]] std::string csv_of(const row& r);
[[nodiscard]] std::string csv_of(std::span<const difference> differences);

/// What shows whether a table was altered, whatever the order of its rows and the ends of its lines.
struct table_seal {
    std::size_t rows;
    std::string checksum;  ///< SHA-256 of its sorted lines, that of the column names among them
    friend bool operator==(const table_seal&, const table_seal&) = default;
};
[[nodiscard]] table_seal seal_of(const std::filesystem::path& table);

struct results_seal {
    table_seal results;
    std::optional<table_seal> differences;
    std::vector<contender_name> contenders;  ///< in the order in which they were played
};

[[nodiscard]] std::string manifest_text(const experiment_record& e, const std::string& date,
                                        const scene_digests& digests, const std::optional<results_seal>& seal);

struct sealed_manifest {
    std::string experiment;
    std::vector<std::pair<scene_choice, std::string>> scenes;  ///< each with its exact digest, or an empty one
    std::optional<results_seal> seal;
};
/// @throws aabb::input_error where it is not a manifest, or was altered since it was sealed.
[[nodiscard]] sealed_manifest read_sealed_manifest(const std::filesystem::path& file);

/// Why results cannot be continued: they are of another config, build or machine. Empty where they can.
[[nodiscard]] std::string refusal_to_resume(const std::filesystem::path& manifest, const experiment_record& e);
/// The date and the digests of results that are continued.
/// @throws aabb::input_error where they cannot be.
[[nodiscard]] std::pair<std::string, scene_digests> resume_manifest(const std::filesystem::path& file,
                                                                    const experiment_record& e);

}  // namespace aabblab
