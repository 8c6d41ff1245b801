export module aabb.partition.none;

import aabb.global_search;
import aabb.std;

export namespace aabb {

/// All objects in one subset: no cells, no copies, no arrays. When to use: few objects, or a sweep that needs no help.
struct none_partition {
    static constexpr std::string_view name = "none";
    static constexpr std::string_view summary = "no partition: all objects in one subset";
};

static_assert(PartitionPolicy<none_partition> && !CuttingPartition<none_partition>);

}  // namespace aabb
