/// The exact answer on a scene, and why another may differ from it. No header of CGAL reaches an importer.
export module aabb.truth;

import aabb.pipeline;
import aabb.std;

export namespace aabb {

/// What a reported set and the exact one do not have in common, both sorted, the exact one with each once.
template <class T>
struct set_difference {
    set_difference(const std::vector<T>& exact, const std::vector<T>& found) {
        std::ranges::set_difference(exact, found, std::back_inserter(missing));
        std::ranges::set_difference(found, exact, std::back_inserter(invented));
        repeated = !invented.empty() && std::ranges::binary_search(exact, invented[0]);
    }

    std::vector<T> missing;
    std::vector<T> invented;  ///< what is reported again, too
    bool repeated = false;    ///< the first of these is such a one
};

/// Why an engine's answer on two triangles may differ from the exact one; the first that applies.
enum class difference_class : std::uint8_t {
    degenerate,     ///< one of the triangles has zero area
    pose_rounding,  ///< with the raw pose, before vertices are rounded to float, the exact answer is the engine's
    coplanar,       ///< the triangles lie in one plane
    touching,       ///< they share points, but neither passes through the other; an engine can only miss such a pair
    near,           ///< moving one by a millionth of the pair's extent changes the exact answer
    other,          ///< the engine is wrong for no such reason
};
inline constexpr std::array<std::string_view, 6> difference_class_names = {"degenerate", "pose_rounding", "coplanar",
                                                                           "touching",   "near",          "other"};

/// Pairs that an engine missed or invented, by class.
struct differences {
    std::array<std::size_t, difference_class_names.size()> missing{};
    std::array<std::size_t, difference_class_names.size()> invented{};

    differences& operator+=(const differences& other);
};

/// Compares the pair sets of triangles of two posed meshes. Both are sorted, each pair once.
[[nodiscard]] differences compare_triangle_pairs(std::span<const index_pair> exact, std::span<const index_pair> found,
                                                 const mesh& a, const pose& pose_a, const mesh& b, const pose& pose_b);

/// What a scene shows at one time.
struct scene_frame {
    std::span<const box> boxes;   ///< of the objects, in the world
    std::span<const pose> poses;  ///< of the objects; empty in a scene of boxes
    /// Objects of a scene of boxes that are in this frame and were not in the one before, and the other way round. A
    /// scene of meshes has all its objects all the time.
    std::span<const std::uint32_t> arrivals;
    std::span<const std::uint32_t> departures;
};

/// The exact pairs and contacts of a scene, frame by frame. Pairs of boxes: brute force up to 20,000 objects, CGAL
/// above. Contacts: CGAL's exact kernel on every two objects whose bounding spheres meet; the boxes of global search
/// have no part in them, so that a pair of objects that wrong boxes lose shows up as missing.
class exact_answer {
public:
    /// @param objects of the scene, absent ones included
    /// @param meshes  of the scene, which must outlive this; null for one of boxes
    exact_answer(std::size_t objects, const mesh_scene* meshes);

    /// Says what gives it: "brute_force for boxes, cgal on all pairs of objects for triangles".
    [[nodiscard]] std::string name() const;

    /// Goes to a frame, to which meshes that deform have been brought already.
    void play(const scene_frame& frame);

    /// Of the frame, sorted, each once.
    [[nodiscard]] const std::vector<index_pair>& pairs() const { return pairs_; }
    [[nodiscard]] const std::vector<contact>& contacts() const { return contacts_; }

private:
    struct sphere {
        vec3d centre;
        double radius;
    };
    [[nodiscard]] static sphere sphere_around(const mesh& m);
    void follow_meshes();
    /// Every two objects that can meet, and some that cannot.
    [[nodiscard]] std::vector<index_pair> near_objects(std::span<const pose> poses) const;

    const mesh_scene* meshes_;
    std::string box_engine_;
    std::unique_ptr<global_stage> boxes_;
    std::unique_ptr<local_stage> triangles_;  // null in a scene of boxes
    std::vector<sphere> spheres_;             // by mesh
    std::vector<index_pair> pairs_;
    std::vector<contact> contacts_;
};

}  // namespace aabb
