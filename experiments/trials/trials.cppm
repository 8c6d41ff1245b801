/// Everything that is tried: who plays which scene, what is asked and what is seen of that; exact or not, in turn, in a
/// copy of this process where it may take too long, and into a folder that can be resumed.
export module aabblab.trials;

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

// Scenes and those who play them.

/// What an external engine says that it took for a frame.
struct told_times {
    double update_ms = 0;
    double search_ms = 0;
};

/// An external engine that took longer than it may, and was killed: nobody else is to suffer for that.
class engine_timeout : public aabb::input_error {
public:
    using input_error::input_error;
};

/// A composition of ours or a reference system, ready to be made anew for each time it plays.
struct contender {
    contender_name name;
    std::function<std::unique_ptr<aabb::global_stage>(aabb::instrumentation)> make_global;
    std::function<std::unique_ptr<aabb::local_stage>(aabb::instrumentation)> make_local;  ///< empty for boxes
    /// The times of an external engine, by frame, once `make_global` has run it; null for all others, which are timed.
    std::shared_ptr<const std::vector<told_times>> told;
    bool whole_boxes =
        true;  ///< false where global search sees parts of objects: its pairs are not held against theirs
    bool exact_boxes = true;  ///< a difference from the exact pairs of boxes is a failure, not a measurement
    bool exact = true;        ///< the same of contacts
};

/// A scene from its first frame to its last, of boxes or of meshes.
class scene_play {
public:
    /// @throws aabb::input_error where the scene cannot be made.
    explicit scene_play(const scene_choice& choice);
    explicit scene_play(std::unique_ptr<aabb::box_scene> scene) : box_scene_(std::move(scene)) {}
    /// @param file that its poses stand in, for messages; empty where they do not
    explicit scene_play(std::unique_ptr<aabb::mesh_scene> scene, std::string file = {})
        : meshes_(std::move(scene)), file_(std::move(file)) {}

    [[nodiscard]] std::size_t objects() const { return meshes_ ? meshes_->mesh_of.size() : box_scene_->objects(); }
    [[nodiscard]] std::size_t frames() const { return meshes_ ? meshes_->frames() : box_scene_->frames(); }
    /// Goes to the next frame; false after the last.
    bool next();
    /// Tells the scene what was found in this frame, both sorted, before it goes to the next; contacts are of meshes.
    void tell(std::span<const aabb::index_pair> pairs, std::span<const aabb::contact> contacts);
    /// Does something with this frame. What is wrong with poses is found by whoever takes them: where they stand in a
    /// file, the sentence begins with file and frame.
    template <class Work>
    void in_frame(Work work) const {
        try {
            work();
        } catch (const aabb::input_error& error) {
            if (file_.empty()) throw;
            throw aabb::input_error(file_ + ": frame " + std::to_string(played_ - 1) + ": " + error.what());
        }
    }
    /// Null in a scene of boxes.
    [[nodiscard]] const aabb::mesh_scene* meshes() const { return meshes_.get(); }
    [[nodiscard]] std::span<const aabb::box> boxes() const { return boxes_; }
    [[nodiscard]] std::span<const aabb::pose> poses() const { return poses_; }
    /// Objects of a scene of boxes that are in this frame and were not in the one before, and the other way round.
    [[nodiscard]] std::span<const std::uint32_t> arrivals() const { return arrivals_; }
    [[nodiscard]] std::span<const std::uint32_t> departures() const { return departures_; }

private:
    void note_changes(std::span<const std::uint8_t> present);

    std::unique_ptr<aabb::box_scene> box_scene_;
    std::unique_ptr<aabb::mesh_scene> meshes_;
    std::string file_;        // of poses
    std::size_t played_ = 0;  // frames
    std::vector<aabb::box> boxes_;
    std::vector<aabb::pose> poses_;
    std::vector<std::uint8_t> present_;  // by object
    std::vector<std::uint32_t> arrivals_;
    std::vector<std::uint32_t> departures_;
};

/// What plays a scene, once.
struct stages {
    std::unique_ptr<aabb::global_stage> global;  ///< null in a scene of meshes: every two objects are candidates
    std::unique_ptr<aabb::local_stage> local;    ///< null in a scene of boxes
};

/// A contender in a scene: its stages, with the trees built. The scene must outlive it.
class player {
public:
    player(const contender& who, const scene_play& scene, aabb::instrumentation counted);
    player(stages made, const scene_play& scene);

