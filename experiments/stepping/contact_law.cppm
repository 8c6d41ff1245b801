export module aabblab.stepping:contact_law;

import aabb.geometry;
import aabb.std;

export namespace aabblab {

/// The geometry of a contact force, computed only from the detected pairs of triangles, so that forces depend on the
/// quality of detection. A false positive may add a vertex with a spring, but no segment of an intersection curve.
enum class contact_geometry : std::uint8_t {
    /// One linear spring and dashpot for two bodies (Cundall and Strack 1979), at the deepest vertex of the second
    /// body's triangles below the intersected triangle of the first, along its normal.
    deepest_vertex,
    /// Likewise for each such vertex of the second body; springs begin `rest` above the plane and share the load.
    each_vertex,
    /// A pressure on the surface of the second body inside the first. By Stokes' theorem the integrals of its normal n
    /// and of r × n are ½ ∮ r × dr and -½ ∮ |r|² dr along the intersection curve, to which every pair of triangles
    /// contributes a segment: force and torque are the negative gradient of stiffness times the shared volume.
    shared_volume
};

/// Coulomb's friction is regularised: μ N u/v_s against a slip velocity u below the slip speed v_s, and μ N above it
/// (as in Castro et al. 2019, arXiv 1909.05700, with a linear law). It creeps: a body on an incline of angle θ slides
/// with v_s tan θ/μ. Explicit integrators need steps below 2 m v_s/(μ N).
struct contact_law {
    contact_geometry geometry = contact_geometry::deepest_vertex;
    double stiffness = 0;   ///< N/m; for a shared volume a pressure, N/m²
    double damping = 0;     ///< N s/m; for a shared volume N s/m³
    double rest = 0;        ///< compression of a spring whose vertex just touches the plane, m
    bool may_pull = true;   ///< whether a dashpot may pull bodies together while they separate
    double friction = 0;    ///< μ
    double slip_speed = 0;  ///< v_s, m/s; positive if there is friction
};

/// Linear velocity of a body's origin, m/s, and angular velocity, rad/s, in the world's axes.
struct rigid_motion {
    aabb::vec3d velocity = {0, 0, 0};
    aabb::vec3d angular_velocity = {0, 0, 0};
};

/// A mesh with its pose, which maps a vertex x to R x + t, and its motion.
struct placed_mesh {
    const aabb::mesh* mesh;
    aabb::pose pose;
    rigid_motion motion = {};
    /// The detected mesh stands, if this is positive, for a ball of this radius about its origin, m.
    double radius = 0;

    /// The triangle in world coordinates, computed in double precision.
    [[nodiscard]] aabb::triangle3d triangle(std::uint32_t index) const;
};

struct contact_force {
    aabb::vec3d force = {0, 0, 0};   ///< on the second body, N; the first gets the opposite
    aabb::vec3d point = {0, 0, 0};   ///< at which it acts, m
    aabb::vec3d moment = {0, 0, 0};  ///< about this point, on the second body, N m
    double energy = 0;               ///< of springs, J; 0 for a shared volume, whose energy needs `overlap_volume`
};

/// The force of all contacts of two bodies. A ball has one spring, at its deepest point below a triangle's plane of the
/// first body, or on the line through the centres of two balls, whatever the geometry of the law.
/// @param contacts of these two bodies, sorted
/// @throws aabb::input_error if the first body is a ball and the second is not
[[nodiscard]] contact_force force_of(const contact_law& law, std::span<const aabb::contact> contacts,
                                     const placed_mesh& first, const placed_mesh& second);

/// The volume shared by two convex meshes with outward normals, m³. A floor is all space below its first triangle.
/// @param is_floor whether the first mesh is a floor
[[nodiscard]] double overlap_volume(const placed_mesh& first, bool is_floor, const placed_mesh& second);

}  // namespace aabblab
