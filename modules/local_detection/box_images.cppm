module;
#include <array>
#include <cstddef>
#include <cstdint>

export module aabb.local_detection:box_images;

import aabb.geometry;
import aabb.simd;
import :eight_boxes;
import :wide_node;

// Products may be fused into sums, which the bounds allow for; nothing else.
#pragma clang fp reassociate(off) reciprocal(off)

export namespace aabb {

/// Takes the boxes of a node's children into another frame: each holds the image of all that the child's does.
class box_images {
public:
    box_images() = default;
    explicit box_images(const box_motion& motion) noexcept {
        for (std::size_t k = 0; k < 3; ++k) {
            const auto axis = static_cast<int>(k);
            low_[k] = motion.shift[axis] - motion.margin[axis] - least;
            high_[k] = motion.shift[axis] + motion.margin[axis] + least;
            for (std::size_t j = 0; j < 3; ++j) {
                turn_[k][j] = motion.columns[j][axis];
                rises_[k][j] = turn_[k][j] > 0;
            }
        }
    }

    /// In double, grown by the margin of the motion, and rounded to nearest, which is monotone, like vertices. Planes
    /// lie further out than the vertices that the margin is for: by a 60th of the node, 2^-22 of the coordinate or the
    /// least step. What rounding adds by that is within what is left of the margin, or within `least`.
    void store(const wide_node& n, eight_boxes& to) const noexcept {
#pragma clang fp contract(fast)
        std::array<std::array<simd::eight_doubles, 3>, 2> planes;
        for (std::size_t j = 0; j < 3; ++j) {
            const double step = n.step(j);
            const double origin = n.origin[j] * step;
            planes[0][j] = doubles_of(n.planes.lower[j]) * step + origin;
            planes[1][j] = (255 - doubles_of(n.planes.upper[j])) * step + origin;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            simd::eight_doubles low = simd::eight_doubles{} + low_[k];
            simd::eight_doubles high = simd::eight_doubles{} + high_[k];
            for (std::size_t j = 0; j < 3; ++j) {
                low += turn_[k][j] * planes[1U - rises_[k][j]][j];
                high += turn_[k][j] * planes[rises_[k][j]][j];
            }
            simd::store_eight(to.lower[k].data(), __builtin_convertvector(low, simd::eight_floats));
            simd::store_eight(to.upper[k].data(), __builtin_convertvector(high, simd::eight_floats));
        }
        to.count = n.children;
    }

private:
    static constexpr double least = 0x1p-160;  // where all is denormal

    [[nodiscard]] static inline simd::eight_doubles doubles_of(const box_codes::row& codes) noexcept {
        return __builtin_convertvector(simd::load_eight<simd::eight_bytes>(codes.data()), simd::eight_doubles);
    }

    std::array<std::array<double, 3>, 3> turn_{};  // by the axis there, then here
    std::array<std::array<std::uint8_t, 3>, 3> rises_{};
    std::array<double, 3> low_{};
    std::array<double, 3> high_{};
};

}  // namespace aabb
