// Moving meshes, composed at run time: what is not named is selected.
#include <cstdio>
#include <vector>

import aabb;
import aabb.auto_detector;
import aabb.registry;

int main() {
    const aabb::mesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                 {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    aabb::auto_detector detector({tetrahedron}, {0, 0}, {"sort=shell"});
    for (const auto& one : detector.selected())
        std::printf("%s %s: %s\n", name_of(one.kind).data(), to_text(one.choice).c_str(), one.rule.c_str());
    std::vector<aabb::pose> poses(2);
    for (int frame = 0; frame < 3; ++frame) {
        poses[1].translation = {0.5 * frame, 0.25, 0.25};
        std::printf("frame %d: %zu contacts\n", frame, detector.contacts(poses).size());
    }
}
