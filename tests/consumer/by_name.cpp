// Both stages, composed by name.
#include <cstdio>
#include <memory>
#include <vector>

import aabb;
import aabb.distance_stages;
import aabb.partition.columns;
import aabb.registry;
import aabb.sort.bucket;
import aabb.sweep.simd;

namespace {

/// Of 2,000 boxes, each of which overlaps a few.
template <class Search>
std::vector<aabb::index_pair> pairs_of(Search& search) {
    std::vector<aabb::box> boxes;
    for (unsigned id = 0; id < 2000; ++id) {
        aabb::box b{};
        for (int k = 0; k < 3; ++k) {
            b.min[k] = static_cast<float>((id + 1) * (2 * k + 1237) % 1009) / 100;
            b.max[k] = b.min[k] + 1;
        }
        boxes.push_back(b);
        search.insert(id);
    }
    std::vector<aabb::index_pair> pairs;
    search.update(boxes);
    search.search(pairs);
    return pairs;
}

}  // namespace

int main() {
    const aabb::mesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                 {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
    const auto detection = aabb::compose_local_detection({}, aabb::instrumentation::none);
    const auto model = detection->add_model(tetrahedron);
    aabb::pose moved;
    moved.translation = {0.25, 0.25, 0.25};
    std::vector<aabb::index_pair> pairs;
    detection->all_pairs(model, {}, model, moved, pairs);
    std::printf("%zu triangle pairs\n", pairs.size());

    // All 16 pairs are within 1.5, and the meshes meet.
    const auto near = aabb::compose_within({}, 1.5);
    near->add_model(tetrahedron);
    const auto distances = aabb::compose_distance({});
    distances->add_model(tetrahedron);
    if (near->count_pairs(0, {}, 0, moved) != 16 || distances->distance(0, {}, 0, moved).distance != 0) return 1;

    // What is compiled here takes vectors as wide as those of the library does, whatever the flags.
    const std::vector<aabb::index_pair> found = pairs_of(*aabb::compose_global_search({}, aabb::instrumentation::none));
    aabb::global_search<aabb::bucket_sort, aabb::columns_partition, aabb::simd_sweep> by_type;
    return pairs.empty() || found.size() < 1000 || pairs_of(by_type) != found ? 1 : 0;
}
