/// The exact answers on a scene, by definition.
export module aabb.extreme:exact_frames;

import aabb.geometry;
import aabb.pipeline;
import aabb.std;
import :scene;

export namespace aabb {

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

}  // namespace aabb
