module;
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>

module aabb.geometry;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

namespace aabb {

namespace {

__extension__ using wide = unsigned __int128;

/// Magnitude of a finite double as mantissa · 2^(place - 1074).
struct parts {
    std::uint64_t mantissa;
    int place;
};

parts parts_of(double x) noexcept {
    assert(std::isfinite(x));
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const int exponent = static_cast<int>(bits >> 52 & 0x7ff);
    const std::uint64_t fraction = bits & 0xf'ffff'ffff'ffff;
    return exponent == 0 ? parts{fraction, 0} : parts{fraction | std::uint64_t{1} << 52, exponent - 1};
}

/// Exact sum of up to 24 products of three finite doubles: one fixed-point number wide enough for all of them
/// (Kulisch's accumulator), so that nothing overflows, underflows or is rounded. Digits of 32 bits stand in signed
/// words of 64, whose upper halves collect carries until the sign is asked for.
class product_sum {
public:
    void add(double x, double y, double z) noexcept {
        const parts a = parts_of(x);
        const parts b = parts_of(y);
        const parts c = parts_of(z);
        if (a.mantissa == 0 || b.mantissa == 0 || c.mantissa == 0) return;
        const bool negative = (std::signbit(x) != std::signbit(y)) != std::signbit(z);
        const int place = a.place + b.place + c.place;
        const int first = place / 32;
        const int shift = place % 32;
        // The product has at most 159 bits, and with the shift 190: the lowest 64, then the others.
        const wide ab = wide{a.mantissa} * b.mantissa;
        const wide low = wide{static_cast<std::uint64_t>(ab)} * c.mantissa;
        wide high = (ab >> 64) * c.mantissa + (low >> 64);
        const wide shifted = wide{static_cast<std::uint64_t>(low)} << shift;
        high = (high << shift) + (shifted >> 64);
        const std::array<std::uint32_t, 6> digits{
            static_cast<std::uint32_t>(shifted),    static_cast<std::uint32_t>(shifted >> 32),
            static_cast<std::uint32_t>(high),       static_cast<std::uint32_t>(high >> 32),
            static_cast<std::uint32_t>(high >> 64), static_cast<std::uint32_t>(high >> 96)};
        for (std::size_t k = 0; k < digits.size(); ++k) {
            std::int64_t& word = words_[static_cast<std::size_t>(first) + k];
            word += negative ? -std::int64_t{digits[k]} : std::int64_t{digits[k]};
        }
        first_ = std::min(first_, first);
        last_ = std::max(last_, first + 6);
    }

    void subtract(double x, double y, double z) noexcept { add(-x, y, z); }

    /// Adds det(p, q, r).
    void add_determinant(const vec3d& p, const vec3d& q, const vec3d& r) noexcept {
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3;
            const int k = (i + 2) % 3;
            add(p[i], q[j], r[k]);
            subtract(p[i], q[k], r[j]);
        }
    }

    /// Adds the component of p × q between the axes x and y.
    void add_cross(const vec3d& p, const vec3d& q, int x, int y) noexcept {
        add(p[x], q[y], 1);
        subtract(p[y], q[x], 1);
    }

