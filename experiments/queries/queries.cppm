/// Queries of one or both stages, in the frames of a scene or of two meshes at given poses, with digest, times, rows.
export module aabblab.queries;

import aabb.collision_filter;
import aabb.containment;
import aabb.distance;
import aabb.distance_stage;
import aabb.pipeline;
import aabb.registry;
import aabb.selection;
import aabb.std;
import aabb.touching;
import aabblab.configs;
import aabblab.drawing;
import aabblab.inputs;
import aabblab.pair_output;
import aabblab.trials;

export namespace aabblab {

/// The intersections of triangles of two posed meshes, exact as they are given, in world coordinates.
class hit_geometry {
public:
    /// @param a,b must outlive this object
    hit_geometry(const aabb::mesh& a, const aabb::pose& pose_a, const aabb::mesh& b, const aabb::pose& pose_b)
        : a_(a), b_(b), poses_{pose_a, pose_b} {}

    [[nodiscard]] aabb::intersection_kind kind(aabb::index_pair triangles) const;
    [[nodiscard]] aabb::triangle_intersection operator()(aabb::index_pair triangles) const;

private:
    const aabb::mesh& a_;
    const aabb::mesh& b_;
    aabb::pose_pair poses_;
};

/// The hits of each `intersection_kind`; those of an inexact method may have `none`.
using kind_counts = std::array<std::uint64_t, aabb::intersection_kind_names.size()>;
/// Counts for JSON, by the kind's name; without `none` if no hit has it.
[[nodiscard]] std::map<std::string, std::uint64_t> by_name(const kind_counts& counts);
/// "12 touch in a point, 10 pass through each other"; a line without the kinds that no hit has, or nothing.
[[nodiscard]] std::string to_text(const kind_counts& counts);

/// Which hits a query reports, and with what.
struct hit_choice {
    bool touching = true;   ///< whether those count that only touch, in a point or along a segment
    bool geometry = false;  ///< whether rows have the intersection
};

/// Counts hits by kind, and removes those that only touch, unless these are wanted.
class hit_filter {
public:
    explicit hit_filter(bool touching) : touching_(touching) {}

    /// Whether the hit is kept; then it is counted.
    [[nodiscard]] bool keeps(aabb::intersection_kind kind);
    [[nodiscard]] const kind_counts& counts() const { return counts_; }

private:
    bool touching_;
    kind_counts counts_{};
};

/// Asks for pairs at a distance of at most `d`, instead of overlapping boxes or intersecting triangles.
struct nearness {
    double d;
    aabb::box_metric metric = aabb::box_metric::euclidean;  ///< of boxes
    const aabb::box_scene* in_double = nullptr;             ///< a scene whose boxes in double decide, if it has some
};

/// The scene without its boxes in double, so that what searches it sees floats only; `nearness` may refer to the given
/// scene, which lives as long.
[[nodiscard]] std::unique_ptr<aabb::box_scene> in_floats(std::unique_ptr<aabb::box_scene> scene);

struct search_choice {
    std::vector<aabb::stage> stages;  ///< one or both of the two
    aabb::named_strategies named;
    std::optional<std::string> engine;  ///< replaces the last of these stages
    std::optional<nearness> within = {};
};

struct search_method {
    std::string name;
    bool exact = true;
    std::shared_ptr<const aabb::collision_filter> filter;  ///< of the stages, which it outlives; may be null
    stages run_stages;

    /// "cgal", "fcl (inexact)".
    [[nodiscard]] std::string text() const { return exact ? name : name + " (inexact)"; }
};
/// Selects the strategies that are not named for the scene.
/// @param filter says which pairs are found, for a scene that has none of its own; null for all
/// @throws aabb::input_error on an unknown engine or an invalid composition.
[[nodiscard]] search_method method_of(const search_choice& choice, const aabb::scene_traits& traits,
                                      std::shared_ptr<const aabb::collision_filter> filter = nullptr);

/// A drawing of one frame of meshes.
struct frame_drawing {
    std::uint32_t frame;
    hit_drawing& drawing;
};

struct frames_result {
    std::size_t objects = 0;
    std::uint64_t pairs = 0;         ///< overlapping boxes, summed over the frames, as are the next two
    std::uint64_t object_pairs = 0;  ///< objects in contact
    std::uint64_t contacts = 0;      ///< intersecting triangles; 0 for boxes
    kind_counts kinds{};             ///< the contacts by kind
    std::string digest;              ///< of contacts for meshes, of pairs for boxes
    double build_ms = 0;
    std::vector<double> ms;  ///< by frame

