/// Scenes in which exactness is hardest, pairs of triangles known to be hard, and the judge of whoever plays them.
export module aabb.extreme;

import aabb.pipeline;
import aabb.std;
import aabb.truth;

export namespace aabb {

/// What a thread computes in.
enum class arithmetic : std::uint8_t {
    ieee,               ///< that of IEEE 754, rounding to nearest
    denormals_flushed,  ///< denormal numbers count as zero, as a library linked with -ffast-math leaves a thread
    rounded_upward,
};

/// Whether this processor can flush denormals in a way that is known here.
[[nodiscard]] bool can_flush_denormals() noexcept;

/// Does the work in a thread of its own that computes so; what it throws is thrown here.
void in_arithmetic(arithmetic kind, const std::function<void()>& work);

/// What is asked of a scene of meshes. Whoever lists all candidates first has no part in `first_pair`: there are more
/// of them than any memory holds.
enum class extreme_query : std::uint8_t { all_pairs, count_pairs, first_pair };

/// A scene, and what is expected of whoever plays it: the exact answer, or a refusal.
struct extreme_scene {
    std::string name;
    std::string summary;
    std::function<std::unique_ptr<box_scene>()> make_boxes = {};    ///< empty in a scene of meshes
    std::function<std::unique_ptr<mesh_scene>()> make_meshes = {};  ///< empty in a scene of boxes
    std::string refusal = {};  ///< what the sentence says with which everybody must refuse; empty: all must answer
    /// Who computes with the poses as they are, in double, may say in place of refusing that nothing meets.
    bool answered_in_double = false;
    arithmetic computed_in = arithmetic::ieee;
    /// `all_pairs` asks everything, `count_pairs` that and `first_pair`, `first_pair` nothing else.
    extreme_query asked = extreme_query::all_pairs;
    std::size_t most_bytes = 0;  ///< that a composition may hold; 0 where none are stated
};

/// `small` has fewer coincident triangles, for tests and a first look; all else is the same.
enum class extreme_size : std::uint8_t { small, quick, full };

/// Every extreme scene that needs no file and no generator, the same on every machine; scenes of boxes first. Those in
/// which denormals are flushed are left out where that cannot be done.
[[nodiscard]] std::vector<extreme_scene> extreme_scenes(extreme_size size);

/// Frames of boxes that are known beforehand.
class known_boxes final : public box_scene {
public:
    /// @param present by frame and object, 0 or 1; empty where all are there all the time
    explicit known_boxes(std::vector<std::vector<box>> frames, std::vector<std::vector<std::uint8_t>> present = {})
        : frames_(std::move(frames)), present_(std::move(present)) {}

    [[nodiscard]] std::size_t objects() const override { return frames_.front().size(); }
    [[nodiscard]] std::size_t frames() const override { return frames_.size(); }
    bool next(std::vector<box>& boxes) override {
        if (played_ == frames_.size()) return false;
        boxes = frames_[played_++];
        return true;
    }
    [[nodiscard]] std::span<const std::uint8_t> present() const override {
        return present_.empty() ? std::span<const std::uint8_t>() : present_[played_ - 1];
    }

private:
    std::vector<std::vector<box>> frames_;
    std::vector<std::vector<std::uint8_t>> present_;
    std::size_t played_ = 0;
};

/// Meshes at poses that are known beforehand.
class known_poses final : public mesh_scene {
public:
    /// Object i is mesh i.
    known_poses(std::vector<mesh> given, std::vector<std::vector<pose>> frames) : frames_(std::move(frames)) {
        meshes = std::move(given);
        for (std::uint32_t m = 0; m < meshes.size(); ++m) mesh_of.push_back(m);
    }
    /// As many objects of one mesh as there are poses.
    known_poses(mesh given, std::vector<std::vector<pose>> frames) : frames_(std::move(frames)) {
        meshes.push_back(std::move(given));
        mesh_of.assign(frames_.front().size(), 0);
    }