    /// One frame, in steps that can be timed apart.
    /// @throws aabb::input_error with file and frame where poses that stand in a file are refused.
    void update();
    void search();
    void detect();

    /// Of the time of the last search, what went into work of an update (`aabb::global_stage`).
    [[nodiscard]] double share_of_update() const { return made_.global ? made_.global->share_of_update() : 0; }

    /// In place of `detect`, in scenes of meshes: any one contact of the frame, how many there are.
    [[nodiscard]] std::optional<aabb::contact> first_contact() { return pipeline_->first_contact(); }
    [[nodiscard]] std::uint64_t count_contacts() { return pipeline_->count_contacts(); }
    /// Hands over the pairs of intersecting triangles a < b of one mesh of the scene, which is not divided, with
    /// itself, in no particular order.
    void each_self_pair(std::uint32_t mesh, const std::function<void(aabb::index_pair)>& take) {
        made_.local->each_self_pair(mesh, take);
    }

    /// Of the frame, by object; by piece where meshes are divided; empty without global search.
    [[nodiscard]] std::span<const aabb::box> boxes() const { return pipeline_ ? pipeline_->boxes() : scene_.boxes(); }
    /// Of the frame, sorted; duplicates stay.
    [[nodiscard]] const std::vector<aabb::index_pair>& sorted_pairs();
    [[nodiscard]] const std::vector<aabb::contact>& sorted_contacts();

    /// Over all frames so far.
    [[nodiscard]] aabb::work_counters counters() const;
    [[nodiscard]] std::vector<aabb::part_bytes> global_bytes() const;
    [[nodiscard]] std::vector<aabb::part_bytes> local_bytes() const;
    [[nodiscard]] std::size_t buffer_bytes() const { return pipeline_ ? pipeline_->bytes() : aabb::bytes_of(pairs_); }
    /// Of all parts but the meshes, which every composition reads.
    [[nodiscard]] std::size_t held_bytes() const;
    /// What the global search planned from what it saw.
    [[nodiscard]] std::vector<aabb::stage_plan> plans() const {
        return made_.global ? made_.global->plans() : std::vector<aabb::stage_plan>{};
    }
    [[nodiscard]] std::vector<aabb::omission> left_out() const {
        return left_out_by(made_.global.get(), made_.local.get());
    }
    /// The mean over the models of the tree's; empty where there is no tree to be seen.
    [[nodiscard]] std::optional<double> box_inflation() const;

private:
    const scene_play& scene_;
    stages made_;
    std::optional<aabb::pipeline> pipeline_;  // of meshes
    std::vector<aabb::index_pair> pairs_;
    std::vector<aabb::contact> contacts_;
};

/// What the phases of a frame took, or of several.
struct phases {
    elapsed update;
    elapsed search;
    elapsed detect;  ///< the query that is asked

    phases& operator+=(const phases& other) {
        update += other.update;
        search += other.search;
        detect += other.detect;
        return *this;
    }
    [[nodiscard]] double wall_ms() const { return update.wall_ms + search.wall_ms + detect.wall_ms; }
    [[nodiscard]] double cpu_ms() const { return update.cpu_ms + search.cpu_ms + detect.cpu_ms; }
};

/// A frame that was played.
struct played_frame {
    std::uint32_t number;
    phases took;
    std::span<const aabb::index_pair> pairs;  ///< of boxes, sorted; duplicates stay
    std::span<const aabb::contact> contacts;  ///< the same; empty in a scene of boxes

    [[nodiscard]] double ms() const { return took.wall_ms(); }
};

/// Detects the contacts of a frame, and says how long the query took that is asked: the detection itself, or another.
using detecting = std::function<elapsed(player&)>;
[[nodiscard]] elapsed detect_in(player& who);

/// Plays what is left of a scene, or so many frames of it. Each frame is handed over, then the scene is told what was
/// found in it.
void play(scene_play& scene, player& who, const std::function<void(const played_frame&)>& each,
          std::size_t most = std::numeric_limits<std::size_t>::max(), const detecting& detect = detect_in);

/// Number and digest of what is found, frame by frame.
class tally {
public:
    /// @param meshes the digest is of contacts, not of pairs of boxes
    explicit tally(bool meshes) : meshes_(meshes) {}

    /// A frame: both sorted; contacts are empty in a scene of boxes.
    void add(std::span<const aabb::index_pair> pairs, std::span<const aabb::contact> contacts);

