export module aabb.wide_tree.leaf_slab;

import aabb.std;
export import aabb.wide_tree.triangle_block;

// Products may be fused into sums, which the bounds allow for; nothing else.
#pragma clang fp reassociate(off) reciprocal(off)

export namespace aabb {

/// The space between two parallel planes that holds a leaf's triangles, across the mean of their normals: much thinner
/// than their boxes where a surface is smooth. What lies beyond it meets none of them.
class leaf_slab {
public:
    /// @param edges of a box around all vertices that are held against it, and its own
    void fit(const triangle_block& block, const std::array<float, 3>& edges) noexcept {
        set_normal(block);
        float magnitude = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            origin_[k] = block.corner[0][k][0];
            magnitude += std::abs(normal_[k]) * edges[k];
        }
        low_ = -std::numeric_limits<float>::infinity();
        high_ = std::numeric_limits<float>::infinity();
        if (!(magnitude < most_magnitude)) return;
        const heights own(*this, block);
        const float error = error_of(magnitude);
        low_ = simd::least(own.low) - 2 * error;
        high_ = -simd::least(-own.high) + 2 * error;
    }

    /// Bit j for each triangle j of the other block that reaches into the slab, or may.
    /// @param margin within which it is said to reach
    [[nodiscard]] inline std::uint32_t reached_by(const triangle_block& other, float margin = 0) const noexcept {
        const heights of_other(*this, other);
        const float grown = margin == 0 ? 0 : margin * length();
        return 0xffU & ~simd::bits_of_eight((of_other.low > high_ + grown) | (of_other.high < low_ - grown));
    }

private:
    static constexpr float most_magnitude = 1e37F;  // below, nothing overflows

    /// Of a sum of three products of differences: each is rounded, all in all by 6 times 2^-24 of the magnitude of the
    /// terms, or by half the least denormal.
    [[nodiscard]] static inline float error_of(float magnitude) noexcept { return magnitude * 0x1p-20F + 0x1p-140F; }

    /// Of the normal, or more.
    [[nodiscard]] inline float length() const noexcept {
        return (std::abs(normal_[0]) + std::abs(normal_[1]) + std::abs(normal_[2])) * (1 + 0x1p-20F);
    }

    /// Of the corners of triangles over the origin, along the normal.
    struct heights {
        simd::eight_floats low;
        simd::eight_floats high;

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

    void set_normal(const triangle_block& block) noexcept {
#pragma clang fp contract(fast)
        std::array<simd::eight_floats, 3> p;
        std::array<simd::eight_floats, 3> q;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto first = simd::load_eight<simd::eight_floats>(block.corner[0][k].data());
            p[k] = simd::load_eight<simd::eight_floats>(block.corner[1][k].data()) - first;
            q[k] = simd::load_eight<simd::eight_floats>(block.corner[2][k].data()) - first;
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t i = (k + 1) % 3;
            const std::size_t j = (k + 2) % 3;
            normal_[k] = simd::sum(p[i] * q[j] - p[j] * q[i]);
        }
    }

    std::array<float, 3> normal_{};  // of any length
    std::array<float, 3> origin_{};
    float low_ = 0;
    float high_ = 0;
};

}  // namespace aabb
