export module aabblab.stepping:contact_law;

import aabb.geometry;
import aabb.std;

export namespace aabblab {

/// How two bodies push each other, from nothing but the triangles that were found to intersect, so that forces hang on
/// what is found. A pair that was invented adds a vertex that springs reach, but no segment to a curve.
enum class contact_geometry : std::uint8_t {
    /// A linear spring and dashpot, which may pull too, on the depth of the deepest vertex of the second body's
    /// triangles below the plane of the first's that each intersects, along its normal. One force for two bodies.
    deepest_vertex,
    /// The same for each vertex of the second body, with springs that reach `rest` above the plane, and share a load.
    each_vertex,
    /// A pressure on the surface of the second body inside the first. By Stokes' theorem the integral of its normal is
    /// ½ ∮ r × dr around the curve where the meshes cross, of which every pair of triangles has a segment: the force is
    /// the negative gradient of stiffness times the volume that the two share.
    shared_volume
};

struct contact_law {
    contact_geometry geometry = contact_geometry::deepest_vertex;
    double stiffness = 0;  ///< N/m; of a shared volume a pressure, N/m²
    double damping = 0;    ///< N s/m; of a shared volume N s/m³
    double rest = 0;       ///< by which a spring is compressed when its vertex touches, m
};

/// A mesh where it is: vertex x at R x + t.
struct placed_mesh {
    const aabb::mesh* mesh;
    aabb::pose pose;

    /// In double, as it is written.
    [[nodiscard]] aabb::triangle3d triangle(std::uint32_t index) const;
};

struct contact_force {
    aabb::vec3d force = {0, 0, 0};  ///< on the second body, N; the first gets the opposite
    double energy = 0;              ///< in springs, J; 0 of a shared volume, which only `overlap_volume` knows
};

/// @param contacts of these two bodies, sorted
/// @param approach velocity of the second relative to the first, m/s
[[nodiscard]] contact_force force_of(const contact_law& law, std::span<const aabb::contact> contacts,
                                     const placed_mesh& first, const placed_mesh& second, const aabb::vec3d& approach);

/// The volume that two convex meshes share, m³; outward normals. A floor counts as all below its first triangle.
/// @param is_floor the first is one
[[nodiscard]] double overlap_volume(const placed_mesh& first, bool is_floor, const placed_mesh& second);

}  // namespace aabblab
