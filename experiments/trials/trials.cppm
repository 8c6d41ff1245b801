/// Runs of candidates on scenes: queries and observations, validation against the ground truth, interleaved rounds,
/// isolated child processes for runs that may exceed their time or memory, and result folders that can be resumed.
export module aabblab.trials;

import aabb.collision_filter;
import aabb.digest;
import aabb.pipeline;
import aabb.registry;
import aabb.selection;
import aabb.std;
import aabb.validation;
import aabblab.configs;
import aabblab.results;
import aabblab.scenes;
import aabblab.stopwatch;
export import :rounds;

export namespace aabblab {

// Scenes and candidates.

/// The times that an external engine reports for one frame.
struct reported_times {
    double update_ms = 0, search_ms = 0;
};

/// What an external engine read and wrote when it last ran on a scene. The files last as long as its candidate.
struct external_output {
    std::vector<reported_times> times;  ///< by frame
    std::filesystem::path recording, pairs;
    std::uint64_t faulty_rows = 0;  ///< with ids or frames that the scene does not have, or a pair that was there
    bool is_wrong = false;          ///< whether its pairs differed from the ground truth

    /// A sentence about faulty rows, without its beginning; empty if there are none.
    [[nodiscard]] std::string fault() const {
        if (faulty_rows == 0) return {};
        return std::to_string(faulty_rows) + (faulty_rows == 1
                                                  ? " row of its list cannot be a pair of the scene, or repeats one"
                                                  : " rows of its list cannot be pairs of the scene, or repeat one");
    }
};

/// An external engine exceeded its timeout and was killed; a type of its own, so that the other candidates still run.
class engine_timeout : public aabb::input_error {
public:
    using input_error::input_error;
};

/// A composition or a reference engine, with factories that create fresh stages for every run.
struct candidate {
    candidate_name name;
    std::function<std::unique_ptr<aabb::global_stage>(aabb::instrumentation)> make_global;
    std::function<std::unique_ptr<aabb::local_stage>(aabb::instrumentation)> make_local;  ///< empty for boxes
    /// The output of an external engine, once `make_global` has run it; null if the candidate is timed here.
    std::shared_ptr<external_output> reported;
    /// False where the broad phase sees parts of objects, whose pairs cannot be compared with pairs of whole objects.
    bool whole_boxes = true;
    bool exact_boxes = true;  ///< any false negative or positive among box pairs is a failure, not a measurement
    bool exact = true;        ///< the same for contacts
};

/// Iterates over the frames of a scene of boxes or of meshes.
class scene_frames {
public:
    /// @throws aabb::input_error if the scene cannot be created.
    explicit scene_frames(const scene_choice& choice);
    explicit scene_frames(std::unique_ptr<aabb::box_scene> scene) : box_scene_(std::move(scene)) {}
    /// @param file the source of its poses, for messages; empty if they are generated
    explicit scene_frames(std::unique_ptr<aabb::mesh_scene> scene, std::string file = {})
        : meshes_(std::move(scene)), poses_file_(std::move(file)) {}

    /// Leaves out pairs from now on: stages that are made for this scene find only those that the filter keeps.
    /// @param filter null for none
    void filter_by(std::shared_ptr<const aabb::collision_filter> filter) { filter_ = std::move(filter); }
    /// Null if no pair is left out.
    [[nodiscard]] const aabb::collision_filter* filter() const { return filter_.get(); }

