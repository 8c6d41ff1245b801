export module aabblab.scenes:spacing;

import aabb.geometry;
import aabb.std;

export namespace aabblab {

/// The edge of the cube (square, segment) that each object would have for itself: (product of the world's sides on the
/// axes that are not flat / objects)^(1 / number of these axes). 0 without objects, or where every axis is flat.
/// @param sides of the world; 0 on a flat axis, one on which all boxes are alike
[[nodiscard]] double mean_spacing(const aabb::vec3d& sides, std::size_t objects);

}  // namespace aabblab