    [[nodiscard]] int sign() const noexcept {
        std::int64_t carry = 0;
        bool zero = true;
        for (int i = first_; i < last_; ++i) {
            const std::int64_t sum = words_[static_cast<std::size_t>(i)] + carry;
            zero &= (sum & 0xffff'ffff) == 0;
            carry = sum >> 32;
        }
        if (carry < 0) return -1;
        return zero && carry == 0 ? 0 : 1;
    }

    [[nodiscard]] scaled_double rounded() const noexcept {
        // Digits of the magnitude, the lowest first.
        std::array<std::uint32_t, words + 2> digits{};
        const bool negative = sign() < 0;
        std::int64_t carry = 0;
        int count = first_;
        for (; count < last_ || carry > 0; ++count) {
            const std::int64_t word = count < last_ ? words_[static_cast<std::size_t>(count)] : 0;
            const std::int64_t sum = (negative ? -word : word) + carry;
            digits[static_cast<std::size_t>(count)] = static_cast<std::uint32_t>(sum);
            carry = sum >> 32;
        }
        while (count > first_ && digits[static_cast<std::size_t>(count) - 1] == 0) --count;
        if (count <= first_) return {0, 0};
        // The leading digit and three more have 97 bits that count, which rounds once, in effect, to 53.
        wide leading = 0;
        for (int k = 1; k <= 4; ++k)
            leading = leading << 32 | (count - k >= 0 ? digits[static_cast<std::size_t>(count - k)] : 0);
        int exponent = 0;
        const double mantissa = std::frexp(static_cast<double>(leading), &exponent);
        return {negative ? -mantissa : mantissa, exponent + 32 * (count - 4) - 3 * 1074};
    }

private:
    static constexpr int words = 3 * 2045 / 32 + 6;  // the greatest place of a mantissa is 2045

    std::array<std::int64_t, words> words_{};
    int first_ = words;
    int last_ = 0;
};

/// p - q, if no coordinate needs rounding (Knuth's two-sum; an overflow leaves a NaN behind and counts as rounded).
bool exact_difference(const vec3d& p, const vec3d& q, vec3d& difference) noexcept {
    bool exact = true;
    for (int k = 0; k < 3; ++k) {
        const double d = p[k] - q[k];
        const double q_part = p[k] - d;
        const double p_part = d + q_part;
        exact &= (p[k] - p_part) + (q_part - q[k]) == 0;
        difference[k] = d;
    }
    return exact;
}

/// The values as whole numbers of one unit, where each is less than 2^bits of them: so are the differences of floats
/// that are not too different in size, of points of a lattice, and of all that was measured in one unit.
/// @returns whether they are
template <std::size_t N>
bool as_integers(const std::array<double, N>& values, int bits, std::array<std::int64_t, N>& integers) noexcept {
    double largest = 0;
    for (const double v : values) largest = std::max(largest, std::abs(v));
    integers = {};
    if (largest == 0) return true;
    if (!(largest >= 0x1p-900 && largest <= 0x1p900)) return false;
    const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(largest) >> 52) - 1023;
    const auto scale = std::bit_cast<double>(static_cast<std::uint64_t>(1023 + bits - 1 - exponent) << 52);
    bool whole = true;
    for (std::size_t i = 0; i < N; ++i) {
        const double scaled = values[i] * scale;
        integers[i] = static_cast<std::int64_t>(scaled);
        whole &= static_cast<double>(integers[i]) == scaled && (integers[i] != 0 || values[i] == 0);
    }
    return whole;
}

__extension__ using wide_signed = __int128;

int sign_of(wide_signed x) noexcept {
    return (x > 0) - (x < 0);
}

/// The sign of det(p, q, r); false where the numbers have too many digits.
bool whole_volume_sign(const std::array<vec3d, 3>& rows, int& sign) noexcept {
    const auto& [p, q, r] = rows;
    std::array<std::int64_t, 9> n;
    // Six products of three numbers below 2^41 add up to less than 2^126.
    if (!as_integers(std::array{p[0], p[1], p[2], q[0], q[1], q[2], r[0], r[1], r[2]}, 41, n)) return false;
    const auto cross = [&](std::size_t i, std::size_t j) {
        return wide_signed{n[3 + i]} * n[6 + j] - wide_signed{n[3 + j]} * n[6 + i];
    };
    sign = sign_of(n[0] * cross(1, 2) + n[1] * cross(2, 0) + n[2] * cross(0, 1));
    return true;
}

/// The sign of p[x] q[y] - p[y] q[x], likewise.
bool whole_area_sign(const std::array<vec3d, 2>& rows, int x, int y, int& sign) noexcept {
    const auto& [p, q] = rows;
    std::array<std::int64_t, 4> n;
    if (!as_integers(std::array{p[x], p[y], q[x], q[y]}, 62, n)) return false;
    sign = sign_of(wide_signed{n[0]} * n[3] - wide_signed{n[1]} * n[2]);
    return true;
}

/// b, c and d from a, if no coordinate needs rounding.
bool exact_rows(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d, std::array<vec3d, 3>& rows) noexcept {
    return exact_difference(b, a, rows[0]) && exact_difference(c, a, rows[1]) && exact_difference(d, a, rows[2]);
}
bool exact_rows(const vec3d& a, const vec3d& b, const vec3d& c, std::array<vec3d, 2>& rows) noexcept {
    return exact_difference(b, a, rows[0]) && exact_difference(c, a, rows[1]);
}

product_sum volume_of(const std::array<vec3d, 3>& rows) noexcept {
    product_sum sum;
    sum.add_determinant(rows[0], rows[1], rows[2]);
    return sum;
}

/// Of points whose differences would be rounded.
product_sum volume_of(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) noexcept {
    product_sum sum;
    sum.add_determinant(b, c, d);
    sum.add_determinant(c, a, d);
    sum.add_determinant(a, b, d);
    sum.add_determinant(b, a, c);
    return sum;
}

product_sum area_of(const std::array<vec3d, 2>& rows, int x, int y) noexcept {
    product_sum sum;
    sum.add_cross(rows[0], rows[1], x, y);
    return sum;
}

/// Of points whose differences would be rounded.
product_sum area_of(const vec3d& a, const vec3d& b, const vec3d& c, int x, int y) noexcept {
    product_sum sum;
    sum.add_cross(a, b, x, y);
    sum.add_cross(b, c, x, y);
    sum.add_cross(c, a, x, y);
    return sum;
}

}  // namespace

int exact_side(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) noexcept {
    std::array<vec3d, 3> rows;
    if (!exact_rows(a, b, c, d, rows)) return volume_of(a, b, c, d).sign();
    int sign = 0;
    return whole_volume_sign(rows, sign) ? sign : volume_of(rows).sign();
}

int exact_turn(const vec3d& a, const vec3d& b, const vec3d& c, int axis) noexcept {
    const int x = (axis + 1) % 3;
    const int y = (axis + 2) % 3;
    std::array<vec3d, 2> rows;
    if (!exact_rows(a, b, c, rows)) return area_of(a, b, c, x, y).sign();
    int sign = 0;
    return whole_area_sign(rows, x, y, sign) ? sign : area_of(rows, x, y).sign();
}

scaled_double exact_volume(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) noexcept {
    std::array<vec3d, 3> rows;
    return (exact_rows(a, b, c, d, rows) ? volume_of(rows) : volume_of(a, b, c, d)).rounded();
}

scaled_double exact_area(const vec3d& a, const vec3d& b, const vec3d& c, int axis) noexcept {
    const int x = (axis + 1) % 3;
    const int y = (axis + 2) % 3;
    std::array<vec3d, 2> rows;
    return (exact_rows(a, b, c, rows) ? area_of(rows, x, y) : area_of(a, b, c, x, y)).rounded();
}

}  // namespace aabb
