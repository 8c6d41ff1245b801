module aabb.distance.box_gap;

import aabb.distance.exact_integer;

namespace aabb {

/// All bounds and d are integers of the least unit that divides them, below 2^2098; gaps have a bit more, and the sum
/// of three squares two more than a square: 2 · 2099 + 2 bits fit 66 limbs.
bool are_within_exactly(const boxd& a, const boxd& b, double d) noexcept {
    using integer = exact_integer<72>;
    int unit = std::numeric_limits<int>::max();
    const auto note = [&](double x) {
        if (const odd_double parts(x); parts.mantissa != 0) unit = std::min(unit, parts.exponent);
    };
    note(d);
    for (const boxd* x : {&a, &b})
        for (int k = 0; k < 3; ++k) {
            note(x->min[k]);
            note(x->max[k]);
        }
    const auto in_units = [&](double x) {
        const odd_double parts(x);
        return parts.mantissa == 0 ? integer() : integer(parts.mantissa, parts.exponent - unit, parts.is_negative);
    };
    integer sum;
    for (int k = 0; k < 3; ++k) {
        const bool b_is_above = b.min[k] > a.max[k];
        if (!b_is_above && !(a.min[k] > b.max[k])) continue;
        const integer gap =
            b_is_above ? in_units(b.min[k]) - in_units(a.max[k]) : in_units(a.min[k]) - in_units(b.max[k]);
        sum = sum + gap * gap;
    }
    const integer bound = in_units(d);
    return sum <= bound * bound;
}

}  // namespace aabb
