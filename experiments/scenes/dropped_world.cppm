export module aabblab.scenes:dropped_world;

import aabb.geometry;
import aabb.std;
import aabblab.stepping;

export namespace aabblab {

/// Balls in a cubic lattice above a floor, perturbed so that the lattice collapses, with random rotations: the 666 test
/// of leggedrobotics/SimBenchmark with meshes. Lengths are over the longest extent of the ball, which is in metres.
struct dropped_config {
    std::uint32_t balls = 216;
    double height = 0.5;   ///< of the lowest ball above the floor
    double speed = 0;      ///< initial, downwards, m/s
    double depth = 0.001;  ///< of a ball that rests on the floor; less is stiffer
    double loss = 0;       ///< damping over the critical damping of a ball on the floor
};

/// The floor is the first mesh, the ball the second.
[[nodiscard]] stepped_world dropped_world(const dropped_config& c, std::vector<aabb::mesh> meshes, std::uint64_t seed);

}  // namespace aabblab
