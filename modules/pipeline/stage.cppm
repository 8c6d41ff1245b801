export module aabb.pipeline:stage;

import aabb.local_detection;
import aabb.std;
import :scene_parts;

// The run-time interfaces of the two stages. Each stage is composed statically behind a few virtual calls per frame
// (broad phase) or per pair of meshes (narrow phase); they communicate by a buffer of candidate pairs.
export namespace aabb {

/// Heap bytes of one part of a stage.
struct part_bytes {
    std::string part;  ///< "projections", "partition", "sweep", "nodes", …
    std::size_t bytes;
};

/// A decision that a stage made for the current scene.
enum class plan_kind : std::uint8_t {
    columns,
    groups_of_columns,
    neighbour_list,
    static_frame,
    filter,
    resting_index,
    resting_boxes,
    set_join
};
struct stage_plan {
    plan_kind kind;
    statement decision;  ///< in words, with its numbers
};

/// The broad phase: takes boxes and finds overlapping pairs. After an exception such as std::bad_alloc has left a stage
/// in an inconsistent state, it rejects all later frames with input_error; a search that throws appends nothing.
class global_stage : public kept_in_place {
public:
    /// The parts of the scene that replace whole objects in this stage; null if none is divided, as in most stages.
    /// Called once, before the first object is inserted.
    /// @throws input_error on meshes that `require_valid` rejects
    [[nodiscard]] virtual std::unique_ptr<scene_parts> divide(const mesh_scene& /*scene*/) { return nullptr; }

    /// Sets the expected number of frames, so that work which more frames would have to repay is avoided. Results do
    /// not depend on it, and the actual number may differ. By default it is unknown.
    virtual void expect(std::size_t /*frames*/) {}

    /// Inserts an absent object or removes a present one. Boxes of absent objects are ignored.
    virtual void insert(std::uint32_t id) = 0;
    /// Inserts absent objects in one call, which takes less time than one for each.
    virtual void insert_all(std::span<const std::uint32_t> ids) {
        for (const std::uint32_t id : ids) insert(id);
    }
    virtual void remove(std::uint32_t id) = 0;

    /// Says that no other objects have moved, so that the next `update` need not compare all boxes: their boxes equal
    /// those of the last `update` bit for bit, unless they were inserted since. The ids, in any order, must exist until
    /// that `update`, for which alone this holds. It has no effect if the last `update` threw.
    virtual void moved(std::span<const std::uint32_t> /*ids*/) {}

    /// Takes, sorts and partitions the boxes of a frame, indexed by id.
    /// @throws input_error on a box that is not finite or inverted, and on boxes if no object was ever inserted
    virtual void update(std::span<const box> boxes) = 0;

    /// Appends every overlapping pair of present objects once, a < b, in unspecified order. The boxes passed to
    /// `update` must still exist.
    /// @throws input_error if the last update failed or there was none
    virtual void search(std::vector<index_pair>& pairs) = 0;

    /// Whether the pairs are those whose boxes overlap, and not also others, as within a distance. Then the pairs of
    /// some objects may be found in another way.
    [[nodiscard]] virtual bool finds_overlaps_only() const { return true; }

    /// The share of the last search's time that belongs to the update. It is 0 except for stages that defer sorting to
    /// the search, so that the sorted data are still in a cache.
    [[nodiscard]] virtual double share_of_update() const { return 0; }
    [[nodiscard]] virtual work_counters counters() const = 0;
    [[nodiscard]] virtual std::vector<part_bytes> bytes() const = 0;
    [[nodiscard]] virtual std::vector<stage_plan> plans() const { return {}; }
    [[nodiscard]] virtual std::vector<omission> left_out() const = 0;
};

/// The narrow phase: takes two meshes at two poses and finds intersecting triangle pairs.
class local_stage : public kept_in_place {
public:
    /// Builds the tree of a mesh, which must outlive the stage; models are numbered from 0.
    /// @throws input_error on a mesh that `require_valid` rejects
    virtual std::uint32_t add_model(const mesh& m) = 0;

    /// Appends every pair of intersecting triangles (a of model A, b of model B) once, in unspecified order.
    virtual void all_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                           std::vector<index_pair>& pairs) = 0;

    /// Some intersecting pair, if there is one.
    [[nodiscard]] virtual std::optional<index_pair> first_pair(std::uint32_t model_a, const pose& pose_a,
                                                               std::uint32_t model_b, const pose& pose_b) = 0;

    [[nodiscard]] virtual std::uint64_t count_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                                    const pose& pose_b) = 0;

    /// Appends every pair of intersecting triangles a < b of one model once, in unspecified order, including
    /// neighbours, which intersect in the vertices that they share.
    virtual void self_pairs(std::uint32_t model, std::vector<index_pair>& pairs) = 0;

    /// Calls `take` with each of the same pairs until it returns true. Stages that can do so store none, since a vertex
    /// of n triangles alone yields n²/2 pairs.
    virtual void each_self_pair(std::uint32_t model, const std::function<bool(index_pair)>& take) {
        std::vector<index_pair> pairs;
        self_pairs(model, pairs);
        static_cast<void>(std::ranges::any_of(pairs, take));
    }

    /// Updates the tree after vertices of its mesh have moved. If this throws, queries throw until a refit succeeds.
    /// @throws input_error if the mesh is invalid or its number of triangles has changed
    virtual void refit(std::uint32_t model) = 0;

    /// Validates the model's whole tree against the mesh; nullopt for an engine that does not expose its tree.
    [[nodiscard]] virtual std::optional<tree_validation> validate_tree(std::uint32_t model) const = 0;
    [[nodiscard]] virtual work_counters counters() const = 0;
    [[nodiscard]] virtual std::vector<part_bytes> bytes() const = 0;
    [[nodiscard]] virtual std::vector<omission> left_out() const = 0;
};

/// The features that the stages lack, without duplicates. Either stage may be null.
[[nodiscard]] inline std::vector<omission> left_out_by(const global_stage* global, const local_stage* local) {
    std::vector<omission> absent = global ? global->left_out() : std::vector<omission>{};
    if (!local) absent.push_back({absence::local_detection, "objects are boxes, without trees and triangles"});
    for (const omission& o : local ? local->left_out() : std::vector<omission>{})
        if (std::ranges::find(absent, o) == absent.end()) absent.push_back(o);
    return absent;
}

/// A standalone triangle test. All tests throw input_error as `require_ieee_arithmetic`.
class triangle_test : public kept_in_place {
public:
    [[nodiscard]] virtual bool intersects(const triangle3f& s, const triangle3f& t) const = 0;
    /// @throws input_error if the test only takes floats
    [[nodiscard]] virtual bool intersects(const triangle3d& s, const triangle3d& t) const = 0;
    [[nodiscard]] virtual bool takes_double() const = 0;

    /// Tests many pairs in one call, so that the virtual call does not dominate the time.
    /// @param results output, as long as `pairs`: 1 if the triangles intersect, else 0
    virtual void intersect(std::span<const triangle_pair<float>> pairs, std::span<std::uint8_t> results) const = 0;
    /// @throws input_error if the test only takes floats
    virtual void intersect(std::span<const triangle_pair<double>> pairs, std::span<std::uint8_t> results) const = 0;

    /// The intersection of two triangles.
    /// @throws input_error if the test does not construct it
    [[nodiscard]] virtual triangle_intersection intersection(const triangle3d& s, const triangle3d& t) const = 0;
    [[nodiscard]] virtual bool constructs() const = 0;
};

/// Whether a stage counts its work; timed runs do not.
enum class instrumentation { none, counters };

}  // namespace aabb
