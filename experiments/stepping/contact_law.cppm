export module aabblab.stepping:contact_law;

import aabb.geometry;
import aabb.std;

export namespace aabblab {

/// The geometry of a contact force, computed only from the detected pairs of triangles, so that forces depend on the
/// quality of detection. A false positive may add a vertex with a spring, but no segment of an intersection curve.
enum class contact_geometry : std::uint8_t {
    /// One linear spring and dashpot for two bodies (Cundall and Strack 1979), which may also pull, at the deepest
    /// vertex of the second body's triangles below the intersected triangle of the first, along its normal.
    deepest_vertex,
    /// Likewise for each such vertex of the second body; springs begin `rest` above the plane and share the load.
    each_vertex,
    /// A pressure on the surface of the second body inside the first. By Stokes' theorem the integral of its normal is
    /// ½ ∮ r × dr along the intersection curve, to which every pair of triangles contributes a segment: the force is
    /// the negative gradient of stiffness times the shared volume.
    shared_volume
};

struct contact_law {
    contact_geometry geometry = contact_geometry::deepest_vertex;
    double stiffness = 0;  ///< N/m; for a shared volume a pressure, N/m²
    double damping = 0;    ///< N s/m; for a shared volume N s/m³
    double rest = 0;       ///< compression of a spring whose vertex just touches the plane, m
};

/// A mesh with its pose, which maps a vertex x to R x + t.
struct placed_mesh {
    const aabb::mesh* mesh;
    aabb::pose pose;

    /// The triangle in world coordinates, computed in double precision.
    [[nodiscard]] aabb::triangle3d triangle(std::uint32_t index) const;
};

struct contact_force {
    aabb::vec3d force = {0, 0, 0};  ///< on the second body, N; the first gets the opposite
    double energy = 0;              ///< of springs, J; 0 for a shared volume, whose energy needs `overlap_volume`
};

/// @param contacts of these two bodies, sorted
/// @param approach velocity of the second body relative to the first, m/s
[[nodiscard]] contact_force force_of(const contact_law& law, std::span<const aabb::contact> contacts,
                                     const placed_mesh& first, const placed_mesh& second, const aabb::vec3d& approach);

/// The volume shared by two convex meshes with outward normals, m³. A floor is all space below its first triangle.
/// @param is_floor whether the first mesh is a floor
[[nodiscard]] double overlap_volume(const placed_mesh& first, bool is_floor, const placed_mesh& second);

}  // namespace aabblab
