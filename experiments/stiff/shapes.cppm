/// Meshes whose contacts have closed forms.
module aabblab.stiff:shapes;

import aabb.geometry;
import aabb.std;
import aabblab.scenes;

namespace aabblab {

/// An octahedron whose lowest vertex is the origin, so that its depth below a floor does not suffer from rounding.
[[nodiscard]] aabb::mesh octahedron(float radius) {
    const float r = radius;
    return {{{r, 0, r}, {0, r, r}, {-r, 0, r}, {0, -r, r}, {0, 0, 2 * r}, {0, 0, 0}},
            {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}}};
}

[[nodiscard]] aabb::mesh scaled(aabb::mesh m, double factor) {
    for (aabb::vec3f& v : m.vertices)
        for (float& coordinate : v.at) coordinate = static_cast<float>(coordinate * factor);
    return m;
}

/// An upward facing square in z = 0 around the origin, divided into n × n squares of two triangles.
[[nodiscard]] aabb::mesh floor_of(double side, std::uint32_t n = 1) {
    const aabb::mesh m = make_mesh("square:triangles=" + std::to_string(2 * n * n)).mesh;
    return scaled(m, side / (double{m.vertices.back()[0]} - double{m.vertices.front()[0]}));
}

/// An inverted pyramid with a square top, and its apex `below` under the origin.
[[nodiscard]] aabb::mesh hanging_pyramid(float height, float side, float below = 0) {
    const float s = side / 2, top = height - below;
    return {{{0, 0, -below}, {-s, -s, top}, {s, -s, top}, {s, s, top}, {-s, s, top}},
            {{0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 1, 4}, {1, 2, 3}, {1, 3, 4}}};
}

/// A cuboid centred at the origin: eight vertices, and two triangles per face with outward normals.
[[nodiscard]] aabb::mesh cuboid(const aabb::vec3d& sides) {
    aabb::mesh m;
    const auto x = static_cast<float>(sides[0] / 2), y = static_cast<float>(sides[1] / 2);
    const auto top = static_cast<float>(sides[2] / 2);
    for (const float z : {-top, top})
        for (const auto& [right, back] : std::array<std::array<float, 2>, 4>{{{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}})
            m.vertices.push_back({right * x, back * y, z});
    m.triangles = {{0, 2, 1}, {0, 3, 2}, {4, 5, 6}, {4, 6, 7}, {0, 1, 5}, {0, 5, 4},
                   {1, 2, 6}, {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
    return m;
}

/// A square plate centred at the origin.
[[nodiscard]] aabb::mesh slab(float side, float thickness) {
    return cuboid({double{side}, double{side}, double{thickness}});
}

}  // namespace aabblab
