/// Meshes whose contacts have closed forms.
module aabblab.stiff:shapes;

import aabb.geometry;
import aabb.std;

namespace aabblab {

/// Eight triangles on the lowest of their six vertices, which is the origin: depths below a floor have all their
/// digits.
[[nodiscard]] aabb::mesh octahedron(float radius);
/// A square in z = 0 around the origin, facing up, cut into n × n squares of two triangles.
[[nodiscard]] aabb::mesh floor_of(double side, std::uint32_t n = 1);
/// A pyramid on its apex, which is the origin, with a square top that faces up.
[[nodiscard]] aabb::mesh hanging_pyramid(float height, float side);
/// A box around the origin.
[[nodiscard]] aabb::mesh slab(float side, float thickness);

}  // namespace aabblab
