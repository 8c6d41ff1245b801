import aabb.std;
import aabb;
import aabb.partition.kd_tree;
import aabb.sort.std;
import aabb.sweep.one_axis;

using boxes_detector =
    aabb::detector<aabb::global_search<aabb::std_sort, aabb::kd_tree_partition, aabb::one_axis_sweep>>;

boxes_detector first;
boxes_detector second = std::move(first);
