/// What users ask of both stages or of one: every pair of boxes or triangles in the frames of a scene, or of two meshes
/// at poses, with its digest, its times and its rows.
export module aabblab.queries;

import aabb.pipeline;
import aabb.registry;
import aabb.selection;
import aabb.std;
import aabblab.configs;
import aabblab.inputs;
import aabblab.pair_output;
import aabblab.trials;

export namespace aabblab {

/// The triangle test of a command with --geometry.
/// @throws aabb::input_error where there is none of this name, or it only decides, with the names of those that do not.
/// @param composed only strategies are meant, as part of a composition
[[nodiscard]] std::unique_ptr<aabb::triangle_test> constructing_test(const aabb::strategy_choice& choice,
                                                                     bool composed);

/// What triangles of two posed meshes have in common: found in the frame of the first mesh, in which they are tested
/// (`relative_pose`), and carried to the world.
class hit_geometry {
public:
    /// @throws aabb::input_error as `constructing_test`.
    explicit hit_geometry(const aabb::strategy_choice& triangle);

    /// The meshes of the hits that follow, which must stay.
    void take(const aabb::mesh& a, const aabb::pose& pose_a, const aabb::mesh& b, const aabb::pose& pose_b);
    [[nodiscard]] aabb::triangle_intersection operator()(aabb::index_pair triangles) const;

private:
    std::unique_ptr<aabb::triangle_test> test_;
    const aabb::mesh* a_ = nullptr;
    const aabb::mesh* b_ = nullptr;
    aabb::pose pose_a_;
    std::optional<aabb::relative_pose> to_a_;
};

struct search_choice {
    std::vector<aabb::stage> stages;  ///< one of the two, or both
    aabb::named_strategies named;
    std::optional<std::string> engine;  ///< in place of the last of these stages
    bool geometry = false;              ///< its triangle test constructs what triangles have in common
};

struct search_method {
    std::string name;
    bool exact = true;
    stages made;
    std::optional<hit_geometry> geometry;

    /// "cgal", "fcl (inexact)".
    [[nodiscard]] std::string text() const { return exact ? name : name + " (inexact)"; }
};
/// What is not named is selected for the scene.
/// @throws aabb::input_error on an unknown engine, and on what does not go together.
[[nodiscard]] search_method method_of(const search_choice& choice, const aabb::scene_outlook& outlook);

struct frames_result {
    std::size_t objects = 0;
    std::uint64_t pairs = 0;         ///< of boxes, summed over the frames, as are the next two
    std::uint64_t object_pairs = 0;  ///< in contact
    std::uint64_t contacts = 0;      ///< of triangles; 0 in a scene of boxes
    std::string digest;              ///< of pairs in a scene of boxes, else of contacts
    double build_ms = 0;
    std::vector<double> ms;  ///< by frame

    [[nodiscard]] double mean_ms() const {
        return std::accumulate(ms.begin(), ms.end(), 0.0) / static_cast<double>(ms.size());
    }
};
/// Searches every frame of a scene.
/// @param rows takes what is found, and is committed: frame and pair, or frame, objects and triangles; null for none
/// @throws defect where something is found twice.
[[nodiscard]] frames_result search_frames(scene_play& scene, search_method& method, number_table* rows);

/// A question to two meshes, or to one about itself.
struct mesh_query {
    question ask = question::pairs;
    bool self = false;         ///< of one mesh: pairs that share a vertex are counted apart
    bool neighbours = false;   ///< and are among those that are told
    bool by_pose = false;      ///< rows tell the pose too
    std::size_t repeats = 1;   ///< each at all poses in turn
    std::string between = {};  ///< "a.off against b.off", for messages
};

struct found_pair {
    aabb::index_pair triangles;
    std::optional<aabb::triangle_intersection> common;  ///< where the method constructs it
};

struct mesh_result {
    search_method method;                          ///< who searched
    std::vector<std::uint32_t> triangles;          ///< of each mesh
    std::vector<std::uint64_t> counts;             ///< by pose, of a mesh with itself those that share no vertex
    std::optional<std::uint64_t> neighbours;       ///< of a mesh with itself: pairs that share a vertex
    std::vector<std::optional<found_pair>> first;  ///< by pose, where any one was asked for
    std::optional<std::string> digest;             ///< of all pairs that are kept; none where they are counted only
    double build_ms = 0;
    std::vector<double> query_ms;  ///< by pose, and so again for each repeat
    std::vector<aabb::part_bytes> bytes;
    std::optional<double> bytes_per_triangle;  ///< of the trees; none for an engine that does not say
};
/// Every two meshes are candidates, since boxes in the world say nothing of meshes that were moved together, however
/// far. What is found again in a repeat is not told again.
/// @param meshes one or two
/// @param of_b where the second one is, one pose or several
/// @param rows takes triangles, with the pose before them, or behind them how many vertices neighbours share; null
/// where nobody wants them
/// @throws aabb::input_error where poses cannot be searched at, defect where something is found twice or missed.
[[nodiscard]] mesh_result search_meshes(const mesh_query& query, const search_choice& who,
                                        std::vector<aabb::mesh> meshes, const aabb::pose& of_a, given_poses of_b,
                                        number_table* rows);

}  // namespace aabblab
