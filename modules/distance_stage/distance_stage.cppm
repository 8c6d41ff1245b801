/// The run-time interface of what measures distances of meshes.
export module aabb.distance_stage;

import aabb.counters;
import aabb.geometry;
import aabb.std;

export namespace aabb {

/// The distance of two meshes as surfaces, and points at which it is attained.
struct mesh_distance {
    double distance = 0;         ///< 0 exactly if triangles intersect
    double error = 0;            ///< bounds the error of the distance
    index_pair triangles{};      ///< a of A and b of B; of several at this distance, any
    vec3d point_a{}, point_b{};  ///< of these triangles, in the world
    double point_error = 0;      ///< of the points: from their triangles, and of the distance between them
};

/// Measures distances of meshes, which are its models, numbered from 0.
class distance_stage : public kept_in_place {
public:
    /// Builds the tree of a mesh, which must outlive the stage.
    /// @throws input_error on a mesh that `require_valid` rejects
    virtual std::uint32_t add_model(const mesh& m) = 0;
    /// @param pose_a,pose_b of full rank
    /// @throws input_error as `require_ieee_arithmetic`, and if the distance or its points exceed the range of double
    [[nodiscard]] virtual mesh_distance distance(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                                 const pose& pose_b) = 0;
    /// The same if the distance is certainly less than `most`, which takes less time; else nothing.
    [[nodiscard]] virtual std::optional<mesh_distance> distance_below(std::uint32_t model_a, const pose& pose_a,
                                                                      std::uint32_t model_b, const pose& pose_b,
                                                                      double most) = 0;
    [[nodiscard]] virtual work_counters counters() const = 0;
};

}  // namespace aabb
