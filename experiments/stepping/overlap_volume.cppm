export module aabblab.stepping:overlap_volume;

import :contact_law;

export namespace aabblab {

/// The volume that two convex meshes share, m³; outward normals. A mesh without inside, as a floor, counts as all that
/// lies below its first triangle's plane.
/// @param is_floor the first is one
[[nodiscard]] double overlap_volume(const placed_mesh& first, bool is_floor, const placed_mesh& second);

}  // namespace aabblab
