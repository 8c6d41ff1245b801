export module aabb.truth:exact_answer;

import aabb.geometry;
import aabb.pipeline;
import aabb.std;

export namespace aabb {

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
