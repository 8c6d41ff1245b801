export module aabb.containment:parity_ray;

import aabb.geometry;
import aabb.std;

export namespace aabb {

/// What a ray and a triangle have in common.
enum class ray_crossing : std::uint8_t {
    none,       ///< nothing, or points of a triangle without area
    leaves,     ///< one point, inside the triangle, which the ray passes in the direction of its normal
    enters,     ///< the same, against the normal
    unclear,    ///< points of an edge, so that another ray is needed
    starts_on,  ///< the start of the ray
};

/// A ray from a vertex of one mesh at a pose through the surface of another, decided in real arithmetic. A point is
/// inside a closed surface if a ray from it crosses an odd number of triangles, none of them at an edge. The winding
/// number of an oriented surface around it is the number of triangles that the ray leaves less that of those it enters.
///
/// The ray passes a second point, the target, so that orientations of given points decide everything: its line crosses
/// a triangle if it passes all edges on one side. Attempt 0 aims along an axis; each further one at another point of a
/// grid of 2^32 by 2^32 points in a plane, around the target of attempt 0.
///
/// Some attempt succeeds. An edge makes a ray unclear only if its plane through the start contains the target; if the
/// start lies in the plane of a triangle, an edge of it that does not point to the start spans the same plane. Such a
/// plane cuts the plane of the grid, in which the start does not lie, in a line, with at most 2^32 grid points. A
/// closed surface has at most 3/2 edges per triangle, below 3 · 2^30 in all, so that some 2^62 grid points remain.
class parity_ray {
public:
    /// @param surface,bounds the other mesh, valid, and the box of its floats
    /// @param vertex where the ray starts, of a mesh at `pose_of_vertex`
    parity_ray(const mesh& surface, const pose& pose_of_surface, const box& bounds, const vec3d& vertex,
               const pose& pose_of_vertex)
        : surface_(&surface),
          pose_of_surface_(pose_of_surface),
          bounds_(bounds),
          vertex_(vertex),
          pose_of_vertex_(pose_of_vertex) {}

    /// Sets where the ray starts in the frame of the surface's floats. Without it, every triangle must be tested.
    /// @param error bounds that of `image` and of the surface's floats, on each axis
    void set_image(const vec3f& image, const vec3f& error);

    /// Whether the start certainly lies outside of the box of the surface.
    [[nodiscard]] bool starts_outside() const noexcept;

    /// Chooses the target.
    void aim(std::uint64_t attempt);
    /// Sets the target, for tests.
    /// @param target in the coordinates of the surface's vertices, not where the ray starts
    void aim_at(const vec3d& target);

    /// A box that overlaps that of the floats of each triangle which the ray meets before the target.
    [[nodiscard]] const box& reach() const noexcept { return reach_; }

    [[nodiscard]] ray_crossing crossing(std::uint32_t triangle) const noexcept;

private:
    [[nodiscard]] bool aim_beyond_box(std::uint64_t attempt);
    void aim_far_away(std::uint64_t attempt);
    [[nodiscard]] std::optional<ray_crossing> certain_crossing(std::uint32_t triangle) const noexcept;
    [[nodiscard]] ray_crossing exact_crossing(std::uint32_t triangle) const noexcept;

    const mesh* surface_;
    pose pose_of_surface_;
    box bounds_;
    vec3d vertex_;
    pose pose_of_vertex_;
    std::optional<vec3d> image_;  // of the start, in the frame of the surface's floats, as are the following
    vec3d image_error_{};
    vec3d target_{};  // in the coordinates of the surface's vertices
    vec3d image_of_target_{};
    vec3d error_{};            // of the images of both points, and of the corners
    bool is_bounded_ = false;  // whether the images are in range, and the ray leaves the box before the target
    box reach_{};
};

}  // namespace aabb
