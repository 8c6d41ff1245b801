export module aabb.geometry:wide_integer;

import aabb.std;
import :exact_products;

export namespace aabb {

/// A signed integer of fixed width in two's complement. Sums wrap, so that callers choose widths that hold every
/// intermediate result.
template <std::size_t Limbs>
struct wide_integer {
    std::array<std::uint64_t, Limbs> limb{};  ///< the lowest first

    [[nodiscard]] constexpr int sign() const noexcept {
        if (limb[Limbs - 1] >> 63U != 0) return -1;
        return std::ranges::any_of(limb, [](std::uint64_t x) { return x != 0; }) ? 1 : 0;
    }

    [[nodiscard]] constexpr wide_integer magnitude() const noexcept {
        return sign() < 0 ? wide_integer{} - *this : *this;
    }

    /// Whether all bits but the leading `digits` are 0.
    [[nodiscard]] constexpr bool has_digits(int digits) const noexcept {
        const wide_integer positive = magnitude();
        int first = 0, last = -1;  // the bits that are set
        for (std::size_t i = Limbs; i-- > 0;)
            if (positive.limb[i] != 0) {
                first = static_cast<int>(64 * i) + std::countr_zero(positive.limb[i]);
                if (last < 0) last = static_cast<int>(64 * i) + static_cast<int>(std::bit_width(positive.limb[i])) - 1;
            }
        return last - first < digits;
    }

    /// Adds or subtracts factor · 2^shift.
    constexpr void add(unsigned_128 factor, int shift, bool is_negative) noexcept {
        const auto first = static_cast<std::size_t>(shift) / 64;
        const unsigned bits = static_cast<unsigned>(shift) % 64;
        const auto high = static_cast<std::uint64_t>(factor >> 64U);
        const unsigned_128 low = unsigned_128{static_cast<std::uint64_t>(factor)} << bits;
        const unsigned_128 rest = (unsigned_128{high} << bits) + (low >> 64U);
        wide_integer term;
        const std::array parts{static_cast<std::uint64_t>(low), static_cast<std::uint64_t>(rest),
                               static_cast<std::uint64_t>(rest >> 64U)};
        for (std::size_t i = 0; i < parts.size() && first + i < Limbs; ++i) term.limb[first + i] = parts[i];
        *this = is_negative ? *this - term : *this + term;
    }

    friend constexpr wide_integer operator+(const wide_integer& p, const wide_integer& q) noexcept {
        wide_integer sum;
        unsigned_128 carry = 0;
        for (std::size_t i = 0; i < Limbs; ++i) {
            carry += unsigned_128{p.limb[i]} + q.limb[i];
            sum.limb[i] = static_cast<std::uint64_t>(carry);
            carry >>= 64U;
        }
        return sum;
    }
    friend constexpr wide_integer operator-(const wide_integer& p, const wide_integer& q) noexcept {
        wide_integer difference;
        unsigned_128 carry = 1;  // p - q = p + ~q + 1
        for (std::size_t i = 0; i < Limbs; ++i) {
            carry += unsigned_128{p.limb[i]} + ~q.limb[i];
            difference.limb[i] = static_cast<std::uint64_t>(carry);
            carry >>= 64U;
        }
        return difference;
    }

    /// The whole product: that of the limbs as unsigned numbers, less, for a negative factor -x, stored as 2^64n - x,
    /// the other factor in the upper limbs.
    template <std::size_t Others>
    friend constexpr wide_integer<Limbs + Others> operator*(const wide_integer& p,
                                                            const wide_integer<Others>& q) noexcept {
        wide_integer<Limbs + Others> product;
        for (std::size_t i = 0; i < Limbs; ++i) {
            std::uint64_t carry = 0;
            for (std::size_t j = 0; j < Others; ++j) {
                const unsigned_128 sum = unsigned_128{p.limb[i]} * q.limb[j] + product.limb[i + j] + carry;
                product.limb[i + j] = static_cast<std::uint64_t>(sum);
                carry = static_cast<std::uint64_t>(sum >> 64U);
            }
            product.limb[i + Others] = carry;
        }
        if (p.sign() < 0) product.subtract_from_top(q);
        if (q.sign() < 0) product.subtract_from_top(p);
        return product;
    }

    /// Subtracts q, as an unsigned number, from the upper limbs of a product, which takes back the 2^64n that is too
    /// much in a negative factor.
    template <std::size_t Others>
    constexpr void subtract_from_top(const wide_integer<Others>& q) noexcept {
        constexpr std::size_t first = Limbs - Others;
        unsigned_128 carry = 1;
        for (std::size_t i = 0; i < Others; ++i) {
            carry += unsigned_128{limb[first + i]} + ~q.limb[i];
            limb[first + i] = static_cast<std::uint64_t>(carry);
            carry >>= 64U;
        }
    }
};

}  // namespace aabb
