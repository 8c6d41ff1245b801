/// The interface of trees with eight children per node, for layouts, other walks and planning fronts. The rest is
/// internal.
export module aabb.wide_tree;

export import aabb.wide_tree.front_walk;
export import aabb.wide_tree.gap_walk;
export import aabb.wide_tree.triangles_in_box;
export import aabb.wide_tree.wide_node;

import aabb.std;
import aabb.wide_tree.bvtt_front;

export namespace aabb {

/// How many pairs of objects can have fronts, and how many leaves the two models must have at least.
inline constexpr std::size_t most_fronts = front_cache::most;
inline constexpr std::size_t least_leaves_of_front = front_cache::least_leaves;

}  // namespace aabb
