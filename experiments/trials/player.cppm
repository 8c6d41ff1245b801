/// Scenes and those who play them.
export module aabblab.trials:player;

import aabb.base;
import aabb.counters;
import aabb.digest;
import aabb.geometry;
import aabb.pipeline;
import aabb.std;
import aabblab.results;
import aabblab.scenes;
import aabblab.stopwatch;

export namespace aabblab {

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
    explicit scene_play(std::unique_ptr<aabb::box_scene> scene);
    /// @param file that its poses stand in, for messages; empty where they do not
    explicit scene_play(std::unique_ptr<aabb::mesh_scene> scene, std::string file = {});

    [[nodiscard]] std::size_t objects() const;
    [[nodiscard]] std::size_t frames() const;
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
    [[nodiscard]] std::optional<aabb::contact> first_contact();
    [[nodiscard]] std::uint64_t count_contacts();
    /// Hands over the pairs of intersecting triangles a < b of one mesh of the scene, which is not divided, with
    /// itself, in no particular order.
    void each_self_pair(std::uint32_t mesh, const std::function<void(aabb::index_pair)>& take);

    /// Of the frame, by object; by piece where meshes are divided; empty without global search.
    [[nodiscard]] std::span<const aabb::box> boxes() const { return pipeline_ ? pipeline_->boxes() : scene_.boxes(); }
    /// Of the frame, sorted; duplicates stay.
    [[nodiscard]] const std::vector<aabb::index_pair>& sorted_pairs();
    [[nodiscard]] const std::vector<aabb::contact>& sorted_contacts();

    /// Over all frames so far.
    [[nodiscard]] aabb::work_counters counters() const;
    [[nodiscard]] std::vector<aabb::part_bytes> global_bytes() const;
    [[nodiscard]] std::vector<aabb::part_bytes> local_bytes() const;
    [[nodiscard]] std::size_t buffer_bytes() const;
    /// Of all parts but the meshes, which every composition reads.
    [[nodiscard]] std::size_t held_bytes() const;
    /// What the global search planned from what it saw.
    [[nodiscard]] std::vector<aabb::stage_plan> plans() const;
    [[nodiscard]] std::vector<aabb::omission> left_out() const;
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
    [[nodiscard]] std::optional<std::uint64_t> contacts() const;
    [[nodiscard]] std::string digest() const { return digest_.text(); }

private:
    bool meshes_;
    std::uint32_t frame_ = 0;
    std::uint64_t candidates_ = 0;
    std::uint64_t contacts_ = 0;
    aabb::digest digest_;
};

}  // namespace aabblab
