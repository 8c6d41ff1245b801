/// One ball, which is an octahedron on its vertex, and a floor: the world of which everything is known.
module aabblab.stiff:ball_world;

import aabblab.stepping;
import :oscillator;

namespace aabblab {

/// A ball of 1 kg that touches the floor at time 0.
[[nodiscard]] stepped_world ball_on_floor(const oscillator& contact, double speed_down, double gravity = 0);

/// How far the ball's lowest vertex is below the floor, m.
[[nodiscard]] double depth_of_ball(const motion_state& state);
[[nodiscard]] double speed_of_ball(const motion_state& state);  ///< upwards, m/s

}  // namespace aabblab
