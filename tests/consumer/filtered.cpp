// Three cubes in one place, of which a filter keeps some pairs.
#include <cstdio>
#include <vector>

import aabb;
import aabb.auto_detector;
import aabb.partition.columns;
import aabb.prepare.neighbour_list;
import aabb.sort.bucket;
import aabb.sweep.simd;

using search = aabb::global_search<aabb::bucket_sort, aabb::columns_partition, aabb::simd_sweep>;

namespace {

template <class Detector>
void print_pairs(const char* what, Detector& detector) {
    const std::vector<aabb::box> boxes(3, aabb::box{{0, 0, 0}, {1, 1, 1}});
    std::vector<aabb::index_pair> pairs;
    for (const aabb::index_pair pair : detector.pairs(boxes)) pairs.push_back(pair);
    std::printf("%s", what);
    for (unsigned a = 0; a < 3; ++a)
        for (unsigned b = a + 1; b < 3; ++b)
            for (const aabb::index_pair pair : pairs)
                if (pair.a == a && pair.b == b) std::printf(" %u-%u", a, b);
    std::printf("\n");
}

}  // namespace

int main() {
    aabb::collision_filter filter;
    aabb::detector<aabb::filtered_search<search>> detector{aabb::filtered_search<search>(filter)};
    for (unsigned id = 0; id < 3; ++id) detector.insert(id);
    print_pairs("all", detector);
    filter.set(0, {.group = 1, .mask = 2});
    filter.set(1, {.group = 2, .rests = true});
    filter.set(2, {.group = 2, .rests = true});
    filter.add_exception({1, 0});
    print_pairs("filtered", detector);

    aabb::collision_filter woken;
    woken.add_exception({2, 1});
    using prepared = aabb::prepared_search<aabb::neighbour_list_prepare, search>;
    aabb::detector<aabb::filtered_search<prepared>> with_list{aabb::filtered_search<prepared>(woken)};
    for (unsigned id = 0; id < 3; ++id) with_list.insert(id);
    print_pairs("woken", with_list);

    aabb::auto_detector by_name({"sort=shell"}, aabb::many_frames, &woken);
    for (unsigned id = 0; id < 3; ++id) by_name.insert(id);
    print_pairs("by name", by_name);
    woken.add_exception({0, 1});
    print_pairs("without 0 1:", by_name);
    woken.remove_exception({2, 1});
    print_pairs("with 1 2:", by_name);
}