    [[nodiscard]] std::size_t objects() const { return meshes_ ? meshes_->mesh_of.size() : box_scene_->objects(); }
    [[nodiscard]] std::size_t frames() const { return meshes_ ? meshes_->frames() : box_scene_->frames(); }
    /// Advances to the next frame; false after the last.
    bool next();
    /// Passes the sorted results of this frame to the scene, which may react to them; contacts exist only for meshes.
    void take_results(std::span<const aabb::index_pair> pairs, std::span<const aabb::contact> contacts);
    /// Must be called by the handler of an error in this frame: if its poses come from a file, adds file and frame.
    [[noreturn]] void rethrow(const aabb::input_error& error) const;
    /// Computes the boxes of a frame of meshes; throws aabb::input_error on an invalid pose, with its file and frame.
    void place(aabb::posed_boxes& boxes) const;
    /// Null for a scene of boxes.
    [[nodiscard]] const aabb::mesh_scene* meshes() const { return meshes_.get(); }
    [[nodiscard]] std::span<const aabb::box> boxes() const { return boxes_; }
    /// The same in double; empty if the boxes are floats.
    [[nodiscard]] std::span<const aabb::boxd> boxes_in_double() const {
        return box_scene_ ? box_scene_->in_double() : std::span<const aabb::boxd>{};
    }
    [[nodiscard]] std::span<const aabb::pose> poses() const { return poses_; }
    /// Objects of a scene of boxes that appear in this frame, and objects that disappear in it.
    [[nodiscard]] std::span<const std::uint32_t> arrivals() const { return arrivals_; }
    [[nodiscard]] std::span<const std::uint32_t> departures() const { return departures_; }
    /// From now on compares boxes with those of the previous frame.
    void compare_boxes() { compares_ = true; }
    /// The ids of those that differ; nullopt if boxes are not compared.
    [[nodiscard]] std::optional<std::span<const std::uint32_t>> moved() const {
        return compares_ ? std::optional<std::span<const std::uint32_t>>(moved_) : std::nullopt;
    }

private:
    void note_changes(std::span<const std::uint8_t> present);
    void note_motion();

    std::unique_ptr<aabb::box_scene> box_scene_;
    std::unique_ptr<aabb::mesh_scene> meshes_;
    std::shared_ptr<const aabb::collision_filter> filter_;
    std::string poses_file_;      // empty if poses are generated
    std::size_t frames_run_ = 0;  // including the current one
    std::vector<aabb::box> boxes_;
    std::vector<aabb::pose> poses_;
    std::vector<std::uint8_t> present_;  // by object
    std::vector<std::uint32_t> arrivals_, departures_;
    bool compares_ = false;
    std::vector<aabb::box> previous_;
    std::vector<std::uint32_t> moved_;
};

struct stages {
    std::unique_ptr<aabb::global_stage> global;  ///< null for meshes if every two objects are candidates
    std::unique_ptr<aabb::local_stage> local;    ///< null in a scene of boxes
};

/// A candidate on a scene: its stages, with their trees built. The scene must outlive it.
class stage_runner {
public:
    stage_runner(const candidate& tested, const scene_frames& scene, aabb::instrumentation counted);
    stage_runner(stages given, const scene_frames& scene, aabb::instrumentation counted = aabb::instrumentation::none);

    /// Execute the phases of a frame, which are timed separately: update of the stages, broad phase, narrow phase.
    /// @throws aabb::input_error with file and frame if poses from a file are rejected.
    void update();
    void search();
    void detect();

    /// The share of the last search that belongs to the update (`aabb::global_stage`).
    [[nodiscard]] double share_of_update() const { return stages_.global ? stages_.global->share_of_update() : 0; }

    /// Alternatives to `detect` for meshes: any one contact of the frame, and the number of contacts.
    [[nodiscard]] std::optional<aabb::contact> first_contact() { return pipeline_->first_contact(); }
    [[nodiscard]] std::uint64_t count_contacts() { return pipeline_->count_contacts(); }
    /// Passes the pairs a < b of intersecting triangles of one undivided mesh with itself to `take`, in no particular
    /// order, until it returns true.
    void each_self_pair(std::uint32_t mesh, const std::function<bool(aabb::index_pair)>& take) {
        stages_.local->each_self_pair(mesh, take);
    }

    /// The boxes of the frame, by object, or by piece if meshes are divided; empty without a broad phase.
    [[nodiscard]] std::span<const aabb::box> boxes() const { return pipeline_ ? pipeline_->boxes() : scene_.boxes(); }
    /// The sorted results of the frame; duplicates are kept.
    [[nodiscard]] const std::vector<aabb::index_pair>& sorted_pairs();
    [[nodiscard]] const std::vector<aabb::contact>& sorted_contacts();

