module aabb.geometry;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb {

namespace {

/// Computes p - q and returns whether it is exact (Knuth's two-sum; an overflow yields NaN and counts as inexact).
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

__extension__ using wide_signed = __int128;

using vec3i = vec3<std::int64_t>;

/// Quantizes points to a grid, whose step on each axis is the power of two such that the largest coordinate is at least
/// 2^59 and less than 2^60 steps. Coordinates are truncated, so their error is less than one step, and that of a
/// difference, which is below 2^61, less than two.
class grid {
public:
    /// @param points all points to be quantized; their largest coordinate on an axis sets the step
    explicit grid(std::initializer_list<const vec3d*> points) noexcept {
        for (int k = 0; k < 3; ++k) {
            double largest = 0;
            for (const vec3d* p : points) largest = std::max(largest, std::abs((*p)[k]));
            const int exponent = std::max(static_cast<int>(std::bit_cast<std::uint64_t>(largest) >> 52), 1) - 1023;
            // Scales the largest to 2^59 at least, by two factors, as their product may exceed the range of double.
            const int up = 59 - exponent;
            factor_[k] = power_of_two(up / 2);
            second_factor_[k] = power_of_two(up - up / 2);
        }
    }

    /// The coordinates of a point in steps, truncated.
    [[nodiscard]] vec3i operator()(const vec3d& p) noexcept {
        vec3i truncated;
        for (int k = 0; k < 3; ++k) {
            const double steps = p[k] * factor_[k] * second_factor_[k];  // their product might overflow
            truncated[k] = static_cast<std::int64_t>(steps);
            is_exact_ &= static_cast<double>(truncated[k]) == steps;
            // A coordinate that underflows to zero steps is inexact.
            is_exact_ &= steps != 0 || p[k] == 0;
        }
        return truncated;
    }

    /// Whether no coordinate has been truncated so far.
    [[nodiscard]] bool is_exact() const noexcept { return is_exact_; }

private:
    static double power_of_two(int exponent) noexcept {
        return std::bit_cast<double>(static_cast<std::uint64_t>(1023 + exponent) << 52);
    }

