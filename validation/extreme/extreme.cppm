/// Extreme scenes, in which exactness is hardest, known hard pairs of triangles, and the judge of candidates.
export module aabb.extreme;

import aabb.pipeline;
import aabb.registry;
import aabb.std;
import aabb.truth;

export namespace aabb {

/// The floating-point mode of a thread.
enum class arithmetic : std::uint8_t {
    ieee,               ///< IEEE 754, rounding to nearest
    denormals_flushed,  ///< denormals count as zero, as after loading a library linked with -ffast-math
    rounded_upward,
};

/// Whether the program knows how to make this processor flush denormals.
[[nodiscard]] bool can_flush_denormals() noexcept;

/// Runs the work in a separate thread in this mode; exceptions are rethrown here.
void in_arithmetic(arithmetic kind, const std::function<void()>& work);

/// The queries of a scene of meshes. Engines that list all candidates first lack the memory for `first_pair`.
enum class extreme_query : std::uint8_t { all_pairs, count_pairs, first_pair };

/// A scene and the expected result of a candidate: the ground truth, or an input_error.
struct extreme_scene {
    std::string name;
    std::string summary;
    std::function<std::unique_ptr<box_scene>()> make_boxes = {};    ///< empty in a scene of meshes
    std::function<std::unique_ptr<mesh_scene>()> make_meshes = {};  ///< empty in a scene of boxes
    std::string rejection = {};  ///< part of the message with which all must reject the scene; empty if valid
    /// Engines that compute with the raw poses in double may report no pairs instead of rejecting the scene.
    bool accepted_in_double = false;
    arithmetic computed_in = arithmetic::ieee;
    /// `all_pairs` runs all queries, `count_pairs` that and `first_pair`, `first_pair` only itself.
    extreme_query query = extreme_query::all_pairs;
    std::size_t most_bytes = 0;  ///< the memory limit of a composition; 0 for no limit
};

/// Sizes differ only in the number of coincident triangles; `small` is for tests.
enum class extreme_size : std::uint8_t { small, quick, full };

/// All extreme scenes that need no file and no generator, identical on all machines; scenes of boxes first. Scenes with
/// flushed denormals are left out if the processor cannot flush them.
[[nodiscard]] std::vector<extreme_scene> extreme_scenes(extreme_size size);

class known_boxes final : public box_scene {
public:
    /// @param present 0 or 1, by frame and object; empty if all objects are always present
    explicit known_boxes(std::vector<std::vector<box>> frames, std::vector<std::vector<std::uint8_t>> present = {})
        : frames_(std::move(frames)), present_(std::move(present)) {}

    [[nodiscard]] std::size_t objects() const override { return frames_.front().size(); }
    [[nodiscard]] std::size_t frames() const override { return frames_.size(); }
    bool next(std::vector<box>& boxes) override {
        if (frames_run_ == frames_.size()) return false;
        boxes = frames_[frames_run_++];
        return true;
    }
    [[nodiscard]] std::span<const std::uint8_t> present() const override {
        return present_.empty() ? std::span<const std::uint8_t>() : present_[frames_run_ - 1];
    }

private:
    std::vector<std::vector<box>> frames_;
    std::vector<std::vector<std::uint8_t>> present_;
    std::size_t frames_run_ = 0;
};

class known_poses final : public mesh_scene {
public:
    /// Object i is mesh i.
    known_poses(std::vector<mesh> object_meshes, std::vector<std::vector<pose>> frames) : frames_(std::move(frames)) {
        meshes = std::move(object_meshes);
        for (std::uint32_t m = 0; m < meshes.size(); ++m) mesh_of.push_back(m);
    }
    /// All objects, one per pose, share one mesh.
    known_poses(mesh shared_mesh, std::vector<std::vector<pose>> frames) : frames_(std::move(frames)) {
        meshes.push_back(std::move(shared_mesh));
        mesh_of.assign(frames_.front().size(), 0);
    }