    /// Summed over all frames so far.
    [[nodiscard]] aabb::work_counters counters() const;
    [[nodiscard]] std::vector<aabb::part_bytes> global_bytes() const;
    [[nodiscard]] std::vector<aabb::part_bytes> local_bytes() const;
    [[nodiscard]] std::size_t buffer_bytes() const { return pipeline_ ? pipeline_->bytes() : aabb::bytes_of(pairs_); }
    /// The bytes of all parts except the meshes, which every composition reads.
    [[nodiscard]] std::size_t held_bytes() const;
    /// The plans that the broad phase derived from earlier frames.
    [[nodiscard]] std::vector<aabb::stage_plan> plans() const {
        return stages_.global ? stages_.global->plans() : std::vector<aabb::stage_plan>{};
    }
    [[nodiscard]] std::vector<aabb::omission> left_out() const {
        return left_out_by(stages_.global.get(), stages_.local.get());
    }
    /// How much larger the boxes of the trees are than tight ones, in area: the mean over the models; empty without
    /// trees.
    [[nodiscard]] std::optional<double> box_inflation() const;

private:
    const scene_frames& scene_;
    stages stages_;
    std::optional<aabb::pipeline> pipeline_;  // of meshes
    std::vector<aabb::index_pair> pairs_;
    std::vector<aabb::contact> contacts_;
};

/// Times of the phases of one frame, or their sums over several frames.
struct phases {
    elapsed update, search;
    elapsed detect;  ///< the configured query

    phases& operator+=(const phases& other) {
        update += other.update;
        search += other.search;
        detect += other.detect;
        return *this;
    }
    [[nodiscard]] double wall_ms() const { return update.wall_ms + search.wall_ms + detect.wall_ms; }
    [[nodiscard]] double cpu_ms() const { return update.cpu_ms + search.cpu_ms + detect.cpu_ms; }
};

struct searched_frame {
    std::uint32_t number;
    phases took;
    std::span<const aabb::index_pair> pairs;  ///< sorted pairs of boxes; duplicates are kept
    std::span<const aabb::contact> contacts;  ///< likewise; empty for a scene of boxes

    [[nodiscard]] double ms() const { return took.wall_ms(); }
};

/// Detects the contacts of a frame and returns the time of the configured query, which may be another one.
using timed_detection = std::function<elapsed(stage_runner&)>;
[[nodiscard]] elapsed time_detection(stage_runner& runner);

/// Runs the remaining frames of a scene, at most `most_frames`. `on_frame` receives each before the scene reacts to it.
void run_frames(scene_frames& scene, stage_runner& runner, const std::function<void(const searched_frame&)>& on_frame,
                std::size_t most_frames = std::numeric_limits<std::size_t>::max(),
                const timed_detection& detect = time_detection);

/// Accumulates the number and the digest of results, frame by frame.
class tally {
public:
    /// @param meshes whether the digest covers contacts instead of pairs of boxes
    explicit tally(bool meshes) : meshes_(meshes) {}

    /// Adds the sorted results of a frame; contacts are empty for a scene of boxes.
    void add(std::span<const aabb::index_pair> pairs, std::span<const aabb::contact> contacts);

    [[nodiscard]] std::uint64_t candidates() const { return candidates_; }
    [[nodiscard]] std::optional<std::uint64_t> contacts() const {
        return meshes_ ? std::optional(contacts_) : std::nullopt;
    }
    [[nodiscard]] std::string digest() const { return digest_.text(); }

private:
    bool meshes_;
    std::uint32_t frame_ = 0;
    std::uint64_t candidates_ = 0, contacts_ = 0;
    aabb::digest digest_;
};

// A single run of a candidate.

/// One run of a scene, or of its first frames, with fresh stages.
struct observation {
    elapsed build;  ///< creating the stages, inserting the objects, building the trees
    phases first;   ///< frame 0
    phases rest;    ///< all further frames
    std::size_t frames = 0;
    std::string digest;
    std::vector<std::string> digests;      ///< cumulative, by frame; only of runs in a child process
    std::string wrong;                     ///< how the query contradicts the detected contacts; empty if it agrees
    std::uint64_t bytes = 0;               ///< held after the last frame
    aabb::work_counters work;              ///< summed over all frames
    std::vector<aabb::omission> left_out;  ///< by the stages, after the last frame

