module;
#include <cassert>

/// Doubles and their products as integers times powers of two, from which exact arithmetic begins.
export module aabb.geometry:exact_products;

import aabb.std;

export namespace aabb {

__extension__ using unsigned_128 = unsigned __int128;

/// A finite double as ± mantissa · 2^exponent with an odd mantissa; mantissa 0 for zero.
struct odd_double {
    std::uint64_t mantissa = 0;
    int exponent = 0;
    bool is_negative = false;

    explicit inline odd_double(double x) noexcept {
        assert(std::isfinite(x));
        const auto bits = std::bit_cast<std::uint64_t>(x);
        const auto biased = static_cast<int>(bits >> 52U & 0x7ffU);
        mantissa = bits & 0xf'ffff'ffff'ffffU;
        if (biased != 0) mantissa |= std::uint64_t{1} << 52U;
        if (mantissa == 0) return;
        const int zeros = std::countr_zero(mantissa);
        mantissa >>= static_cast<unsigned>(zeros);
        exponent = std::max(biased, 1) - 1075 + zeros;
        is_negative = std::signbit(x);
    }
};

/// A product of two doubles, exactly.
struct product_of_doubles {
    unsigned_128 magnitude = 0;
    int exponent = 0;
    bool is_negative = false;

    product_of_doubles() = default;
    inline product_of_doubles(const odd_double& x, const odd_double& y) noexcept
        : magnitude(unsigned_128{x.mantissa} * y.mantissa),
          exponent(x.exponent + y.exponent),
          is_negative(x.is_negative != y.is_negative) {}

    /// The exponent of a power of two above the magnitude, which is not 0.
    [[nodiscard]] inline int end() const noexcept {
        const auto high = static_cast<std::uint64_t>(magnitude >> 64U);
        const int bits = high != 0 ? 64 + static_cast<int>(std::bit_width(high))
                                   : static_cast<int>(std::bit_width(static_cast<std::uint64_t>(magnitude)));
        return exponent + bits;
    }
};

}  // namespace aabb
