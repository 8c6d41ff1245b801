module;
#include <cmath>

module aabblab.stiff;

import :incline;
import :rules;
import :simulation;

namespace aabblab {

namespace {

constexpr std::size_t blocks = 5;
constexpr double edge = 0.25;          // height of a block, m
constexpr double stiffness = 1e7;      // k of each of four springs, N/m
constexpr double narrowing = 0.01;     // of the side from a block to the next one, m
constexpr double eccentricity = 0.02;  // of the second block, m

/// The side of a block, m. The lowest one is wide enough for the others, which stand off its centre.
double side_of(std::size_t block) {
    return block == 1 ? 0.3 : edge - narrowing * static_cast<double>(block - 2);
}

/// Blocks of masses in geometric progression, from 1 kg at the bottom to `ratio` kg at the top, that stand on their
/// four lower vertices on the one below. Each is narrower than that, so that its vertices meet the upper face. The
/// blocks above the lowest stand off its centre, so that the stack tilts.
stepped_world stack_of_blocks(double ratio) {
    stepped_world world;
    world.meshes = {floor_of(4)};
    world.bodies = {{}};
    double total_mass = 0;
    for (std::size_t b = 1; b <= blocks; ++b) {
        const aabb::vec3d sides = {side_of(b), side_of(b), edge};
        const double mass = std::pow(ratio, static_cast<double>(b - 1) / (blocks - 1));
        total_mass += mass;
        world.meshes.push_back(cuboid(sides));
        world.bodies.push_back(
            {.mesh = static_cast<std::uint32_t>(b),
             .position = {b == 1 ? 0.03 : 0.03 + eccentricity, 0.01, edge * (static_cast<double>(b) - 0.5)},
             .mass = mass,
             .inertia = inertia_of_box(mass, sides)});
    }
    // Critical for the slowest oscillation, of the total mass M on the springs in series, as in the study stack.
    const double damping = 2 * std::sqrt(blocks * 4 * stiffness * total_mass) / 4;
    world.law = {.geometry = contact_geometry::each_vertex,
                 .stiffness = stiffness,
                 .damping = damping,
                 .may_pull = false,
                 .friction = 0.5,
                 .slip_speed = 1e-4};
    world.gravity = earth_gravity;
    return world;
}

aabb::vec3d centre_of(const motion_state& state, std::size_t block) {
    return {state.position[3 * block], state.position[3 * block + 1], state.position[3 * block + 2]};
}
/// The normal of the block's upper face.
aabb::vec3d upwards(const motion_state& state, std::size_t block) {
    const matrix3 rotation = matrix_of(state.orientation_of(block - 1));
    return {rotation[2], rotation[5], rotation[8]};
}

/// The depth of the middle of a block's lower face in the block below: the mean of its four vertices.
double depth_of(const motion_state& state, std::size_t block) {
    const aabb::vec3d middle = centre_of(state, block) - times(upwards(state, block), edge / 2);
    if (block == 1) return -middle[2];
    const aabb::vec3d normal = upwards(state, block - 1);
    return edge / 2 - dot(normal, middle - centre_of(state, block - 1));
}

/// The leans of the blocks at rest, in radians, of the first order. The weights of a block and those above have a
/// moment about the middle of its lower face, against which its springs lean it by moment/(k b²) relative to the block
/// below. Leaning moves the weights, by a small part of their eccentricity: the iteration converges as a series of that
/// part.
std::vector<double> leans_at_rest(const stepped_world& world) {
    std::vector<double> leans(blocks + 1, 0.0);
    for (int iteration = 0; iteration < 50; ++iteration) {
        std::vector<double> base(blocks + 1, 0.0), centre(blocks + 1, 0.0);  // x of the middle of the lower face
        for (std::size_t b = 1; b <= blocks; ++b) {
            if (b > 1) base[b] = base[b - 1] + edge * leans[b - 1] + (b == 2 ? eccentricity : 0);
            centre[b] = base[b] + edge / 2 * leans[b];
        }
        for (std::size_t b = 1; b <= blocks; ++b) {
            double moment = 0;
            for (std::size_t j = b; j <= blocks; ++j)
                moment += world.bodies[j].mass * earth_gravity * (centre[j] - base[b]);
            leans[b] = leans[b - 1] + moment / (stiffness * side_of(b) * side_of(b));
        }
    }
    return leans;
}

}  // namespace

/// Under the mass M of a block and those above, springs of k at its four vertices give way by M g/(4k) on the average,
/// however it leans. With b/2 between springs and middle, a moment leans it by moment/(k b²). bdf's tolerance is a
/// hundredth of the least depth; its errors decay as the stack comes to rest.
void run_block_stack(const stiff_setting& setting, stiff_result& result) {
    for (const double ratio : {1.0, 10.0, 100.0, 1000.0}) {
        const stepped_world world = stack_of_blocks(ratio);
        for (const integrator_info& i : integrators_of(setting)) {
            if (i.name != "bdf") continue;  // explicit ones need steps of a quarter of m/c
            run_or_record_failure(result, i.name, [&] {
                const double tolerance = 1e-2 * world.bodies[blocks].mass * earth_gravity / (4 * stiffness);
                simulation stack(world, setting, i, tolerance);
                // The heaviest stack, of 1,280 kg, sways with a decay time of 1.2 s, J/c with c as the root of the
                // mass.
                double total_mass = 0;
                for (std::size_t b = 1; b <= blocks; ++b) total_mass += world.bodies[b].mass;
                const double end = 15 * std::sqrt(total_mass / 1280);
                while (stack.state().time < end) {
                    stack.advance(end / 30);
                    setting.progress(stack.state().time / end);
                }
                const motion_state& state = stack.state();
                double worst = 0;  // relative error of a depth
                double mass = 0;   // of block b and those above
                for (std::size_t b = blocks; b > 0; --b) {
                    mass += world.bodies[b].mass;
                    worst = std::max(worst, std::abs(depth_of(state, b) * 4 * stiffness / (mass * earth_gravity) - 1));
                }
                const std::string subject = std::string(i.name) + ", masses up to " + short_number(ratio) + " kg";
                result.add(at_most(subject, "greatest relative error of the depths at rest", worst, 1e-3));
                const aabb::vec3d leaning = upwards(state, 1);
                result.add(within(subject, "lean of the lowest block (rad)", std::atan2(leaning[0], leaning[2]),
                                  leans_at_rest(world)[1], 1e-3));
                result.add(reported(subject, "detections", static_cast<double>(stack.detections())));
            });
        }
    }
}

stiff_study block_stack_study() {
    return {
        "block_stack",
        "Five stacked blocks that may turn, heavy ones above light ones, on springs of 1e7 N/m at their four lower "
        "vertices. The upper ones stand 20 mm off the centre of the lowest, which leans",
        "statics: the depth M g/(4k) with the mass M of a block and those above, and leans by moment/(k b²), with the "
        "length b of a block",
        &run_block_stack};
}

}  // namespace aabblab
