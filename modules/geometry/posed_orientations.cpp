module aabb.geometry;

import :wide_integer;

namespace aabb {

namespace {

/// The integers of all corners in units of 2^unit, which divides every term.
template <std::size_t Limbs>
std::array<vec3<wide_integer<Limbs>>, 6> integers_of(const std::array<corner_terms, 6>& corners, int unit) noexcept {
    std::array<vec3<wide_integer<Limbs>>, 6> integers{};
    for (std::size_t c = 0; c < 6; ++c)
        for (std::size_t k = 0; k < 3; ++k)
            for (const product_of_doubles& t : corners[c][k])
                if (t.magnitude != 0)
                    integers[c][static_cast<int>(k)].add(t.magnitude, t.exponent - unit, t.is_negative);
    return integers;
}

/// Whether three corners, from `first` on, are all below those from `second` on.
template <class Corners>
bool are_below(const Corners& corners, std::size_t first, std::size_t second, int axis) noexcept {
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            if ((corners[first + i][axis] - corners[second + j][axis]).sign() >= 0) return false;
    return true;
}

/// det(b - a, c - a, d - a) of four corners.
template <class Corners>
auto volume_of(const Corners& corners, int a, int b, int c, int d) noexcept {
    const auto at = [&](int i) -> const auto& { return corners[static_cast<std::size_t>(i)]; };
    const auto p = at(b) - at(a), q = at(c) - at(a), r = at(d) - at(a);
    const auto along = [&](int x, int y, int z) { return (p[x] * q[y] - p[y] * q[x]) * r[z]; };
    return along(0, 1, 2) + along(1, 2, 0) + along(2, 0, 1);
}

/// The component of (b - a) × (c - a) along an axis.
template <class Corners>
auto area_of(const Corners& corners, int a, int b, int c, int axis) noexcept {
    const auto at = [&](int i) -> const auto& { return corners[static_cast<std::size_t>(i)]; };
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    const auto p = at(b) - at(a), q = at(c) - at(a);
    return p[x] * q[y] - p[y] * q[x];
}

/// Rounds an integer. At least 65 of its leading 128 bits are significant, so rounding these to 53 is in effect the
/// only rounding.
template <std::size_t Limbs>
scaled_double rounded(const wide_integer<Limbs>& integer) noexcept {
    const wide_integer<Limbs> magnitude = integer.magnitude();
    std::size_t top = Limbs;
    while (top > 0 && magnitude.limb[top - 1] == 0) --top;
    if (top == 0) return {0, 0};
    const unsigned_128 leading =
        unsigned_128{magnitude.limb[top - 1]} << 64U | (top > 1 ? magnitude.limb[top - 2] : std::uint64_t{0});
    int exponent = 0;
    const double mantissa = std::frexp(static_cast<double>(leading), &exponent);
    return {integer.sign() < 0 ? -mantissa : mantissa, exponent + 64 * (static_cast<int>(top) - 2)};
}

/// What `compute` returns for corners of whatever width; unlike `std::visit`, it cannot throw.
template <class Corners, class Compute>
auto compute_in(const Corners& corners, const Compute& compute) noexcept {
    if (const auto* const narrow = std::get_if<0>(&corners)) return compute(*narrow);
    if (const auto* const medium = std::get_if<1>(&corners)) return compute(*medium);
    if (const auto* const wide = std::get_if<2>(&corners)) return compute(*wide);
    return compute(*std::get_if<3>(&corners));
}

}  // namespace

/// Finds the unit and the width of the integers. A coordinate of four terms below 2^end is below 2^(end + 2), so that
/// differences are below 2^(end + 3); with a bit for the sign, a component of a normal fits twice as many limbs, and a
/// determinant, below 6 · 2^(3 (end + 3)) < 2^(3 (end + 4)), three times.
exact_corners::exact_corners(const std::array<posed_point, 6>& points) noexcept {
    std::array<corner_terms, 6> corners;
    term_range range;
    for (std::size_t c = 0; c < 6; ++c) {
        corners[c] = terms_of(*points[c].at, *points[c].vertex);
        range.note(corners[c]);
    }
    unit_ = range.unit();
    const int bits = range.bits() + 5;
    if (bits <= 3 * 64)
        corners_ = integers_of<3>(corners, unit_);
    else if (bits <= 8 * 64)
        corners_ = integers_of<8>(corners, unit_);
    else if (bits <= 20 * 64)
        corners_ = integers_of<20>(corners, unit_);
    else
        corners_ = integers_of<68>(corners, unit_);
}

int exact_corners::side(int a, int b, int c, int d) const noexcept {
    return compute_in(corners_, [&](const auto& corners) { return volume_of(corners, a, b, c, d).sign(); });
}

scaled_double exact_corners::volume(int a, int b, int c, int d) const noexcept {
    return compute_in(corners_, [&](const auto& corners) { return rounded(volume_of(corners, a, b, c, d)); });
}

bool exact_corners::boxes_are_disjoint() const noexcept {
    const int separating_axes = compute_in(corners_, [](const auto& corners) {
        return static_cast<int>(std::ranges::count_if(std::array{0, 1, 2}, [&](int axis) {
            return are_below(corners, 0, 3, axis) || are_below(corners, 3, 0, axis);
        }));
    });
    return separating_axes != 0;
}

int exact_corners::turn(int a, int b, int c, int axis) const noexcept {
    return compute_in(corners_, [&](const auto& corners) { return area_of(corners, a, b, c, axis).sign(); });
}

scaled_double exact_corners::area(int a, int b, int c, int axis) const noexcept {
    return compute_in(corners_, [&](const auto& corners) { return rounded(area_of(corners, a, b, c, axis)); });
}

int exact_corners::order(int a, int b, int axis) const noexcept {
    return compute_in(corners_, [&](const auto& corners) {
        return (corners[static_cast<std::size_t>(a)][axis] - corners[static_cast<std::size_t>(b)][axis]).sign();
    });
}

rounded_coordinate exact_corners::coordinate(int corner, int axis) const noexcept {
    return compute_in(corners_, [&](const auto& corners) {
        const auto& integer = corners[static_cast<std::size_t>(corner)][axis];
        const auto [mantissa, exponent] = rounded(integer);
        const double value = std::ldexp(mantissa, exponent + unit_);
        // A denormal double has fewer digits.
        const int digits = std::min(53, exponent + unit_ + 1074);
        return rounded_coordinate{value, mantissa == 0 || (std::isfinite(value) && integer.has_digits(digits))};
    });
}

}  // namespace aabb
