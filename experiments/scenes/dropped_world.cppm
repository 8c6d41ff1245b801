export module aabblab.scenes:dropped_world;

import aabb.geometry;
import aabb.std;
import aabblab.stepping;

export namespace aabblab {

/// Balls in a cubic lattice above a floor, each a little off its place so that the lattice falls apart, and turned in a
/// way of its own: SimBenchmark's 666 test (leggedrobotics/SimBenchmark), with meshes for spheres. Lengths are in
/// longest extents of the ball, which are in metres.
struct dropped_config {
    std::uint32_t balls = 216;
    double height = 0.5;   ///< of the lowest ball above the floor
    double speed = 0;      ///< downwards at the beginning, m/s
    double depth = 0.001;  ///< to which one ball's weight presses it into the floor: the less, the stiffer
    double loss = 0;       ///< damping over the critical one of a ball on the floor
};

/// The floor is the first mesh, the ball the second.
[[nodiscard]] stepped_world dropped_world(const dropped_config& c, std::vector<aabb::mesh> meshes, std::uint64_t seed);

}  // namespace aabblab