    [[nodiscard]] std::uint64_t candidates() const { return candidates_; }
    [[nodiscard]] std::optional<std::uint64_t> contacts() const {
        return meshes_ ? std::optional(contacts_) : std::nullopt;
    }
    [[nodiscard]] std::string digest() const { return digest_.text(); }

private:
    bool meshes_;
    std::uint32_t frame_ = 0;
    std::uint64_t candidates_ = 0;
    std::uint64_t contacts_ = 0;
    aabb::digest digest_;
};

// One trial: who plays a scene, how it is asked, and what is seen of that.

/// A scene played once from a fresh start, or its first frames.
struct observation {
    elapsed build;  ///< making the stages, taking the objects, building the trees
    phases first;   ///< frame 0
    phases rest;    ///< all frames after it
    std::size_t frames = 0;
    std::string digest;
    std::vector<std::string> digests;      ///< up to each frame, of who played in a copy of this process
    std::string wrong;                     ///< what is answered otherwise than by the digest; empty where all is right
    std::uint64_t bytes = 0;               ///< held after the last of these frames
    aabb::work_counters work;              ///< over all frames
    std::vector<aabb::omission> left_out;  ///< by the stages, after the last of these frames

    /// Wall time of all frames that were played.
    [[nodiscard]] double whole_ms() const { return build.wall_ms + first.wall_ms() + rest.wall_ms(); }
    /// Of a frame after frame 0.
    [[nodiscard]] double steady_ms() const { return frames > 1 ? rest.wall_ms() / static_cast<double>(frames - 1) : 0; }
    /// The same, or of frame 0 where it is alone.
    [[nodiscard]] double frame_ms() const { return frames > 1 ? steady_ms() : first.wall_ms(); }
    /// Of so many frames, the further ones as fast as those that were played.
    [[nodiscard]] double over(double all_frames) const {
        return build.wall_ms + first.wall_ms() + (all_frames > 1 ? (all_frames - 1) * steady_ms() : 0);
    }
};

/// What columns of these times include, for the lines below a table.
inline constexpr const char* build_ms_text =
    "build ms: the stages are made, with the trees of all meshes, before frame 0.";
inline constexpr const char* ms_a_frame_text =
    "ms/frame: update, search and detection of a frame, the mean of those after frame 0; of frame 0 where it is alone.";

/// How a scene is played.
struct protocol {
    asking asked = {};
    std::size_t frames = std::numeric_limits<std::size_t>::max();  ///< at most
    aabb::instrumentation counted = aabb::instrumentation::none;
    /// Takes what is seen so far, after each frame.
    std::function<void(const observation&)> each = nullptr;
};

/// Plays a scene from its first frame on; it is told what is found. Of an external engine times are what it says of
/// itself, of wall time alone.
[[nodiscard]] observation observe(scene_play& scene, const contender& who, const protocol& how = {});
[[nodiscard]] observation observe(const scene_choice& scene, const contender& who, const protocol& how = {});

// Trials in copies of this process, which may take too long or too much memory.

/// How work ended that was done apart.
enum class ending : std::uint8_t {
    done,
    stopped,        ///< it took longer than it may
    out_of_memory,  ///< or was killed by somebody else, as the kernel does where memory runs out
    refused,        ///< by an aabb::input_error
    failed
};

struct work_apart {
    ending end = ending::stopped;
    std::string told;    ///< up to that end
    std::string reason;  ///< the sentence of a refusal
    double seconds = 0;  ///< that it took
};

/// Takes what the work has to tell, as it comes: that is there also where the work does not end.
using telling = std::function<void(std::string_view)>;

/// Does the work in a copy of this process, which is killed after so many seconds. Where memory runs out the kernel
/// kills the copy first.
/// @param seconds without any, nothing is begun
[[nodiscard]] work_apart done_apart(const std::function<void(const telling&)>& work, double seconds);

/// A play in a copy of this process.
struct attempt {
    ending end = ending::stopped;
    observation seen;              ///< of the frames that it came to the end of
    std::string reason;            ///< the sentence of a refusal
    double seconds = 0;            ///< in all, with reading, and sorting what was found
    double seconds_of_frames = 0;  ///< up to the end of the last of those frames
    bool is_out_of_time = false;   ///< it was stopped since no more time was left, not for being slow
};

/// "stopped after 2.1 s, in frame 3", "not played: no time was left"
[[nodiscard]] std::string text_of(const attempt& one);

