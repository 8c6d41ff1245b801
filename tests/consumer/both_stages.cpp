// Moving meshes, both stages composed at compile time.
#include <cstdio>
#include <vector>

import aabb;
import aabb.build.median;
import aabb.partition.columns;
import aabb.sort.bucket;
import aabb.sweep.simd;
import aabb.tree.implicit;
import aabb.triangle.exact;

using search = aabb::global_search<aabb::bucket_sort, aabb::columns_partition, aabb::simd_sweep>;
using detection = aabb::mesh_detection<aabb::median_build, aabb::implicit_tree, aabb::exact_triangle>;

int main() {
    const aabb::mesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                 {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    aabb::detector<search, detection> detector({tetrahedron}, {0, 0});  // two objects, both the first mesh
    std::vector<aabb::pose> poses(2);
    for (int frame = 0; frame < 3; ++frame) {
        poses[1].translation = {0.5 * frame, 0.25, 0.25};
        std::printf("frame %d: %zu contacts\n", frame, detector.contacts(poses).size());
    }
}
