module;
#include <cstddef>
#include <cstdint>

export module aabb.local_detection:leaf_pairs;

import aabb.geometry;
import :eight_boxes;
import :leaf_codes;
import :leaf_slab;
import :model;
import :recently_made;
import :triangle_block;
import :wide_node;
import :wide_tree_policy;

export namespace aabb {

/// Triangles of A in eights, as they lie, with codes of their boxes.
struct leaf_of_a {
    triangle_block block;
    leaf_codes codes;
    box bounds;
    leaf_slab slab;
    bool has_slab;  ///< not before it is asked for
};

/// Triangles of B in eights, in A's frame.
struct leaf_of_b {
    triangle_block block;
    eight_boxes boxes;
    box bounds;
};

/// Reads the leaves of two trees, and moves those of B to A's frame. A leaf meets many, so that it is kept.
template <WideTreePolicy Tree>
class leaf_pairs {
public:
    void begin(const model<Tree>& a, const model<Tree>& b) {
        of_a_.begin(leaves(a));
        of_b_.begin(leaves(b));
    }

    /// @returns null where the leaves lie apart
    [[nodiscard]] inline leaf_of_a* near(const model<Tree>& a, std::uint32_t leaf, const leaf_of_b& of_b) {
        // The box of triangles that were moved is smaller than that of a box that was. Looking costs more than using a
        // leaf that is there.
        if (!of_a_.has(leaf) && !a.tree().level(0)[leaf / width].meets(leaf % width, of_b.bounds)) return nullptr;
        return &of_a_.get(leaf, [&](leaf_of_a& made) {
            made.block.load(a.triangles(), a.tree(), leaf);
            eight_boxes boxes;
            made.block.bounds(boxes);
            const box bounds = boxes.merged();
            made.codes.encode(boxes, bounds);
            made.bounds = bounds;
            made.has_slab = false;
        });
    }

    [[nodiscard]] static inline const leaf_slab& slab_of(leaf_of_a& leaf) noexcept {
        if (!leaf.has_slab) leaf.slab.fit(leaf.block, leaf.bounds);
        leaf.has_slab = true;
        return leaf.slab;
    }

    [[nodiscard]] inline const leaf_of_b& moved(const model<Tree>& b, std::uint32_t leaf, const relative_pose& to_a) {
        return of_b_.get(leaf, [&](leaf_of_b& made) {
            made.block.load(b.triangles(), b.tree(), leaf);
            made.block.move(to_a);
            made.block.bounds(made.boxes);
            made.bounds = made.boxes.merged();
        });
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return of_a_.bytes() + of_b_.bytes(); }

private:
    static constexpr std::size_t width = triangle_block::width;

    [[nodiscard]] static std::size_t leaves(const model<Tree>& m) noexcept {
        return (m.triangles().triangles.size() + width - 1) / width;
    }

    recently_made<leaf_of_a, 128> of_a_;
    recently_made<leaf_of_b, 32> of_b_;  // pairs come with those of a leaf of B together
};

}  // namespace aabb
