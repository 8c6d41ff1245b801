// Boxes, composed at compile time: unused parts are not compiled in.
#include <cstdio>
#include <vector>

import aabb;
import aabb.partition.none;
import aabb.sort.insertion;
import aabb.sweep.one_axis;

int main() {
    aabb::detector<aabb::global_search<aabb::insertion_sort, aabb::none_partition, aabb::one_axis_sweep>> detector;
    std::vector<aabb::box> boxes{{{0, 0, 0}, {2, 1, 1}}, {{1, 0, 0}, {3, 1, 1}}, {{4, 0, 0}, {5, 1, 1}}};
    for (unsigned id = 0; id < boxes.size(); ++id) detector.insert(id);
    for (int frame = 0; frame < 3; ++frame) {
        for (const auto [a, b] : detector.pairs(boxes)) std::printf("frame %d: %u overlaps %u\n", frame, a, b);
        boxes[0] = {{boxes[0].min[0] + 2, 0, 0}, {boxes[0].max[0] + 2, 1, 1}};
    }
}