/// A scene that is read once and played by many, each in a copy of this process, which is not played itself.
class staged_scene {
public:
    /// @throws aabb::input_error where the scene cannot be made.
    explicit staged_scene(const scene_choice& choice) : choice_(choice), scene_(choice) {}

    [[nodiscard]] const scene_choice& choice() const { return choice_; }
    [[nodiscard]] const scene_play& scene() const { return scene_; }
    /// Plays the first frames, for so many seconds at most.
    /// @param left seconds that are left for all
    [[nodiscard]] attempt play(const contender& who, std::size_t frames, double seconds,
                               double left = std::numeric_limits<double>::infinity());
    /// Does something else with the scene from its first frame on.
    [[nodiscard]] work_apart apart(const std::function<void(scene_play&, const telling&)>& work, double seconds);

private:
    scene_choice choice_;
    scene_play scene_;
};

// Playing in turn.

/// What came of playing in turn, by contender.
struct turns {
    std::size_t frames = 0;  ///< in each play: as many as there was time for
    std::size_t rounds = 0;
    std::vector<std::vector<observation>> times;     ///< of whole plays, by round
    std::vector<std::optional<attempt>> broken_off;  ///< whose first play did not end
    std::vector<bool> hopeless;                      ///< who took, or would have taken, `hopeless_ratio` times as long
};

/// Plays the first frames of the scene with all in turn, round after round, until time is over; who is hopeless beside
/// the first plays in one round only. Without the first, whose first frame may take too long, nobody else plays.
[[nodiscard]] turns play_in_turn(staged_scene& scene, std::span<const contender> all, std::size_t frames,
                                 std::size_t rounds, const time_limits& limits);

/// Those of them, by place, who find other pairs than the first in as many frames.
[[nodiscard]] std::vector<std::size_t> who_disagrees(std::span<const std::vector<observation>> times);

/// By round.
[[nodiscard]] std::vector<double> frame_ms_of(std::span<const observation> times);

// Who there is, and whole scenes.

/// "insertion + none + one_axis + canonical + exact", "cgal".
[[nodiscard]] std::string text_of(const contender_name& name);

[[nodiscard]] contender contender_of(const aabb::composition& c, bool meshes);
/// What is selected for the scene beside what is named.
[[nodiscard]] contender contender_of(const aabb::named_strategies& named, const scene_play& scene);
/// What `auto` may know of a scene that has not begun.
[[nodiscard]] aabb::scene_outlook outlook_of(const scene_play& scene);
/// An engine that does one stage only gets the default composition for the other; empty for one that has no part in the
/// scene.
[[nodiscard]] std::optional<contender> contender_of(const aabb::engine_info& engine, bool meshes);

/// Who plays a scene of the experiment: its compositions, then its engines, then, where it is of boxes, its external
/// engines.
[[nodiscard]] std::vector<contender> contenders_for(const experiment& e, const scene_choice& scene);

/// A contender that played a scene beside the exact answer, untimed: its row with all that a run may record of that.
struct validated_row : row {
    std::string failure;  ///< the first difference where the contender must be exact, or that it took too long
    std::vector<difference> differences;  ///< by class
};

struct scene_validation {
    std::uint64_t objects = 0;
    std::uint64_t frames = 0;
    std::string exact_by;  ///< what gave the exact answer
    std::string digest;    ///< of the exact answer
    std::vector<validated_row> contenders;
};

/// Plays all contenders in step with the exact answer and compares whole sets, frame by frame. Work is counted on the
/// way. The scene is told the exact answer.
[[nodiscard]] scene_validation validate_scene(const scene_choice& scene, std::span<const contender> contenders);
/// The same of a scene that is made already, from its first frame on.
/// @param choice what it is, for messages
[[nodiscard]] scene_validation validate_scene(const scene_choice& choice, scene_play& scene,
                                              std::span<const contender> contenders);

/// The experiment as its results keep it.
[[nodiscard]] experiment_record record_of(const experiment& e);

/// Validates a scene, then times the repeats of one of the experiment's processes, interleaved over the contenders, and
/// adds a row for each. What the folder has already is not played again; later processes take what the first one
/// validated as known, and compare the digest of every repeat with it.
/// @param process from 0; each takes an equal share of the repeats, in order
/// @returns a sentence for each contender that is wrong; it gets no row.
[[nodiscard]] std::vector<std::string> run_scene(const experiment& e, const scene_choice& scene,
                                                 std::span<const contender> contenders, results_folder& results,
                                                 std::size_t process = 0);

}  // namespace aabblab
