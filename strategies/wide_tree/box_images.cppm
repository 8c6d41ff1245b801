export module aabb.wide_tree.box_images;

import aabb.std;
export import aabb.wide_tree.wide_node;

#pragma clang fp reassociate(off) reciprocal(off)  // fused multiply-adds are allowed: error bounds include them

export namespace aabb {

/// Transforms the boxes of a node's children into another frame: each box contains the image of the child's box.
class box_images {
public:
    /// Sets the motion of the boxes, a rotation and a shift. Its margin, by which each image grows along axis k, gets
    /// an allowance for underflow: `least` for the shift and for each coordinate, as the rotation stretches it.
    void begin(const box_motion& motion) noexcept {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<int>(k);
            shift_[k] = motion.shift[axis];
            double stretch = 1;
            for (std::size_t j = 0; j < 3; ++j) {
                turn_[k][j] = motion.columns[j][axis];
                stretch += std::abs(turn_[k][j]);
            }
            margin_[k] = motion.margin[axis] + least * stretch;
        }
    }

    /// Stores for each child a box in the other frame that contains its image: centre R c + shift, half extents |R| h +
    /// margin, for its centre c and half extents h. The motion's margin is for vertices, and has room for planes, which
    /// lie further out by a 60th of the node, 2^-22 of the coordinate or the smallest step; `least` covers the rest.
    void store(const wide_node& n, eight_boxes& to) const noexcept {
#pragma clang fp contract(fast)
        // Centres and half extents are exact: (half) codes times powers of two. Upper planes are stored as 255 - code.
        std::array<simd::eight_doubles, 3> centre;
        std::array<simd::eight_doubles, 3> half;
        for (std::size_t j = 0; j < 3; ++j) {
            const double half_step = n.step(j) / 2;
            const simd::eight_doubles lower = doubles_of(n.planes.lower[j]);
            const simd::eight_doubles upper = 255 - doubles_of(n.planes.upper[j]);
            centre[j] = (upper + lower + 2.0 * n.origin[j]) * half_step;
            half[j] = (upper - lower) * half_step;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            simd::eight_doubles image = simd::eight_doubles{} + shift_[k];
            simd::eight_doubles radius = simd::eight_doubles{} + margin_[k];
            for (std::size_t j = 0; j < 3; ++j) {
                image += turn_[k][j] * centre[j];
                radius += std::abs(turn_[k][j]) * half[j];
            }
            simd::store_eight(to.lower[k].data(), __builtin_convertvector(image - radius, simd::eight_floats));
            simd::store_eight(to.upper[k].data(), __builtin_convertvector(image + radius, simd::eight_floats));
        }
        to.count = n.children;
    }

private:
    static constexpr double least = 0x1p-160;  // for denormal coordinates, which a map may make greater

    [[nodiscard]] static inline simd::eight_doubles doubles_of(const quantized_aabbs::row& codes) noexcept {
        return __builtin_convertvector(simd::load_eight<simd::eight_bytes>(codes.data()), simd::eight_doubles);
    }

    std::array<std::array<double, 3>, 3> turn_{};  // by the target axis, then the source axis
    std::array<double, 3> shift_{};
    std::array<double, 3> margin_{};
};

/// A direct-mapped cache of the transformed children of a tree's nodes.
class image_cache {
public:
    /// Invalidates the cache, and grows it if the tree has many nodes.
    /// @param first the first node of the array that has all nodes
    void begin(const wide_node* first, std::size_t nodes, const box_motion& motion) {
        first_ = first;
        images_.begin(motion);
        if (boxes_.size() < most && boxes_.size() < nodes) boxes_.resize(std::min(most, std::bit_ceil(nodes)));
        cached_nodes_.fill(no_node);
    }

    /// The children's boxes in the other frame, cached in the slot of the node's number modulo the number of slots.
    [[nodiscard]] inline const eight_boxes& of(const wide_node& n) {
        const auto number = static_cast<std::uint32_t>(&n - first_);
        const std::size_t slot = number & (boxes_.size() - 1);
        if (cached_nodes_[slot] != number) {
            images_.store(n, boxes_[slot]);
            cached_nodes_[slot] = number;
        }
        return boxes_[slot];
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(boxes_); }

private:
    static constexpr std::size_t most = 32;  // a power of two
    static constexpr std::uint32_t no_node = 0xffffffff;

    const wide_node* first_ = nullptr;
    box_images images_;
    std::array<std::uint32_t, most> cached_nodes_{};
    std::vector<eight_boxes> boxes_;
};

}  // namespace aabb
