module;
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

export module aabb:balanced_build;

import :geometry;
import :mesh;

export namespace aabb {

/// Node of a binary tree before a layout packs it. Nodes stand in depth-first order: the left child of an internal node
/// is the next node.
struct build_node {
    box bounds;
    std::uint32_t right;     ///< index of the right child; 0 in a leaf
    std::uint32_t triangle;  ///< index of the triangle in a leaf

    [[nodiscard]] bool is_leaf() const noexcept { return right == 0; }
};

namespace detail {

class balanced_builder {
public:
    explicit balanced_builder(const mesh& m) : order_(m.triangle_count()) {
        nodes_.reserve(2 * order_.size() - 1);
        for (std::uint32_t t = 0; t < m.triangle_count(); ++t) {
            const triangle3f c = m.triangle(t);
            const box b = bounds_of(c);
            // The sum of the corners orders like their mean; in double, so that it cannot overflow.
            vec3d sum;
            for (int k = 0; k < 3; ++k) sum[k] = double{c[0][k]} + double{c[1][k]} + double{c[2][k]};
            order_[t] = {b, sum, t};
        }
    }

    [[nodiscard]] std::vector<build_node> build() {
        add(order_);
        return std::move(nodes_);
    }

private:
    struct element {
        box bounds;
        vec3d centroid;  // times three
        std::uint32_t triangle;
    };

    /// Halves the range at each step, so the recursion is no deeper than 32.
    std::uint32_t add(std::span<element> range) {
        const auto here = static_cast<std::uint32_t>(nodes_.size());
        box bounds = range[0].bounds;
        for (const element& e : range.subspan(1)) bounds = merged(bounds, e.bounds);
        nodes_.push_back({bounds, 0, range[0].triangle});
        if (range.size() == 1) return here;
        const int axis = longest_axis(bounds);
        const auto middle = range.begin() + static_cast<std::ptrdiff_t>(range.size() / 2);
        std::ranges::nth_element(range, middle, [axis](const element& p, const element& q) {
            // Ties go by index, so that the tree does not depend on the library's nth_element.
            return p.centroid[axis] != q.centroid[axis] ? p.centroid[axis] < q.centroid[axis] : p.triangle < q.triangle;
        });
        add({range.begin(), middle});
        nodes_[here].right = add({middle, range.end()});
        return here;
    }

    std::vector<element> order_;
    std::vector<build_node> nodes_;
};

}  // namespace detail

/// The paper's balanced tree (section 3.1): each box is split along its longest axis at the median of the triangles'
/// centroids, down to one triangle a leaf. n triangles give n - 1 internal nodes and a depth of ⌈log₂ n⌉.
/// @param m a mesh that `require_valid` accepts.
[[nodiscard]] inline std::vector<build_node> build_balanced(const mesh& m) {
    return detail::balanced_builder(m).build();
}

}  // namespace aabb