    [[nodiscard]] double mean_ms() const {
        return std::accumulate(ms.begin(), ms.end(), 0.0) / static_cast<double>(ms.size());
    }
};
/// Records in which frames objects are in contact, where, and how near they come before: for each pair of objects a row
/// per interval of frames in contact, with the frames without contact before it, and one for those after the last.
class contact_intervals {
public:
    static constexpr std::string_view columns =
        "object_a,object_b,nearest_frame,distance,error,first_frame,last_frame,triangle_a,triangle_b,x,y,z,point_error";

    /// @param named the strategies of the trees through which distances are measured
    /// @param filter which pairs of objects are followed; null for all
    /// @param scene,rows must outlive this object
    /// @throws aabb::input_error if there are too many pairs of objects
    contact_intervals(const scene_frames& scene, const aabb::named_strategies& named,
                      const aabb::collision_filter* filter, number_table& rows);
    ~contact_intervals();

    /// Adds the scene's current frame.
    /// @param contacts sorted; other objects are not in contact
    void add(std::uint32_t frame, std::span<const aabb::contact> contacts);
    /// Writes and commits the rows, once.
    void write();

private:
    struct state;
    std::unique_ptr<state> state_;
};

/// What a search of frames fills besides its result; each may be null.
struct frame_outputs {
    number_table* rows = nullptr;            ///< receives frame and pair, or frame, objects and triangles; is committed
    frame_drawing* drawing = nullptr;        ///< receives the objects and contacts of one frame
    contact_intervals* intervals = nullptr;  ///< receives the contacts of every frame, and writes them
};
/// Searches every frame of a scene.
/// @throws defect if a result is found twice.
[[nodiscard]] frames_result search_frames(scene_frames& scene, search_method& method, const frame_outputs& to,
                                          const hit_choice& hits = {});

/// The scene with swept boxes: each is the box of an object in this frame and in the previous one, so that objects that
/// meet on a straight way between the two overlap.
[[nodiscard]] std::unique_ptr<aabb::box_scene> swept(std::unique_ptr<aabb::box_scene> scene);

/// The pairs of triangles that a query of one mesh with itself reports.
enum class self_pairs {
    intersecting,  ///< those with more in common than shared corners and the edge between two
    all,           ///< those that share a point; those that share a vertex are counted separately
    no_adjacent    ///< those that share a point but no vertex
};

/// A query of two meshes, or of one mesh with itself.
struct mesh_query {
    query_kind ask = query_kind::pairs;
    std::optional<self_pairs> self = {};
    hit_choice hits = {};
    bool relations = false;    ///< whether to find how components lie that share points, too
    bool by_pose = false;      ///< whether rows include the pose
    std::size_t repeats = 1;   ///< each runs all poses
    std::string between = {};  ///< "a.off against b.off", for messages
    /// Receives the reported pairs of a pose in order, perhaps in parts; may be empty.
    std::function<void(std::uint32_t pose, std::span<const aabb::index_pair> pairs)> take = {};
};

struct intersecting_pair {
    aabb::index_pair triangles;
    std::optional<aabb::triangle_intersection> common;  ///< if the query asks for it
};

/// The surface of a mesh, as far as it matters for what lies inside it.
struct surface_summary {
    std::uint32_t components = 0;
    std::vector<std::uint32_t> open, unoriented, inward;               ///< components; those of the second are closed
    std::uint64_t open_edges = 0;                                      ///< edges of an odd number of triangles
    std::optional<std::vector<std::uint32_t>> self_intersecting = {};  ///< components, if a relation depended on it
};

/// How two meshes lie at a pose.
struct mesh_relation {
    std::optional<aabb::solid_relation> solids;            ///< if no triangles intersect
    std::vector<aabb::index_pair> a_inside_b, b_inside_a;  ///< components (of A, of B) that share no point
    std::vector<aabb::component_contact> contacts;         ///< components that share a point, if asked
};

/// Decides how two meshes lie: where no triangles intersect, by one ray per component. If their boxes overlap at any
/// pose, trees and components are prepared once.
class relation_search {
public:
    /// @param a,b must outlive this object
    relation_search(const aabb::mesh& a, const aabb::mesh& b);
    ~relation_search();

