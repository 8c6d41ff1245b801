// Both stages, composed by name.
#include <cstdio>
#include <memory>
#include <vector>

import aabb;
import aabb.registry;

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
    return pairs.empty() ? 1 : 0;
}
