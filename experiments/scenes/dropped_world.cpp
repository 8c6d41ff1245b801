module;
#include <Eigen/Core>

module aabblab.scenes;

import aabblab.stepping;
import :boxes;
import :posed_meshes;

namespace aabblab {

namespace {

constexpr double gravity = 9.81;

/// The law of contact of balls of 1 kg with this extent: at rest, a ball sinks into the floor to `c.depth`, in extents.
/// The damping is `c.loss` times the critical one. A sphere of radius R at depth δ in a plane shares a volume of πRδ²
/// with it, so a pressure p acts like a spring of stiffness 2πRp.
contact_law law_of(const dropped_config& c, double extent) {
    const double spring = gravity / (c.depth * extent);      // N/m
    const double circumference = std::numbers::pi * extent;  // 2πR
    return {.geometry = contact_geometry::shared_volume,
            .stiffness = spring / circumference,
            .damping = 2 * c.loss * std::sqrt(spring) / circumference};
}

}  // namespace

/// A fixed floor, and balls above it in a cubic lattice, each shifted at random so that the lattice does not stay
/// balanced when it lands, with random rotations.
stepped_world dropped_world(const dropped_config& c, std::vector<aabb::mesh> meshes, std::uint64_t seed) {
    constexpr double cell = 1.05;           // edge of a lattice cell, in extents of the ball
    constexpr double perturbation = 0.005;  // greatest shift of a ball on each axis, in extents
    stepped_world world;
    world.meshes = std::move(meshes);
    world.gravity = gravity;
    world.bodies = {{}};  // body 0 is the fixed floor, with mesh 0
    const aabb::mesh& ball = world.meshes[1];
    const double extent = longest_extent(ball);
    world.law = law_of(c, extent);
    const std::uint32_t side = lattice_side(c.balls);
    // The lattice is centred above the floor's centre, the origin.
    const double half_width = extent * cell * (side - 1) / 2;
    const Eigen::Vector3d first_centre = {-half_width, -half_width, extent * (c.height + 0.5)};
    random_source random(seed);
    for (std::uint32_t i = 0; i < c.balls; ++i) {
        const Eigen::Vector3d shift = {random.signed_unit(), random.signed_unit(), random.signed_unit()};
        // Reversed, the coordinates of a cell fill the lattice layer by layer, from the lowest.
        const Eigen::Vector3d centre =
            (lattice_cell(i, side).reverse() * cell + shift * perturbation) * extent + first_centre;
        const aabb::pose p = placed(centre_of(ball), random_rotation(random), centre);
        world.bodies.push_back(
            {.mesh = 1, .position = p.translation, .velocity = {0, 0, -c.speed}, .mass = 1, .rotation = p.rotation});
    }
    return world;
}

}  // namespace aabblab
