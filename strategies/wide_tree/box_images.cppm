export module aabb.wide_tree.box_images;

import aabb.std;
export import aabb.wide_tree.wide_node;

// Products may be fused into sums, which the bounds allow for; nothing else.
#pragma clang fp reassociate(off) reciprocal(off)

export namespace aabb {

/// Takes the boxes of a node's children into another frame: each holds the image of all that the child's does.
class box_images {
public:
    void begin(const box_motion& motion) noexcept {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<int>(k);
            shift_[k] = motion.shift[axis];
            margin_[k] = motion.margin[axis] + least;
            for (std::size_t j = 0; j < 3; ++j) turn_[k][j] = motion.columns[j][axis];
        }
    }

    /// In double, grown by the margin of the motion, and rounded to nearest, which is monotone, like vertices. Planes
    /// lie further out than the vertices that the margin is for: by a 60th of the node, 2^-22 of the coordinate or the
    /// least step. What rounding adds by that is within what is left of the margin, or within `least`.
    void store(const wide_node& n, eight_boxes& to) const noexcept {
#pragma clang fp contract(fast)
        // Centres and halves of edges, exactly: whole or half codes, times powers of two.
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
            simd::eight_doubles at = simd::eight_doubles{} + shift_[k];
            simd::eight_doubles reach = simd::eight_doubles{} + margin_[k];
            for (std::size_t j = 0; j < 3; ++j) {
                at += turn_[k][j] * centre[j];
                reach += std::abs(turn_[k][j]) * half[j];
            }
            simd::store_eight(to.lower[k].data(), __builtin_convertvector(at - reach, simd::eight_floats));
            simd::store_eight(to.upper[k].data(), __builtin_convertvector(at + reach, simd::eight_floats));
        }
        to.count = n.children;
    }

private:
    static constexpr double least = 0x1p-160;  // where all is denormal

    [[nodiscard]] static inline simd::eight_doubles doubles_of(const box_codes::row& codes) noexcept {
        return __builtin_convertvector(simd::load_eight<simd::eight_bytes>(codes.data()), simd::eight_doubles);
    }

    std::array<std::array<double, 3>, 3> turn_{};  // by the axis there, then here
    std::array<double, 3> shift_{};
    std::array<double, 3> margin_{};
};

/// Images of the children of a tree's nodes, kept for those that come again: each node has a place, shared with others.
class kept_images {
public:
    /// Forgets all, and takes few places where there are few nodes.
    /// @param first of the nodes, which all lie in one array
    void begin(const wide_node* first, std::size_t nodes, const box_motion& motion) {
        first_ = first;
        images_.begin(motion);
        if (boxes_.size() < most && boxes_.size() < nodes) boxes_.resize(std::min(most, std::bit_ceil(nodes)));
        made_.fill(nothing);
    }

    [[nodiscard]] inline const eight_boxes& operator()(const wide_node& n) {
        const auto number = static_cast<std::uint32_t>(&n - first_);
        const std::size_t place = number & (boxes_.size() - 1);
        if (made_[place] != number) {
            images_.store(n, boxes_[place]);
            made_[place] = number;
        }
        return boxes_[place];
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(boxes_); }

private:
    static constexpr std::size_t most = 32;  // a power of two
    static constexpr std::uint32_t nothing = 0xffffffff;

    const wide_node* first_ = nullptr;
    box_images images_;
    std::array<std::uint32_t, most> made_{};
    std::vector<eight_boxes> boxes_;
};

}  // namespace aabb
