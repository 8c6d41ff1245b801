// Boxes only, composed statically: what it does not use must not be in it.
#include <cstdio>
#include <vector>

import aabb;
import aabb.partition.none;
import aabb.sort.insertion;
import aabb.sweep.one_axis;

int main() {
    aabb::global_search<aabb::insertion_sort, aabb::none_partition, aabb::one_axis_sweep> search;
    std::vector<aabb::box> boxes;
    for (unsigned id = 0; id < 10; ++id) {
        const float x = static_cast<float>(id);
        boxes.push_back({{x, 0, 0}, {x + 1, 1, 1}});
        search.insert(id);
    }
    std::vector<aabb::index_pair> pairs;
    search.update(boxes);
    search.search(pairs);
    std::printf("%zu pairs\n", pairs.size());
    return pairs.size() == 9 ? 0 : 1;
}
