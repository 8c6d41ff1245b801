export module aabb.wide_tree.leaf_slab;

import aabb.std;
export import aabb.wide_tree.triangle_block;

#pragma clang fp reassociate(off) reciprocal(off)  // fused multiply-adds are allowed: error bounds include them

export namespace aabb {

/// A slab between two parallel planes around a leaf's triangles, perpendicular to their mean normal. On smooth surfaces
/// it is much thinner than their boxes. A triangle outside intersects none of them.
class leaf_slab {
public:
    /// Fits the slab to a leaf: the range of its corners' heights along the mean normal, relative to a corner, inflated
    /// by the errors of all compared heights. It stays infinite if these could overflow.
    /// @param edges extents of a box around the leaf's vertices and those compared with the slab
    /// @param margin by which the slab is inflated along each axis
    void fit(const triangle_block& block, const std::array<float, 3>& edges, float margin = 0) noexcept {
        set_normal(block);
        // A bound on all heights: |normal| · edges.
        float magnitude = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            origin_[k] = block.corner[0][k][0];
            magnitude += std::abs(normal_[k]) * edges[k];
        }
        low_ = -std::numeric_limits<float>::infinity();
        high_ = std::numeric_limits<float>::infinity();
        if (!(magnitude < most_magnitude)) return;
        const heights own_heights(*this, block);
        const float beyond = 2 * error_of(magnitude) + margin * length();
        low_ = simd::least(own_heights.low) - beyond;
        high_ = -simd::least(-own_heights.high) + beyond;
    }

    /// Sets bit j if triangle j of the other block may intersect the slab.
    [[nodiscard]] inline std::uint32_t triangles_inside(const triangle_block& other) const noexcept {
        const heights of_other(*this, other);
        return 0xffU & ~simd::bits_of_eight((of_other.low > high_) | (of_other.high < low_));
    }

private:
    static constexpr float most_magnitude = 1e37F;  // below, nothing overflows

    /// Bounds the error of a sum of three products of differences: rounding adds up to 6 times 2^-24 of the magnitude
    /// of the terms, or half the smallest denormal.
    [[nodiscard]] static inline float error_of(float magnitude) noexcept { return magnitude * 0x1p-20F + 0x1p-140F; }
    /// An upper bound of the normal's length.
    [[nodiscard]] inline float length() const noexcept {
        return (std::abs(normal_[0]) + std::abs(normal_[1]) + std::abs(normal_[2])) * (1 + 0x1p-20F);
    }

    struct heights {
        simd::eight_floats low;
        simd::eight_floats high;

        /// Computes the least and the greatest height of each triangle's three corners: (corner - origin) · normal.
        inline heights(const leaf_slab& slab, const triangle_block& block) noexcept {
#pragma clang fp contract(fast)
            for (std::size_t c = 0; c < 3; ++c) {
                simd::eight_floats h{};
                for (std::size_t k = 0; k < 3; ++k)
                    h += (simd::load_eight<simd::eight_floats>(block.corner[c][k].data()) - slab.origin_[k]) *
                         slab.normal_[k];
                low = c == 0 ? h : (h < low ? h : low);
                high = c == 0 ? h : (h > high ? h : high);
            }
        }
    };

    /// Sets the mean normal: the sum of the cross products of edges, which weights each normal by its triangle's area.
    void set_normal(const triangle_block& block) noexcept {
#pragma clang fp contract(fast)
        // Two edges of each of the eight triangles.
        std::array<simd::eight_floats, 3> p;
        std::array<simd::eight_floats, 3> q;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto first = simd::load_eight<simd::eight_floats>(block.corner[0][k].data());
            p[k] = simd::load_eight<simd::eight_floats>(block.corner[1][k].data()) - first;
            q[k] = simd::load_eight<simd::eight_floats>(block.corner[2][k].data()) - first;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
            normal_[k] = simd::sum(p[i] * q[j] - p[j] * q[i]);
        }
    }

    std::array<float, 3> normal_{};  // of any length
    std::array<float, 3> origin_{};
    float low_ = 0;
    float high_ = 0;
};

}  // namespace aabb