    vec3d factor_{};
    vec3d second_factor_{};
    bool is_exact_ = true;
};

using vec3w = vec3<wide_signed>;

vec3w wide_cross(const vec3i& p, const vec3i& q) noexcept {
    const auto component = [&](int x, int y) { return wide_signed{p[x]} * q[y] - wide_signed{p[y]} * q[x]; };
    return {component(1, 2), component(2, 0), component(0, 1)};
}

/// The sign of normal · p in steps of a grid, for differences below 2^61 from `grid`. If coordinates were truncated,
/// the error of six products of three differences with errors below 2 is less than 6 · 3 · 2 · 2^122 (1 + 2^-59) <
/// 2^128.
/// @returns whether the sign is certain
bool volume_sign(const vec3w& normal, const vec3i& p, bool is_exact, int& sign) noexcept {
    // The normal is below 2^123. Its upper and lower 64 bits times p below 2^61, three times, fit 128 bits.
    wide_signed high = 0, low = 0;
    for (int k = 0; k < 3; ++k) {
        high += (normal[k] >> 64) * p[k];
        low += wide_signed{static_cast<std::uint64_t>(normal[k])} * p[k];
    }
    high += low >> 64;
    sign = high < 0 ? -1 : static_cast<int>(high > 0 || static_cast<std::uint64_t>(low) != 0);
    constexpr wide_signed least = wide_signed{1} << 64;
    return is_exact || high >= least || high <= -least;
}

/// Likewise, the sign of the component of p × q between the axes x and y: the error of two products of two differences
/// is less than 2 · 2 · 2 · 2^61 (1 + 2^-60) < 2^65.
bool area_sign(const vec3i& p, const vec3i& q, int x, int y, bool is_exact, int& sign) noexcept {
    const wide_signed area = wide_signed{p[x]} * q[y] - wide_signed{p[y]} * q[x];
    sign = static_cast<int>(area > 0) - static_cast<int>(area < 0);
    constexpr wide_signed least = wide_signed{1} << 65;
    return is_exact || area >= least || area <= -least;
}

/// The determinant of `exact_side`, as a sum of products of differences, or of coordinates if one is inexact.
product_sum volume_of(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) noexcept {
    product_sum sum;
    vec3d p{}, q{}, r{};
    if (exact_difference(b, a, p) && exact_difference(c, a, q) && exact_difference(d, a, r)) {
        sum.add_determinant(p, q, r);
        return sum;
    }
    sum.add_determinant(b, c, d);
    sum.add_determinant(c, a, d);
    sum.add_determinant(a, b, d);
    sum.add_determinant(b, a, c);
    return sum;
}

/// Twice the area of abc in the plane of the axes x and y, positive if counter-clockwise, as a sum of products.
product_sum area_of(const vec3d& a, const vec3d& b, const vec3d& c, int x, int y) noexcept {
    product_sum sum;
    vec3d p{}, q{};
    if (exact_difference(b, a, p) && exact_difference(c, a, q)) {
        sum.add_cross(p, q, x, y);
        return sum;
    }
    sum.add_cross(a, b, x, y);
    sum.add_cross(b, c, x, y);
    sum.add_cross(c, a, x, y);
    return sum;
}

}  // namespace

/// Computes in integers on a grid; if truncation leaves the sign uncertain, by an exact sum of products.
int exact_side(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) noexcept {
    grid steps{&a, &b, &c, &d};
    const vec3i origin = steps(a);
    const vec3w normal = wide_cross(steps(b) - origin, steps(c) - origin);
    const vec3i p = steps(d) - origin;
    int sign = 0;
    return volume_sign(normal, p, steps.is_exact(), sign) ? sign : volume_of(a, b, c, d).sign();
}

/// The `exact_side` of each corner of `s`, with the grid and the normal of `t` computed only once: in integers, or by
/// an exact sum of products if truncation to the grid leaves a sign uncertain.
corner_sides exact_sides(const triangle3d& s, const triangle3d& t) noexcept {
    grid steps{&s[0], &s[1], &s[2], &t[0], &t[1], &t[2]};
    const vec3i origin = steps(t[0]);
    const vec3w normal = wide_cross(steps(t[1]) - origin, steps(t[2]) - origin);
    const std::array<vec3i, 3> corners{steps(s[0]) - origin, steps(s[1]) - origin, steps(s[2]) - origin};
    std::array<int, 3> signs{};
    for (std::size_t i = 0; i < 3; ++i)
        if (!volume_sign(normal, corners[i], steps.is_exact(), signs[i]))
            signs[i] = volume_of(t[0], t[1], t[2], s[static_cast<int>(i)]).sign();
    return corner_sides(signs);
}

/// The orientation of abc projected along an axis. It is computed in integers on a grid; if truncation to the grid
/// leaves the sign uncertain, by an exact sum of products.
int exact_turn(const vec3d& a, const vec3d& b, const vec3d& c, int axis) noexcept {
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    grid steps{&a, &b, &c};
    const vec3i origin = steps(a);
    const vec3i p = steps(b) - origin;
    const vec3i q = steps(c) - origin;
    // The sign is certain if no coordinate was truncated, or if the area exceeds the error of truncation.
    int sign = 0;
    const bool is_certain = area_sign(p, q, x, y, steps.is_exact(), sign);
    return is_certain ? sign : area_of(a, b, c, x, y).sign();
}

/// Whether coordinates are such small multiples of a unit on their axis that orientations in double are exact. Adding a
/// large number and subtracting it again rounds a coordinate to a multiple.
bool are_on_lattice(const triangle3d& s, const triangle3d& t, const vec3d& extent) noexcept {
    vec3d rounder{};
    for (int k = 0; k < 3; ++k) {
        if (extent[k] != 0 && !(extent[k] >= 0x1p-200 && extent[k] <= 0x1p200)) return false;
        // The extent is at least 2^15 units and less than 2^16. From 2^52 to 2^53 units the last digit of a double is
        // one unit, so adding 1.5 · 2^52 units rounds a coordinate below 2^50 units to an integer.
        const std::uint64_t exponent = extent[k] == 0 ? 1023 : std::bit_cast<std::uint64_t>(extent[k]) >> 52;
        rounder[k] = 1.5 * std::bit_cast<double>((exponent + 52 - 15) << 52);
    }
    const lanes<double> round = coordinates(rounder);
    const lanes<double> largest = round / 8;
    const auto is_flat = coordinates(extent) == 0;
    auto on_lattice = round == round;
    for (const triangle3d* of : {&s, &t})
        for (int i = 0; i < 3; ++i) {
            const lanes<double> p = coordinates((*of)[i]);
            on_lattice &= is_flat | (((p + round) - round == p) & (p <= largest) & (p >= -largest));
        }
    return bits(on_lattice) == 7;
}

scaled_double exact_volume(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) noexcept {
    return volume_of(a, b, c, d).rounded();
}
scaled_double exact_area(const vec3d& a, const vec3d& b, const vec3d& c, int axis) noexcept {
    return area_of(a, b, c, (axis + 1) % 3, (axis + 2) % 3).rounded();
}

}  // namespace aabb
