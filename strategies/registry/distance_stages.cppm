/// Stages that find what is nearer than a given distance, composed by name.
export module aabb.distance_stages;

export import aabb.distance_stage;
export import aabb.registry;
import aabb.pipeline;
import aabb.std;

export namespace aabb {

/// A narrow phase of the composition's build and tree whose pairs are the triangles at a distance of at most d, decided
/// exactly (`within_detection`). The composition's triangle test is not used.
/// @param d finite and not negative
/// @throws input_error on another d, and on an unknown build or tree
[[nodiscard]] std::unique_ptr<local_stage> compose_within(const composition& c, double d,
                                                          instrumentation counted = instrumentation::none);

/// A `distance_detection` that measures distances of meshes through trees of the composition's build and tree.
/// @throws input_error on an unknown build or tree
[[nodiscard]] std::unique_ptr<distance_stage> compose_distance(const composition& c,
                                                               instrumentation counted = instrumentation::none);

}  // namespace aabb
