export module aabb.partition.none;

import aabb.global_search;
import aabb.std;

export namespace aabb {

/// Keeps all objects in one subset, without cells or copies. When to use: few objects, or a sweep that needs no cuts.
struct none_partition {
    static constexpr std::string_view name = "none";
    static constexpr std::string_view summary = "no partition: all objects in one subset";
};

static_assert(PartitionPolicy<none_partition> && !CuttingPartition<none_partition>);

}  // namespace aabb
