/// Collision filtering: which pairs of objects are tested at all, as physics engines let their users say by groups and
/// masks, for bodies at rest, for two sets, and by lists of pairs.
export module aabb.collision_filter;

export import aabb.pipeline;
import aabb.std;
export import :filter;
export import :filtered_search;