    [[nodiscard]] double whole_ms() const { return build.wall_ms + first.wall_ms() + rest.wall_ms(); }
    /// The mean over the frames after frame 0.
    [[nodiscard]] double steady_ms() const { return frames > 1 ? rest.wall_ms() / static_cast<double>(frames - 1) : 0; }
    /// Likewise, or the time of frame 0 if it is the only one.
    [[nodiscard]] double frame_ms() const { return frames > 1 ? steady_ms() : first.wall_ms(); }
    /// Extrapolates to `all_frames` frames at the steady rate.
    [[nodiscard]] double over(double all_frames) const {
        return build.wall_ms + first.wall_ms() + (all_frames > 1 ? (all_frames - 1) * steady_ms() : 0);
    }
};

/// Explain the columns of these times below a table.
inline constexpr const char* build_ms_text =
    "build ms: the time to create the stages and build the trees of all meshes, before frame 0.";
inline constexpr const char* ms_per_frame_text =
    "ms/frame: the mean time per frame after frame 0, in update, search and detection; of frame 0 if it is "
    "the only one.";

/// What to run and to record in an observation.
struct protocol {
    query_settings query = {};
    std::size_t frames = std::numeric_limits<std::size_t>::max();  ///< at most
    aabb::instrumentation counted = aabb::instrumentation::none;
    std::function<void(const observation&)> on_frame = nullptr;  ///< receives the observation so far after each frame
};

/// Runs a scene from its first frame; the scene reacts to the results. External engines report their own wall times.
[[nodiscard]] observation observe(scene_frames& scene, const candidate& tested, const protocol& settings = {});
[[nodiscard]] observation observe(const scene_choice& scene, const candidate& tested, const protocol& settings = {});

// Runs in child processes, since they may exceed their time or memory.

enum class ending : std::uint8_t {
    done,
    stopped,        ///< at its time limit
    out_of_memory,  ///< or killed from outside, as the kernel does if memory runs out
    rejected,       ///< with an aabb::input_error
    failed
};

struct child_result {
    ending end = ending::stopped;
    std::string reported;  ///< the output up to that end
    std::string reason;    ///< the message of the input_error
    double seconds = 0;    ///< of wall time
};

/// Sends output of the work to the parent at once, so that it survives work that does not finish.
using output_sender = std::function<void(std::string_view)>;

/// Does the work in a forked child process, which is killed at its time limit, and first if memory runs out.
/// @param seconds the limit; nothing is started unless it is positive
[[nodiscard]] child_result run_in_child(const std::function<void(const output_sender&)>& work, double seconds);

/// A run in a child process.
struct attempt {
    ending end = ending::stopped;
    observation seen;              ///< of the frames that it finished
    std::string reason;            ///< the message of the input_error
    double seconds = 0;            ///< in total, including reading and sorting the results
    double seconds_of_frames = 0;  ///< up to the end of the last finished frame
    bool is_out_of_time = false;   ///< the overall time was over: the candidate is not necessarily slow
};

/// "stopped after 2.1 s, in frame 3", "not run: no time was left"
[[nodiscard]] std::string text_of(const attempt& run);

/// A scene that is read once and then run in child processes; each starts at its first frame.
class staged_scene {
public:
    /// @throws aabb::input_error if the scene cannot be created.
    explicit staged_scene(const scene_choice& choice) : choice_(choice), scene_(choice) {}

