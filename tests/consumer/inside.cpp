// Whether one mesh lies inside another whose surface it does not meet.
#include <cstdio>
#include <vector>

import aabb;
import aabb.build.median;
import aabb.tree.canonical;

int main() {
    const aabb::mesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                 {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    const aabb::enclosure<aabb::canonical_tree> solid(tetrahedron, aabb::median_build());
    std::printf("%zu component, %s\n", solid.parts().size(), solid.is_closed() ? "closed" : "not closed");
    aabb::pose small;
    for (int frame = 0; frame < 3; ++frame) {
        for (int k = 0; k < 3; ++k) small.rotation.begin()[4 * k] = 0.25;
        small.translation = {0.125 + frame, 0.125, 0.125};
        std::printf("frame %d: %s\n", frame, name_of(relation_of(solid, small, solid, {}).relation).data());
    }
}
