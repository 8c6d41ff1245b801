export module aabblab.stepping:body;

import aabb.geometry;
import aabb.std;

export namespace aabblab {

/// A rigid body that moves without turning: contacts have no friction, and its moment of inertia is taken for infinite.
struct body {
    std::uint32_t mesh = 0;
    aabb::vec3d position = {0, 0, 0};                              ///< of the mesh's origin, m
    aabb::vec3d velocity = {0, 0, 0};                              ///< m/s
    double mass = std::numeric_limits<double>::infinity();         ///< kg; one without end stands still
    std::array<double, 9> rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< row-major, from the mesh's frame
};

}  // namespace aabblab