    [[nodiscard]] const scene_choice& choice() const { return choice_; }
    [[nodiscard]] const scene_frames& scene() const { return scene_; }
    /// Runs the first frames, for at most `seconds`.
    /// @param remaining seconds for all runs together
    [[nodiscard]] attempt run(const candidate& tested, std::size_t frames, double seconds,
                              double remaining = std::numeric_limits<double>::infinity());
    /// Does other work on the scene, from its first frame.
    [[nodiscard]] child_result in_child(const std::function<void(scene_frames&, const output_sender&)>& work,
                                        double seconds);

private:
    scene_choice choice_;
    scene_frames scene_;
};

/// The results of interleaved runs; the lists are indexed by candidate.
struct interleaved_runs {
    std::size_t frames = 0;  ///< per run; fewer than the scene has if time was short
    std::size_t rounds = 0;
    std::vector<std::vector<observation>> times;     ///< of finished runs, by round
    std::vector<std::optional<attempt>> broken_off;  ///< the first run, if it did not finish
    std::vector<bool> hopeless;                      ///< slower than the baseline by `hopeless_ratio`
};

/// Runs all candidates on the first frames in interleaved rounds, until time is over. A candidate that is hopelessly
/// slower than the first, the baseline, stops after one round. If the baseline finishes no frame, no other runs.
[[nodiscard]] interleaved_runs run_interleaved(staged_scene& scene, std::span<const candidate> candidates,
                                               std::size_t frames, std::size_t rounds, const time_limits& limits);

/// The indices of the candidates whose pairs differ from those of the first one, the baseline.
[[nodiscard]] std::vector<std::size_t> disagreeing(std::span<const std::vector<observation>> times);

/// Times per frame, by round.
[[nodiscard]] std::vector<double> frame_ms_of(std::span<const observation> times);

// Candidates of an experiment, and whole scenes.

/// "insertion + none + one_axis + canonical + exact", "cgal".
[[nodiscard]] std::string text_of(const candidate_name& name);

[[nodiscard]] candidate candidate_of(const aabb::composition& c, bool meshes);
/// A candidate `auto`: every run keeps the named strategies and selects the others anew for the scene.
[[nodiscard]] candidate candidate_of(const aabb::named_strategies& named, const scene_frames& scene);
/// What `auto` may know of a scene before its first frame.
[[nodiscard]] aabb::scene_traits traits_of(const scene_frames& scene);
/// Combines an engine of one stage with the default composition of the other; empty if it cannot run the scene.
[[nodiscard]] std::optional<candidate> candidate_of(const aabb::engine_info& engine, bool meshes);

/// The candidates of a scene in the order of all tables: compositions, each `auto`, engines, and external ones of
/// boxes.
[[nodiscard]] std::vector<candidate> candidates_for(const experiment& e, const scene_choice& scene);

/// The untimed result of a candidate compared with the ground truth: a row with everything that a run may record.
struct validated_row : row {
    std::string failure;                  ///< the first difference of a candidate that must be exact, or its timeout
    std::vector<difference> differences;  ///< by class
};

struct scene_validation {
    std::uint64_t objects = 0, frames = 0;
    std::string exact_by;  ///< the source of the ground truth
    std::string digest;    ///< of the ground truth
    std::vector<validated_row> candidates;
};

/// Runs all candidates in lockstep with the ground truth, to which the scene reacts, compares results and counts work.
[[nodiscard]] scene_validation validate_scene(const scene_choice& scene, std::span<const candidate> candidates);
/// Validates a scene that exists already and is at its first frame.
/// @param choice its description, for messages
[[nodiscard]] scene_validation validate_scene(const scene_choice& choice, scene_frames& scene,
                                              std::span<const candidate> candidates);

/// The part of the experiment that is stored with its results.
[[nodiscard]] experiment_record record_of(const experiment& e);

/// Validates a scene, then times the repeats of one of the experiment's processes, interleaved over the candidates, and
/// adds a row for each. Rows that the folder already has are not run again. Later processes reuse the validation of the
/// first one, and compare the digest of every repeat with it.
/// @param process from 0; each takes an equal share of the repeats, in order
/// @returns a sentence for each candidate that is wrong; it gets no row.
[[nodiscard]] std::vector<std::string> run_scene(const experiment& e, const scene_choice& scene,
                                                 std::span<const candidate> candidates, results_folder& results,
                                                 std::size_t process = 0);

}  // namespace aabblab
