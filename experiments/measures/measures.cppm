/// Measures of a scene that decide which composition is fast.
export module aabblab.measures;

import aabb.geometry;
import aabb.std;
import aabblab.trials;
import aabblab.scenes;
import aabblab.tables;

export namespace aabblab {

struct box_measures {
    double typical_extent = 0;  ///< mean over axes and boxes, without boxes far longer than the others
    /// The longest edge of any box over the median of the longest edges; empty if that is 0 or there are no boxes.
    std::optional<double> size_ratio;
    std::array<double, 3> overlaps{};  ///< by axis: the mean number of other boxes whose projection a box overlaps
    double expected_pairs = 0;         ///< of boxes with the mean extents, uniformly spread over the bounds
};
[[nodiscard]] box_measures measure_boxes(std::span<const aabb::box> boxes);

/// Measures of the motion of the same boxes between two consecutive frames.
struct motion_measures {
    double displacement = 0;           ///< mean displacement of the centres
    double relative_displacement = 0;  ///< largest displacement along any axis, minus the common motion
    double at_rest = 1;                ///< share of unchanged boxes
    double inversions = 0;             ///< per object, along the axis of least overlap
};
/// @param axis along which inversions are counted
[[nodiscard]] motion_measures measure_motion(std::span<const aabb::box> before, std::span<const aabb::box> after,
                                             std::size_t axis);

/// Measures of a scene; motion is the mean over its first frames.
struct scene_measures {
    std::size_t objects = 0, frames = 0;
    std::size_t present = 0;                ///< objects in frame 0
    std::optional<std::size_t> triangles;   ///< of all meshes; empty for boxes
    box_measures boxes;                     ///< of frame 0
    double pairs_per_object = 0;            ///< overlapping pairs per object in frame 0
    double clustering = 0;                  ///< pairs of frame 0 over `expected_pairs`
    std::optional<double> kept;             ///< share of these pairs that the scene's filter keeps; empty without one
    std::optional<motion_measures> motion;  ///< empty for a single frame
    double turnover = 0;                    ///< share of the objects that appear or disappear per frame
};

/// Measures the first frames of the scene.
/// @throws aabb::input_error if the scene cannot be created or run.
[[nodiscard]] scene_measures measure_scene(const scene_choice& scene);
/// Measures a scene that exists already and is at its first frame.
[[nodiscard]] scene_measures measure_scene(scene_frames& scene);

/// The rows that are printed: "displacement", "0.031 typical extents per frame, the mean".
[[nodiscard]] table measures_table(const scene_measures& m);

/// "brownian (objects=1000, …)"
[[nodiscard]] std::string heading_of(const scene_choice& scene);

}  // namespace aabblab