    [[nodiscard]] std::size_t frames() const override { return frames_.size(); }
    bool next(std::vector<pose>& poses) override {
        if (played_ == frames_.size()) return false;
        poses = frames_[played_++];
        return true;
    }

private:
    std::vector<std::vector<pose>> frames_;
    std::size_t played_ = 0;
};

// The exact answers on a scene, by definition.

/// A frame of a scene of boxes, who comes and goes in it, and its overlapping pairs.
struct exact_box_frame {
    std::vector<box> boxes;
    std::vector<std::uint32_t> arrivals;
    std::vector<std::uint32_t> departures;
    std::vector<index_pair> pairs;  // sorted
};
using exact_boxes = std::vector<exact_box_frame>;

/// Pairs by a double loop over those who are present.
[[nodiscard]] exact_boxes exact_boxes_of(box_scene& scene);

/// Two objects in a frame of a scene of meshes.
struct exact_objects {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    std::vector<index_pair> pairs;  // of triangles, sorted; empty where only a first pair is asked for
    bool meet = false;
};

struct exact_mesh_frame {
    std::vector<pose> poses;
    std::vector<exact_objects> objects;  // every two
};

struct exact_meshes {
    std::vector<exact_mesh_frame> frames;
    std::vector<index_pair> self_pairs;  // of the mesh, sorted, where there is one and everything is asked
};

/// Pairs by CGAL's exact kernel, on vertices that are carried into the first object's frame.
[[nodiscard]] exact_meshes exact_meshes_of(mesh_scene& scene, extreme_query asked);

/// Whether a reported pair of triangles is one at all, and intersects.
[[nodiscard]] bool is_true_pair(const mesh_scene& scene, const exact_mesh_frame& frame, const exact_objects& objects,
                                const index_pair& pair);

enum class verdict : std::uint8_t {
    exact,    ///< every answer to every query is the exact one
    refused,  ///< an input_error came in place of an answer
    wrong,
};
inline constexpr std::array<std::string_view, 3> verdict_names = {"exact", "refused", "wrong"};

/// How one stage did in one scene, over all frames.
struct judgement {
    verdict said = verdict::exact;
    std::string reason;          ///< the sentence of the refusal, or the first thing that is wrong
    std::uint64_t missing = 0;   ///< pairs of the exact answer that were not reported
    std::uint64_t invented = 0;  ///< reported, but not so often in the exact answer
    differences classes;         ///< the same of triangles, by class; a pair that is reported too often counts once
    std::size_t bytes = 0;       ///< that the stage holds in the end
};

/// Holds stages against the exact answer on a scene, which it works out by the definition: boxes in a double loop,
/// triangles by CGAL's exact kernel on every two of them, whether or not their boxes overlap.
class extreme_judge {
public:
    explicit extreme_judge(extreme_scene scene);

    [[nodiscard]] const extreme_scene& scene() const { return scene_; }

    /// Plays the scene of boxes, or of meshes, from its first frame to its last; every two meshes are candidates. In
    /// other arithmetic than that of IEEE 754 the stage is made and filled in that one, then asked each query in the
    /// other.
    [[nodiscard]] judgement judge(const std::function<std::unique_ptr<global_stage>()>& make) const;
    [[nodiscard]] judgement judge(const std::function<std::unique_ptr<local_stage>()>& make) const;

private:
    extreme_scene scene_;
    exact_boxes boxes_;    // empty in a scene of meshes, and where all must refuse
    exact_meshes meshes_;  // the same the other way round
};

/// Whether the stage did what the scene expects: the exact answer, or the refusal with this sentence. One that need not
/// be exact must refuse all the same.
[[nodiscard]] bool is_as_expected(const extreme_scene& scene, const judgement& made, bool must_be_exact = true);

/// Makes an exact answer wrong that took more memory than the scene states.
void require_stated_memory(const extreme_scene& scene, judgement& made);

/// Two triangles that somebody found hard, and whether they intersect.
struct triangle_case {
    std::string name;
    std::string source;  ///< where it comes from
    std::string about;   ///< what is hard about it
    std::string kind;    ///< cases of one kind are told together
    triangle3d first;
    triangle3d second;
    bool intersect = false;  ///< with coordinates rounded to float
    bool intersect_double = false;
};

/// The two triangles as every order of their corners and both orders of themselves name them: 72 pairs.
/// @tparam Real float or double, to which coordinates are rounded
template <class Real>
[[nodiscard]] std::vector<triangle_pair<Real>> every_order(const triangle_case& one) {
    constexpr std::array<std::array<int, 3>, 6> orders{
        {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
    const auto rounded = [](const triangle3d& t, const std::array<int, 3>& order) {
        triangle3<Real> made{};
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) made[i][k] = static_cast<Real>(t[order[static_cast<std::size_t>(i)]][k]);
        return made;
    };
    std::vector<triangle_pair<Real>> all;
    for (const auto& order_a : orders)
        for (const auto& order_b : orders) {
            const triangle3<Real> a = rounded(one.first, order_a);
            const triangle3<Real> b = rounded(one.second, order_b);
            all.push_back({a, b});
            all.push_back({b, a});
        }
    return all;
}

}  // namespace aabb