    [[nodiscard]] std::size_t frames() const override { return frames_.size(); }
    bool next(std::vector<pose>& poses) override {
        if (frames_run_ == frames_.size()) return false;
        poses = frames_[frames_run_++];
        return true;
    }

private:
    std::vector<std::vector<pose>> frames_;
    std::size_t frames_run_ = 0;
};

/// A frame of a scene of boxes, with arriving and departing objects and the overlapping pairs.
struct exact_box_frame {
    std::vector<box> boxes;
    std::vector<std::uint32_t> arrivals;
    std::vector<std::uint32_t> departures;
    std::vector<index_pair> pairs;  // sorted
};
using exact_boxes = std::vector<exact_box_frame>;

/// Finds pairs by a double loop over the present objects.
[[nodiscard]] exact_boxes exact_boxes_of(box_scene& scene);

/// Two objects in a frame of a scene of meshes.
struct exact_objects {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    std::vector<index_pair> pairs;  // of triangles, sorted; empty for `first_pair`
    bool intersect = false;
};

struct exact_mesh_frame {
    std::vector<pose> poses;
    std::vector<exact_objects> objects;  // all pairs of objects
};

struct exact_meshes {
    std::vector<exact_mesh_frame> frames;
    std::vector<index_pair> self_pairs;  // sorted; of a single mesh, for `all_pairs`
};

/// Finds pairs by CGAL's exact kernel, with vertices transformed into the first object's frame.
[[nodiscard]] exact_meshes exact_meshes_of(mesh_scene& scene, extreme_query query);

/// Whether a reported pair of triangles has valid indices and intersects.
[[nodiscard]] bool is_true_pair(const mesh_scene& scene, const exact_mesh_frame& frame, const exact_objects& objects,
                                const index_pair& pair);

enum class verdict : std::uint8_t {
    exact,     ///< all results of all queries equal the ground truth
    rejected,  ///< the scene was rejected with an input_error
    wrong,
};
inline constexpr std::array<std::string_view, 3> verdict_names = {"exact", "refused", "wrong"};

/// The results of one stage in one scene, over all frames.
struct extreme_result {
    verdict outcome = verdict::exact;
    std::string reason;  ///< the message of the input_error, or the first error
    std::uint64_t false_negatives = 0;
    std::uint64_t false_positives = 0;  ///< including repeated pairs
    differences classes;                ///< the same for triangles, by class; repeated pairs count once
    std::size_t bytes = 0;              ///< of the stage after the last frame
};

/// Compares stages with the ground truth of a scene, which it computes by definition: boxes by a double loop, triangles
/// by CGAL's exact kernel on all pairs, whether or not their boxes overlap.
class extreme_judge {
public:
    explicit extreme_judge(extreme_scene scene);

    [[nodiscard]] const extreme_scene& scene() const { return scene_; }

    /// Runs all frames of the scene of boxes or meshes; all pairs of meshes are candidates. For a non-IEEE mode, the
    /// stage is built in IEEE 754 arithmetic, then each query runs in that mode.
    [[nodiscard]] extreme_result judge(const std::function<std::unique_ptr<global_stage>()>& make) const;
    [[nodiscard]] extreme_result judge(const std::function<std::unique_ptr<local_stage>()>& make) const;

private:
    extreme_scene scene_;
    exact_boxes boxes_;    // empty in a scene of meshes and in an invalid scene
    exact_meshes meshes_;  // empty in a scene of boxes and in an invalid scene
};

/// A narrow phase of the composition's build and tree that finds pairs of triangles at a distance of 0, and rejects
/// what the composition rejects. With `first_pair` it fails if the distance of the two meshes is not 0 where they
/// intersect, or if elsewhere the nearest pair is not as far as that, up to its error.
[[nodiscard]] std::unique_ptr<local_stage> compose_by_distance(const composition& c);

/// Whether the result is the ground truth or, also of inexact stages, the expected rejection of an invalid scene.
[[nodiscard]] bool is_as_expected(const extreme_scene& scene, const extreme_result& result, bool must_be_exact = true);

/// Turns the result into a wrong one if it exceeds the scene's memory limit.
void require_stated_memory(const extreme_scene& scene, extreme_result& result);

/// A hard pair of triangles, and whether they intersect.
struct triangle_case {
    std::string name;
    std::string source;  ///< its origin
    std::string about;   ///< what is hard about it
    std::string kind;    ///< cases of one kind are reported together
    triangle3d first;
    triangle3d second;
    bool intersect = false;  ///< with coordinates rounded to float
    bool intersect_double = false;
};

/// All 72 pairs by permutations of corners and a swap of the triangles, on which no result must depend.
/// @tparam Real float or double, to which coordinates are rounded
template <class Real>
[[nodiscard]] std::vector<triangle_pair<Real>> every_order(const triangle_case& original) {
    constexpr std::array<std::array<int, 3>, 6> orders{
        {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
    const auto rounded = [](const triangle3d& t, const std::array<int, 3>& order) {
        triangle3<Real> permuted{};
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) permuted[i][k] = static_cast<Real>(t[order[static_cast<std::size_t>(i)]][k]);
        return permuted;
    };
    std::vector<triangle_pair<Real>> pairs;
    for (const auto& order_a : orders)
        for (const auto& order_b : orders) {
            const triangle3<Real> a = rounded(original.first, order_a), b = rounded(original.second, order_b);
            pairs.push_back({a, b});
            pairs.push_back({b, a});
        }
    return pairs;
}

}  // namespace aabb
