export module aabb.extreme:known_scenes;

import aabb.std;
import :scene;

export namespace aabb {

/// `small` has fewer coincident triangles, for tests and a first look; all else is the same.
enum class extreme_size : std::uint8_t { small, quick, full };

/// Every extreme scene that needs no file and no generator, the same on every machine; scenes of boxes first. Those in
/// which denormals are flushed are left out where that cannot be done.
[[nodiscard]] std::vector<extreme_scene> extreme_scenes(extreme_size size);

}  // namespace aabb

// What the list is made of.
namespace aabb {

[[nodiscard]] std::vector<extreme_scene> box_scenes();
[[nodiscard]] std::vector<extreme_scene> bad_box_scenes();
[[nodiscard]] std::vector<extreme_scene> mesh_scenes(extreme_size size);
/// Poses at the limit of what is refused, too.
[[nodiscard]] std::vector<extreme_scene> bad_mesh_scenes();
/// Those in which denormals are flushed are left out where that cannot be done.
[[nodiscard]] std::vector<extreme_scene> other_arithmetic_scenes();

}  // namespace aabb
