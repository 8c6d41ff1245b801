/// Builds for layouts that prescribe how many triangles go to which side.
export module aabb.build.balanced;

import aabb.geometry;
import aabb.local_detection;
import aabb.std;

export namespace aabb {

/// Across which axis a node's triangles are split, in the order of their boxes' centres, where their numbers are
/// prescribed: the longest of the node's box, or that with the least sum of area times triangles on both sides (of a
/// sample, where they are many).
enum class axis_rule : std::uint8_t { longest, least_area };

/// The same order whatever the number of threads.
[[nodiscard]] balanced_order order_by_halves(const mesh& m, axis_rule rule, std::uint32_t threads);

}  // namespace aabb
