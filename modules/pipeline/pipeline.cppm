export module aabb.pipeline;

export import aabb.global_search;
export import aabb.local_detection;
import aabb.std;

export import :basic_pipeline;
export import :detector;
export import :detector_in_double;
export import :mesh_detection;
export import :scene;
export import :scene_parts;
export import :searched_by;
export import :stage;
export import :tested_by;

export namespace aabb {

/// The pipeline of stages that are chosen at run time.
using pipeline = basic_pipeline<global_stage, local_stage>;

}  // namespace aabb
