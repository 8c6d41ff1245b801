export module aabb.tree.quantized_planes;

import aabb.std;
export import aabb.tree.sibling_planes;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// `sibling_planes` with a fixed number of bits per plane, rounded outward, relative to the parent's decoded box. A
/// child inherits the decoded plane, so that the rounding error of a plane persists in all descendants that inherit it.
///
/// A code q counts steps inward from the parent's plane, each 2^-bits of the parent's extent on that axis: decoded(q) =
/// plane + q * step, in float, with product and sum rounded separately. Both are monotone in q, and decoded(0) is the
/// parent's plane, so that bisection finds the greatest q that does not cut the child, by comparing the decoded plane
/// with the child's. Only this comparison makes boxes conservative, whatever is rounded, underflows or overflows: a
/// step is the difference of two planes times 2^-bits, hence finite; a q that overflows fails the comparison.
class quantized_planes {
public:
    static constexpr unsigned least_bits = 4;
    static constexpr unsigned most_bits = 16;

    /// The number of bytes beyond the codes that may be read; they are ignored.
    static constexpr std::size_t read_beyond = 8;

    explicit quantized_planes(unsigned bits) noexcept
        : bits_(bits), bytes_((6 * bits + 7) / 8), scale_(1 / static_cast<float>(1U << bits)) {}

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }

    /// Encodes six planes as codes of `bits_` bits. A code is the greatest number of steps inward from the parent's
    /// plane that does not cut a child; a step is 2^-bits of the parent's extent.
    /// @param codes gets the packed codes, `bytes()` bytes
    void encode(const box& parent, const sibling_planes& planes, std::byte* codes) const noexcept {
        // words[0] has the codes of the lower planes, words[1] those of the upper planes.
        std::array<std::uint64_t, 2> words{};
        for (int k = 0; k < 3; ++k) {
            const float step = step_on(parent, k);
            const float low = planes.own[static_cast<std::size_t>(k)];
            const float high = planes.own[static_cast<std::size_t>(k + 3)];
            words[0] |= greatest_code([&](unsigned q) { return decoded(parent.min[k], q, step) <= low; }) << k * bits_;
            words[1] |= greatest_code([&](unsigned q) { return decoded(parent.max[k], q, -step) >= high; })
                        << k * bits_;
        }
        // The codes of the upper planes follow those of the lower planes, possibly within a byte.
        std::array<std::byte, 2 * sizeof(std::uint64_t)> packed{};
        std::memcpy(packed.data(), words.data(), sizeof(std::uint64_t));
        words[1] = words[1] << upper_shift() | (words[0] >> 8 * upper_byte());
        std::memcpy(&packed[upper_byte()], &words[1], sizeof(std::uint64_t));
        std::copy_n(packed.begin(), bytes_, codes);
    }

    /// Decodes six planes: a code is the number of steps inward from the plane of the parent's decoded box.
    /// @param codes packed by `encode`; some bytes beyond are read and ignored
    [[nodiscard]] inline sibling_planes decode(const box& parent, const std::byte* codes) const noexcept {
        std::uint64_t lower = 0;
        std::uint64_t upper = 0;
        std::memcpy(&lower, codes, sizeof lower);
        std::memcpy(&upper, codes + upper_byte(), sizeof upper);
        upper >>= upper_shift();
        const unsigned mask = (1U << bits_) - 1;
        sibling_planes planes{};
        for (int k = 0; k < 3; ++k) {
            const auto low = static_cast<std::size_t>(k);
            const float step = step_on(parent, k);
            planes.own[low] = decoded(parent.min[k], static_cast<unsigned>(lower >> k * bits_) & mask, step);
            planes.own[low + 3] = decoded(parent.max[k], static_cast<unsigned>(upper >> k * bits_) & mask, -step);
        }
        return planes;
    }

private:
    static_assert(std::endian::native == std::endian::little);

    [[nodiscard]] inline std::size_t upper_byte() const noexcept { return 3 * bits_ / 8; }
    [[nodiscard]] inline unsigned upper_shift() const noexcept { return 3 * bits_ % 8; }
    [[nodiscard]] inline float step_on(const box& parent, int k) const noexcept {
        return parent.max[k] * scale_ - parent.min[k] * scale_;
    }
    [[nodiscard]] static inline float decoded(float plane, unsigned code, float step) noexcept {
        return plane + static_cast<float>(static_cast<int>(code)) * step;
    }

    /// Bisects for the greatest code that fits; 0 fits, and so does every code below one that fits.
    template <class Fits>
    [[nodiscard]] std::uint64_t greatest_code(Fits fits) const noexcept {
        unsigned code = 0;
        for (unsigned bit = 1U << (bits_ - 1); bit != 0; bit >>= 1)
            if (fits(code | bit)) code |= bit;
        return code;
    }

    unsigned bits_;
    unsigned bytes_;
    float scale_;
};

}  // namespace aabb
