export module aabb.pipeline:stage;

import aabb.local_detection;
import aabb.std;
import :scene_parts;

// The two stages as a program sees them. Each is composed statically behind one call a frame (global search) or one
// call a pair of meshes (local detection); between them stands a buffer of candidate pairs.
export namespace aabb {

/// What one part of a stage holds on the heap.
struct part_bytes {
    std::string part;  ///< "projections", "partition", "sweep", "nodes", …
    std::size_t bytes;
};

/// What a stage planned from what it saw.
enum class plan_kind : std::uint8_t { columns, groups_of_columns, neighbour_list, frame_at_rest };
struct stage_plan {
    plan_kind what;
    statement told;  ///< with its numbers
};

/// Boxes in, overlapping pairs out. Where an exception such as std::bad_alloc leaves a stage half-changed, it refuses
/// every later frame, by an input_error; a search that throws appends nothing.
class global_stage : public kept_in_place {
public:
    /// The parts of the scene that are to come to this stage in place of whole objects; null, as of most stages, where
    /// all stay whole. Asked once, before anything comes.
    /// @throws input_error on meshes that `require_valid` refuses.
    [[nodiscard]] virtual std::unique_ptr<scene_parts> divide(const mesh_scene& /*scene*/) { return nullptr; }

    /// How many frames there will be, so that nothing is prepared for more of them. Results do not depend on it, and
    /// there may be more or fewer; without this call, nothing is known.
    virtual void expect(std::size_t /*frames*/) {}

    /// An object comes (its id must not be present) or goes (its id must be). Boxes of others take no part.
    virtual void insert(std::uint32_t id) = 0;
    virtual void remove(std::uint32_t id) = 0;

    /// Takes the boxes of a frame, indexed by id: sorts and partitions.
    /// @throws input_error on a box that is not finite or inverted, and on boxes where no object was ever inserted.
    virtual void update(std::span<const box> boxes) = 0;

    /// Appends every overlapping pair of present objects, each once, a < b, in no particular order. The boxes given to
    /// `update` must still be there.
    /// @throws input_error when the last update did not succeed, or there was none.
    virtual void search(std::vector<index_pair>& pairs) = 0;

    /// Of the time of the last search, what went into work of an update: 0 but of a stage that sorts in a search what
    /// it then has in a cache.
    [[nodiscard]] virtual double share_of_update() const { return 0; }

    [[nodiscard]] virtual work_counters counters() const = 0;
    [[nodiscard]] virtual std::vector<part_bytes> bytes() const = 0;
    [[nodiscard]] virtual std::vector<stage_plan> plans() const { return {}; }
    [[nodiscard]] virtual std::vector<omission> left_out() const = 0;
};

/// Two meshes at two poses in, intersecting triangle pairs out.
class local_stage : public kept_in_place {
public:
    /// Builds the tree of a mesh, which must outlive the stage; models are numbered from 0.
    /// @throws input_error on a mesh that `require_valid` refuses.
    virtual std::uint32_t add_model(const mesh& m) = 0;

    /// Appends every pair of intersecting triangles (a of model A, b of model B), each once, in no particular order.
    virtual void all_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                           std::vector<index_pair>& pairs) = 0;

    /// Any one intersecting pair.
    [[nodiscard]] virtual std::optional<index_pair> first_pair(std::uint32_t model_a, const pose& pose_a,
                                                               std::uint32_t model_b, const pose& pose_b) = 0;

    [[nodiscard]] virtual std::uint64_t count_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                                    const pose& pose_b) = 0;

    /// Appends every pair of intersecting triangles a < b of one model, each once, in no particular order. Neighbours
    /// are among them, since they meet in the vertices that they share.
    virtual void self_pairs(std::uint32_t model, std::vector<index_pair>& pairs) = 0;

    /// Calls `take` with each of the same pairs. A stage that finds them one by one stores none: around a vertex of n
    /// triangles there are n²/2.
    virtual void each_self_pair(std::uint32_t model, const std::function<void(index_pair)>& take) {
        std::vector<index_pair> pairs;
        self_pairs(model, pairs);
        for (const index_pair pair : pairs) take(pair);
    }

    /// Takes note that vertices of the model's mesh have moved. When it throws, queries of the model do too, until a
    /// refit succeeds.
    /// @throws input_error when the mesh is no longer valid or of as many triangles.
    virtual void refit(std::uint32_t model) = 0;

    /// Walks the model's whole tree and holds it against the mesh; nothing for a system that shows no tree.
    [[nodiscard]] virtual std::optional<tree_survey> survey(std::uint32_t model) const = 0;

    [[nodiscard]] virtual work_counters counters() const = 0;
    [[nodiscard]] virtual std::vector<part_bytes> bytes() const = 0;
    [[nodiscard]] virtual std::vector<omission> left_out() const = 0;
};

/// What both stages do without, each once. Either may be null.
[[nodiscard]] inline std::vector<omission> left_out_by(const global_stage* global, const local_stage* local) {
    std::vector<omission> absent = global ? global->left_out() : std::vector<omission>{};
    if (!local) absent.push_back({absence::local_detection, "no meshes, no trees, no triangle test"});
    for (const omission& one : local ? local->left_out() : std::vector<omission>{})
        if (std::ranges::find(absent, one) == absent.end()) absent.push_back(one);
    return absent;
}

/// A triangle test alone; it throws input_error as `require_ieee_arithmetic`.
class triangle_test : public kept_in_place {
public:
    [[nodiscard]] virtual bool intersects(const triangle3f& s, const triangle3f& t) const = 0;
    /// @throws input_error when the test is made for float only.
    [[nodiscard]] virtual bool intersects(const triangle3d& s, const triangle3d& t) const = 0;
    [[nodiscard]] virtual bool takes_double() const = 0;

    /// Many pairs in one call, so that a test is as fast as in a walk: 1 where they intersect, else 0.
    /// @param answers as many as pairs
    virtual void intersect(std::span<const triangle_pair<float>> pairs, std::span<std::uint8_t> answers) const = 0;
    /// @throws input_error when the test is made for float only.
    virtual void intersect(std::span<const triangle_pair<double>> pairs, std::span<std::uint8_t> answers) const = 0;

    /// What the two have in common.
    /// @throws input_error when the test only decides.
    [[nodiscard]] virtual triangle_intersection intersection(const triangle3d& s, const triangle3d& t) const = 0;
    [[nodiscard]] virtual bool constructs() const = 0;
};

/// Whether a stage counts its work. Timing runs are not counted.
enum class instrumentation { none, counters };

}  // namespace aabb
