module;
#include <Eigen/Core>

module aabblab.scenes;

import aabblab.stepping;
import :boxes;
import :posed_meshes;

namespace aabblab {

/// A floor, which rests, and balls above it in a lattice that random shifts let collapse. The law of contact makes a
/// ball that rests on the floor sink to the depth of the configuration, and damps it in proportion to critical damping.
stepped_world dropped_world(const dropped_config& c, std::vector<aabb::mesh> meshes, std::uint64_t seed) {
    constexpr double gravity = 9.81;
    constexpr double gap = 1.05;  // of the lattice, in extents, as is the next
    constexpr double perturbation = 0.005;
    stepped_world world;
    world.meshes = std::move(meshes);
    world.gravity = gravity;
    world.bodies = {{}};
    const aabb::mesh& ball = world.meshes[1];
    const double extent = longest_extent(ball);
    // A sphere at depth δ in a plane shares a volume of πRδ² with it, so a pressure p acts like a spring of 2πRp.
    const double spring = gravity / (c.depth * extent);  // for 1 kg
    const double girth = std::numbers::pi * extent;      // 2πR
    world.law = {.geometry = contact_geometry::shared_volume,
                 .stiffness = spring / girth,
                 .damping = 2 * c.loss * std::sqrt(spring) / girth};
    const std::uint32_t side = lattice_side(c.balls);
    // The lattice is centred on the floor.
    const double half_width = extent * gap * (side - 1) / 2;
    const Eigen::Vector3d first = {-half_width, -half_width, extent * (c.height + 0.5)};
    random_source random(seed);
    for (std::uint32_t i = 0; i < c.balls; ++i) {
        const Eigen::Vector3d offset = {random.signed_unit(), random.signed_unit(), random.signed_unit()};
        const Eigen::Vector3d place = (lattice_cell(i, side).reverse() * gap + offset * perturbation) * extent + first;
        const aabb::pose p = placed(centre_of(ball), random_rotation(random), place);
        world.bodies.push_back(
            {.mesh = 1, .position = p.translation, .velocity = {0, 0, -c.speed}, .mass = 1, .rotation = p.rotation});
    }
    return world;
}

}  // namespace aabblab
