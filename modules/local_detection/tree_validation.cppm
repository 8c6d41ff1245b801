export module aabb.local_detection:tree_validation;

import aabb.std;
import :policies;

export namespace aabb {

/// The result of validating a whole tree.
struct tree_validation {
    std::string fault;          ///< the first fault; empty if the tree is valid
    std::size_t depth = 0;      ///< number of edges from the root to the deepest leaf
    bool tight = true;          ///< every box is the smallest that contains its triangles
    double area_inflation = 0;  ///< total area of the boxes relative to that of the tight ones, minus 1
};

namespace detail {

template <TreePolicy Tree>
class tree_validator {
public:
    tree_validator(const Tree& tree, const mesh& m) : tree_(tree), mesh_(m), seen_(m.triangles.size()) {}

    /// Validates, depth first up to the first fault, that each triangle is in exactly one leaf, and each box contains
    /// the triangles below it; `open_` is the path from the root.
    /// @returns the fault, or the depth of a valid tree and how much larger its boxes are than tight ones
    [[nodiscard]] tree_validation validate_tree() {
        open_.push_back({.cursor = tree_.root(mesh_), .below = empty_box(), .opened = 0});
        // An explicit stack, since trees may be too deep for recursion.
        while (!open_.empty() && result_.fault.empty()) {
            node& current = open_.back();
            if (tree_.is_leaf(current.cursor))
                visit_leaf(current);
            else if (current.opened < 2) {
                const auto child = tree_.children(current.cursor, mesh_)[current.opened++];
                open_.push_back({.cursor = child, .below = empty_box(), .opened = 0});
                if (open_.size() > seen_.size()) result_.fault = "the tree has more levels than triangles";
                continue;
            }
            close(current);
        }
        if (result_.fault.empty())
            if (const auto absent = std::ranges::find(seen_, 0); absent != seen_.end())
                result_.fault = "triangle " + std::to_string(absent - seen_.begin()) + " is in no leaf";
        result_.area_inflation = tight_area_ > 0 ? box_area_ / tight_area_ - 1 : 0;
        return result_;
    }

private:
    /// A node on the path from the root.
    struct node {
        typename Tree::cursor cursor;
        box below;        // box of the visited triangles below it
        unsigned opened;  // number of visited children
    };

    /// Marks a leaf's triangle as seen, and sets `below` to its box. An unknown or repeated triangle is a fault.
    void visit_leaf(node& leaf) {
        const std::uint32_t triangle = tree_.triangle(leaf.cursor);
        if (triangle >= seen_.size())
            result_.fault = "a leaf holds triangle " + std::to_string(triangle) + ", which the mesh does not have";
        else if (seen_[triangle]++ != 0)
            result_.fault = "triangle " + std::to_string(triangle) + " is in two leaves";
        else
            leaf.below = bounds_of(mesh_.triangle(triangle));
    }

    [[nodiscard]] bool has_box(const typename Tree::cursor& at) const {
        if constexpr (requires { Tree::has_box(at); })
            return Tree::has_box(at);
        else
            return Tree::has_leaf_boxes || !tree_.is_leaf(at);
    }

    /// Leaves a node whose children have been visited: compares its box with the box of the triangles below it, its
    /// tight box, adds the areas of both to their sums, and merges the tight box into that of the parent.
    void close(const node& closed) {
        result_.depth = std::max(result_.depth, open_.size() - 1);
        if (!result_.fault.empty()) return;
        const box below = closed.below;
        const box bounds = tree_.bounds(closed.cursor);
        if (!contains(bounds, below)) result_.fault = "a box does not contain the triangles below it";
        if (has_box(closed.cursor)) {
            result_.tight &= bounds == below;
            box_area_ += surface_area(bounds);
            tight_area_ += surface_area(below);
        }
        open_.pop_back();
        if (!open_.empty()) open_.back().below = merged(open_.back().below, below);
    }

    const Tree& tree_;
    const mesh& mesh_;
    std::vector<std::uint8_t> seen_;  // by triangle
    std::vector<node> open_;
    tree_validation result_;
    double box_area_ = 0;
    double tight_area_ = 0;
};

}  // namespace detail

/// Validates the tree of a mesh: each triangle is in exactly one leaf, and each box contains the triangles below it.
template <TreePolicy Tree>
[[nodiscard]] tree_validation validate(const Tree& tree, const mesh& m) {
    return detail::tree_validator<Tree>(tree, m).validate_tree();
}

}  // namespace aabb
