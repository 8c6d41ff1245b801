/// Stages that find what is nearer than a given distance, composed by name.
export module aabb.distance_stages;

export import aabb.distance_stage;
export import aabb.registry;
import aabb.collision_filter;
import aabb.pipeline;
import aabb.std;

export namespace aabb {

/// A narrow phase of the composition's build and tree whose pairs are the triangles at a distance of at most d, decided
/// exactly (`within_detection`). The composition's triangle test is not used.
/// @param d finite and not negative
/// @throws input_error on another d, and on an unknown build or tree
[[nodiscard]] std::unique_ptr<local_stage> compose_within(const composition& c, double d,
                                                          instrumentation counted = instrumentation::none);

/// Both stages of a composition, for the triangles of objects at a distance of at most d: a broad phase of grown boxes
/// (`grown_stage`) and the narrow phase of `compose_within`.
struct near_stages {
    std::unique_ptr<global_stage> global;
    std::unique_ptr<local_stage> local;
};
/// @param filter which pairs of objects are searched, or null for all; must outlive the stages
/// @throws input_error as `compose_within`, and on an invalid composition
[[nodiscard]] near_stages compose_near(const composition& c, double d, const collision_filter* filter = nullptr,
                                       instrumentation counted = instrumentation::none);

/// A `distance_detection` that measures distances of meshes through trees of the composition's build and tree.
/// @throws input_error on an unknown build or tree
[[nodiscard]] std::unique_ptr<distance_stage> compose_distance(const composition& c,
                                                               instrumentation counted = instrumentation::none);

}  // namespace aabb
