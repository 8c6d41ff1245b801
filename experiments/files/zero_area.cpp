module aabblab.files;

import aabb.geometry;
import :mesh_builder;

namespace aabblab {

bool has_zero_area(const aabb::triangle3f& t) {
    const aabb::vec3d a{t[0][0], t[0][1], t[0][2]};
    const aabb::vec3d b{t[1][0], t[1][1], t[1][2]};
    const aabb::vec3d c{t[2][0], t[2][1], t[2][2]};
    return aabb::exact_turn(a, b, c, 0) == 0 && aabb::exact_turn(a, b, c, 1) == 0 && aabb::exact_turn(a, b, c, 2) == 0;
}

}  // namespace aabblab
