/// The room of trees with eight children a node: what a layout of such a tree sees of it, and who plans for its fronts.
/// All else is behind.
export module aabb.wide_tree;

export import aabb.wide_tree.front_walk;
export import aabb.wide_tree.policy;

import aabb.std;
import aabb.wide_tree.leaf_front;

export namespace aabb {

/// Of how many pairs of objects pairs of leaves are kept, and of how many leaves at least the two must have.
inline constexpr std::size_t most_fronts = front_keeper::most;
inline constexpr std::size_t least_leaves_of_front = front_keeper::least_leaves;

}  // namespace aabb
