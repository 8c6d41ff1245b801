export module aabb.geometry:product_sum;

import aabb.std;
import :exact_products;
import :points;

export namespace aabb {

/// A number whose exponent may exceed that of a double: mantissa 2^exponent, |mantissa| in [1/2, 1), or both 0.
struct scaled_double {
    double mantissa;
    int exponent;
};

/// The exact sum of products of three finite doubles: a fixed-point number wide enough for all of them (Kulisch's
/// accumulator), so that nothing overflows, underflows or is rounded. Digits of 32 bits are stored in i64, whose upper
/// halves collect carries.
class product_sum {
public:
    /// The number of products between calls of `carry`.
    static constexpr std::uint32_t most_products = 0x7fffffff;

    /// Adds a product: the mantissas are multiplied exactly, and the result is added to the digits at its place.
    inline void add(double x, double y, double z) noexcept {
        const odd_double a(x), b(y), c(z);
        if (a.mantissa == 0 || b.mantissa == 0 || c.mantissa == 0) return;
        const bool is_negative = (a.is_negative != b.is_negative) != c.is_negative;
        const int place = a.exponent + b.exponent + c.exponent - least_exponent;
        const int first = place / 32;
        const int shift = place % 32;
        // The product has at most 159 bits, and with the shift 190: the lowest 64, then the others.
        const unsigned_128 ab = unsigned_128{a.mantissa} * b.mantissa;
        const unsigned_128 low = unsigned_128{static_cast<std::uint64_t>(ab)} * c.mantissa;
        unsigned_128 high = (ab >> 64) * c.mantissa + (low >> 64);
        const unsigned_128 shifted = unsigned_128{static_cast<std::uint64_t>(low)} << shift;
        high = (high << shift) + (shifted >> 64);
        const std::array<std::uint32_t, 6> digits{
            static_cast<std::uint32_t>(shifted),    static_cast<std::uint32_t>(shifted >> 32),
            static_cast<std::uint32_t>(high),       static_cast<std::uint32_t>(high >> 32),
            static_cast<std::uint32_t>(high >> 64), static_cast<std::uint32_t>(high >> 96)};
        for (std::size_t k = 0; k < digits.size(); ++k) {
            std::int64_t& word = words_[static_cast<std::size_t>(first) + k];
            word += is_negative ? -std::int64_t{digits[k]} : std::int64_t{digits[k]};
        }
        first_ = std::min(first_, first);
        last_ = std::max(last_, first + static_cast<int>(digits.size()));
    }
    inline void subtract(double x, double y, double z) noexcept { add(-x, y, z); }

    /// Adds the determinant of the matrix with columns p, q and r.
    inline void add_determinant(const vec3d& p, const vec3d& q, const vec3d& r) noexcept {
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            add(p[i], q[j], r[k]);
            subtract(p[i], q[k], r[j]);
        }
    }

    /// Adds the component of p × q between the axes x and y.
    inline void add_cross(const vec3d& p, const vec3d& q, int x, int y) noexcept {
        add(p[x], q[y], 1);
        subtract(p[y], q[x], 1);
    }

    /// Makes room for more products: leaves digits below 2^32, but for the highest.
    inline void carry() noexcept {
        for (int i = first_; i < last_ && i + 1 < words; ++i) {
            std::int64_t& word = words_[static_cast<std::size_t>(i)];
            words_[static_cast<std::size_t>(i) + 1] += word >> 32;
            word &= 0xffff'ffff;
            if (i + 1 == last_ && words_[static_cast<std::size_t>(last_)] != 0) ++last_;
        }
    }

    /// The sign of the sum: that of the last carry, or else 1 if any digit is not zero.
    [[nodiscard]] inline int sign() const noexcept {
        std::int64_t carry = 0;
        bool is_zero = true;
        for (int i = first_; i < last_; ++i) {
            const std::int64_t sum = words_[static_cast<std::size_t>(i)] + carry;
            is_zero &= (sum & 0xffff'ffff) == 0;
            carry = sum >> 32;
        }
        if (carry < 0) return -1;
        return is_zero && carry == 0 ? 0 : 1;
    }

    /// The sum, rounded to the precision of double.
    [[nodiscard]] inline scaled_double rounded() const noexcept {
        // The digits of the magnitude, lowest first.
        std::array<std::uint32_t, words + 2> digits{};
        const bool is_negative = sign() < 0;
        std::int64_t carry = 0;
        int count = first_;
        for (; count < last_ || carry > 0; ++count) {
            const std::int64_t word = count < last_ ? words_[static_cast<std::size_t>(count)] : 0;
            const std::int64_t sum = (is_negative ? -word : word) + carry;
            digits[static_cast<std::size_t>(count)] = static_cast<std::uint32_t>(sum);
            carry = sum >> 32;
        }
        while (count > first_ && digits[static_cast<std::size_t>(count) - 1] == 0) --count;
        if (count <= first_) return {0, 0};
        // The leading digit and three more have at least 97 significant bits, so that in effect one rounding yields 53.
        unsigned_128 leading = 0;
        for (int k = 1; k <= 4; ++k)
            leading = leading << 32 | (count - k >= 0 ? digits[static_cast<std::size_t>(count - k)] : 0);
        int exponent = 0;
        const double mantissa = std::frexp(static_cast<double>(leading), &exponent);
        return {is_negative ? -mantissa : mantissa, exponent + 32 * (count - 4) + least_exponent};
    }

private:
    static constexpr int least_exponent = 3 * -1074;  // of a product
    // The greatest place of a digit, the other digits of a product, and one for carries.
    static constexpr int words = (3 * 1023 - least_exponent) / 32 + 7;

    std::array<std::int64_t, words> words_{};
    int first_ = words;
    int last_ = 0;
};

}  // namespace aabb
