module aabblab.stiff;

import :ball_world;
import :shapes;
import aabblab.stepping;

namespace aabblab {

stepped_world ball_on_floor(const oscillator& contact, double speed_down, double gravity) {
    stepped_world world;
    world.meshes = {floor_of(4), octahedron(0.5)};
    // Beside the diagonal of the floor.
    world.bodies = {{}, {.mesh = 1, .position = {0.3, -0.2, 0}, .velocity = {0, 0, -speed_down}, .mass = 1}};
    world.law = {contact_geometry::deepest_vertex, contact.frequency * contact.frequency,
                 2 * contact.damping * contact.frequency, 0};
    world.gravity = gravity;
    return world;
}

double depth_of_ball(const motion_state& state) {
    return -state.position[5];
}

double speed_of_ball(const motion_state& state) {
    return state.velocity[5];
}

}  // namespace aabblab
