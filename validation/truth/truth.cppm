/// The ground truth of a scene, and the classification of differences from it. CGAL's headers stay internal.
export module aabb.truth;

import aabb.collision_filter;
import aabb.pipeline;
import aabb.std;

export namespace aabb {

/// The differences between a reported set and the ground truth; both are sorted, the latter without repetitions.
template <class T>
struct set_difference {
    set_difference(const std::vector<T>& exact, const std::vector<T>& reported) {
        std::ranges::set_difference(exact, reported, std::back_inserter(false_negatives));
        std::ranges::set_difference(reported, exact, std::back_inserter(false_positives));
        repeated = !false_positives.empty() && std::ranges::binary_search(exact, false_positives[0]);
    }

    std::vector<T> false_negatives;
    std::vector<T> false_positives;  ///< false positives and repetitions
    bool repeated = false;           ///< whether the first of `false_positives` is a repetition
};

/// Why an engine's result for two triangles differs from the ground truth; the first class that applies.
enum class difference_class : std::uint8_t {
    degenerate,     ///< one of the triangles has zero area
    pose_rounding,  ///< the engine is right for vertices rounded to float in the other mesh's frame
    coplanar,       ///< the triangles are coplanar
    touching,       ///< they touch without crossing; only false negatives
    near,           ///< a displacement of a millionth of the pair's extent changes the ground truth
    other,          ///< the engine is wrong for another reason
};
inline constexpr std::array<std::string_view, 6> difference_class_names = {"degenerate", "pose_rounding", "coplanar",
                                                                           "touching",   "near",          "other"};

/// False negatives and false positives of an engine, by class.
struct differences {
    std::array<std::size_t, difference_class_names.size()> false_negatives{};
    std::array<std::size_t, difference_class_names.size()> false_positives{};

    differences& operator+=(const differences& other);
};

/// Compares two sets of pairs of triangles of two posed meshes. Both are sorted, without repetitions.
[[nodiscard]] differences compare_triangle_pairs(std::span<const index_pair> exact,
                                                 std::span<const index_pair> reported, const mesh& a,
                                                 const pose& pose_a, const mesh& b, const pose& pose_b);

/// Do two triangles of meshes at poses share a point? By two judges that share no code: CGAL's exact kernel, and
/// separating axes in integers.
/// @throws std::logic_error if they disagree
[[nodiscard]] bool judge_intersection(const pose_pair& poses, const triangle3d& s, const triangle3d& t);

struct scene_frame {
    std::span<const box> boxes;   ///< of the objects, in world coordinates
    std::span<const pose> poses;  ///< of the objects; empty in a scene of boxes
    /// Objects of a scene of boxes that are new in this frame, and those that left since the previous one. In a scene
    /// of meshes all objects are always present.
    std::span<const std::uint32_t> arrivals;
    std::span<const std::uint32_t> departures;
    std::span<const boxd> boxes_in_double = {};  ///< `boxes` as given, if in double; all objects are present
};

/// The ground truth of a scene, frame by frame. Pairs of boxes: brute force up to 20,000 objects, CGAL above. Contacts:
/// CGAL's exact kernel on all objects with overlapping bounding spheres. They do not depend on the boxes of the broad
/// phase, so that a pair of objects that is lost by wrong boxes shows up as a false negative.
class ground_truth {
public:
    /// @param objects the number of objects, including absent ones
    /// @param meshes  the scene, which must outlive this; null for a scene of boxes
    /// @param filter  leaves out pairs of objects; must outlive this; null if all count
    ground_truth(std::size_t objects, const mesh_scene* meshes, const collision_filter* filter = nullptr);

    /// Names the methods: "brute_force for boxes, cgal on all pairs of objects for triangles".
    [[nodiscard]] std::string name() const;

    /// Computes a frame; deforming meshes must be up to date.
    void compute(const scene_frame& frame);

    /// The overlapping pairs of the frame, sorted, without repetitions.
    [[nodiscard]] const std::vector<index_pair>& pairs() const { return pairs_; }
    [[nodiscard]] const std::vector<contact>& contacts() const { return contacts_; }

private:
    struct sphere {
        vec3d centre;
        double radius;
    };
    [[nodiscard]] static sphere sphere_around(const mesh& m);
    void update_deformed_meshes();
    [[nodiscard]] std::vector<index_pair> overlapping_spheres(std::span<const pose> poses) const;

    const mesh_scene* meshes_;
    const collision_filter* filter_;
    std::string box_engine_;
    std::unique_ptr<global_stage> boxes_;
    std::unique_ptr<local_stage> triangles_;  // null in a scene of boxes
    std::vector<sphere> spheres_;             // by mesh
    std::vector<index_pair> pairs_;
    std::vector<contact> contacts_;
};

}  // namespace aabb