    /// At poses at which no triangles intersect.
    [[nodiscard]] mesh_relation at(const aabb::pose& pose_a, const aabb::pose& pose_b);
    /// @param hits all pairs of intersecting triangles
    [[nodiscard]] mesh_relation at(const aabb::pose& pose_a, const aabb::pose& pose_b,
                                   std::span<const aabb::index_pair> hits);
    /// Of A and B; empty if every pose was decided by the boxes.
    [[nodiscard]] std::vector<surface_summary> surfaces() const;
    /// The time of all decisions.
    [[nodiscard]] double ms() const;

private:
    struct state;
    std::unique_ptr<state> state_;
};

struct mesh_result {
    search_method method;                     ///< the method that searched
    std::vector<std::uint32_t> triangles;     ///< their number, by mesh
    std::vector<std::uint64_t> counts;        ///< by pose; of `self_pairs::all`, those without a common vertex
    std::vector<kind_counts> kinds;           ///< by pose: `counts` by kind; empty if pairs are only counted
    std::optional<std::uint64_t> neighbours;  ///< within one mesh, pairs that share a vertex and are not in `counts`
    std::optional<std::uint64_t>
        degenerate;  ///< within one mesh, unless any one pair is asked for: triangles without area
    std::vector<std::optional<intersecting_pair>> first;  ///< by pose, if the query asks for any one pair
    std::optional<std::string> digest;                    ///< of all reported pairs; empty if they are only counted
    double build_ms = 0;
    std::vector<double> query_ms;  ///< by pose, for each repeat
    std::vector<aabb::part_bytes> bytes;
    std::optional<double> bytes_per_triangle;  ///< of the trees; empty for an engine that does not report it
    /// By pose, of an exact method on two meshes: how they lie if no triangles intersect, or if the query asks.
    std::vector<std::optional<mesh_relation>> relations;
    std::vector<surface_summary> surfaces;  ///< of A and B if a relation needed them, else empty
    double relation_ms = 0;
};
/// Sentences about how the meshes lie, and about surfaces that are not closed, face inward or intersect themselves.
[[nodiscard]] std::vector<std::string> sentences_about_relations(const mesh_result& result);
/// Both meshes are always candidates: world boxes lose their precision if the meshes are moved far away together.
/// Results of repeats are not reported again.
/// @param meshes one or two
/// @param poses_b one or more poses of the second mesh
/// @param rows receives triangles, preceded by the pose or followed by the number of shared vertices; may be null
/// @param drawing receives the meshes and pairs of the first pose; may be null
/// @throws aabb::input_error if a pose cannot be searched, defect if a pair is found twice or missed.
[[nodiscard]] mesh_result search_meshes(const mesh_query& query, const search_choice& choice,
                                        std::vector<aabb::mesh> meshes, const aabb::pose& pose_a, given_poses poses_b,
                                        number_table* rows, hit_drawing* drawing = nullptr);

/// The distances of two meshes, by pose of the second.
struct distances_result {
    std::string method;
    std::vector<std::uint32_t> triangles;  ///< their number, by mesh
    std::vector<aabb::mesh_distance> distances;
    double build_ms = 0;
    std::vector<double> query_ms;
};
/// @throws aabb::input_error as `aabb::distance_stage`
[[nodiscard]] distances_result measure_distances(const search_choice& choice, const std::vector<aabb::mesh>& meshes,
                                                 const aabb::pose& pose_a, const given_poses& poses_b);

}  // namespace aabblab
