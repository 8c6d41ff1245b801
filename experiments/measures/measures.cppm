/// What a scene is like: numbers that decide which composition serves it.
export module aabblab.measures;

import aabb.geometry;
import aabb.std;
import aabblab.trials;
import aabblab.scenes;
import aabblab.tables;

export namespace aabblab {

/// Of the boxes of one frame.
struct box_measures {
    double typical_extent = 0;  ///< mean over the axes, and the boxes that are not by far longer than others
    /// The longest edge of any box over the median of the boxes' longest edges; empty where that is 0 or of no box.
    std::optional<double> size_ratio;
    std::array<double, 3> overlaps{};  ///< by axis: of how many others a box overlaps the projection, a mean
    double expected_pairs = 0;         ///< if boxes of the mean extents lay evenly spread over the bounds of all
};
[[nodiscard]] box_measures measure_boxes(std::span<const aabb::box> boxes);

/// Of the same boxes in two frames, one after the other.
struct motion_measures {
    double displacement = 0;  ///< mean way of a box's centre
    double relative = 0;      ///< greatest way of any box, on any axis, beyond what all move alike
    double at_rest = 1;       ///< share of boxes that are equal
    double inversions = 0;    ///< an object, on the axis on which boxes overlap least
};
/// @param axis on which inversions are counted
[[nodiscard]] motion_measures measure_motion(std::span<const aabb::box> before, std::span<const aabb::box> after,
                                             std::size_t axis);

/// Of a scene: means over its first frames.
struct scene_measures {
    std::size_t objects = 0;
    std::size_t frames = 0;
    std::size_t present = 0;                ///< objects that are there in frame 0
    std::optional<std::size_t> triangles;   ///< of all meshes; empty in scenes of boxes
    box_measures boxes;                     ///< of frame 0
    double pairs_an_object = 0;             ///< of boxes that overlap, in frame 0
    double clustering = 0;                  ///< pairs of frame 0 over those expected
    std::optional<motion_measures> motion;  ///< empty where there is one frame
    double turnover = 0;                    ///< share of the objects that come or go in a frame
};

/// Plays the first frames of the scene.
/// @throws aabb::input_error where the scene cannot be made or played.
[[nodiscard]] scene_measures measure_scene(const scene_choice& scene);
/// The same of a scene that is made already, from its first frame on.
[[nodiscard]] scene_measures measure_scene(scene_play& scene);

/// As it is printed: "displacement", "0.031 of a mean extent a frame".
[[nodiscard]] table told(const scene_measures& m);

/// "brownian (objects=1000, …)"
[[nodiscard]] std::string heading_of(const scene_choice& scene);

}  // namespace aabblab
