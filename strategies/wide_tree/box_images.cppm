export module aabb.wide_tree.box_images;

import aabb.geometry;
import aabb.simd;
import aabb.std;
import aabb.wide_tree.eight_boxes;
import aabb.wide_tree.wide_node;

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

}  // namespace aabb
