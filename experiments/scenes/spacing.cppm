export module aabblab.scenes:spacing;

import aabb.geometry;
import aabb.std;

export namespace aabblab {

/// The mean spacing: the edge of a cube (square, segment) with an equal share of the world for each object, over the
/// axes that are not flat. 0 without objects, or if every axis is flat.
/// @param sides of the world; 0 on a flat axis, on which all boxes are equal
[[nodiscard]] double mean_spacing(const aabb::vec3d& sides, std::size_t objects);

}  // namespace aabblab
