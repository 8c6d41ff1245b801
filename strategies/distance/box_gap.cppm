/// Distances of boxes, compared with a given one exactly.
export module aabb.distance.box_gap;

export import aabb.geometry;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// The distance of two boxes: the length of the shortest segment between them, or the greatest of their gaps on the
/// axes.
enum class box_metric : std::uint8_t { euclidean, axis };

/// Whether a distance is finite and not negative, as every function here requires.
/// @throws input_error
inline void require_distance(double d) {
    if (!(d >= 0 && d <= std::numeric_limits<double>::max()))
        throw input_error("a distance is a finite number that is not negative");
}

/// Whether the sum of the squared gaps is at most d², in integers of any size.
/// @param a,b disjoint on an axis or not
[[nodiscard]] bool are_within_exactly(const boxd& a, const boxd& b, double d) noexcept;

/// Whether the distance of two closed boxes is at most d, exactly: boxes that touch have distance 0.
///
/// On an axis, let p - q be the gap and s = fl(p - q). Rounding is monotone and d is a double: if p - q <= d then s <=
/// d, and if s < d then p - q < d. If s = d, the sign of the rounding error of s decides, which is computed without
/// error (Knuth, "The art of computer programming", 4.2.2) as s is then finite.
///
/// The sum of three squared gaps has no cancellation: each term is rounded three times in effect (the gap counts twice,
/// its square once), the sums round twice, d² once. So 16 u of d², u = 2^-53, is more than the errors of both; d² is
/// kept where neither it nor a square that could matter leaves the normal numbers. In between, integers decide.
[[nodiscard]] inline bool are_within(const boxd& a, const boxd& b, double d,
                                     box_metric metric = box_metric::euclidean) noexcept {
    double sum = 0;
    bool is_disjoint = false;
    for (int k = 0; k < 3; ++k) {
        const bool b_is_above = b.min[k] > a.max[k];
        if (!b_is_above && !(a.min[k] > b.max[k])) continue;
        is_disjoint = true;
        const double p = b_is_above ? b.min[k] : a.min[k];
        const double q = b_is_above ? a.max[k] : b.max[k];
        const double gap = p - q;
        if (gap > d) return false;
        if (gap == d) {
            const double of_q = p - gap;
            const double error = (p - (gap + of_q)) + (of_q - q);  // (p - q) - gap
            if (error > 0) return false;
        }
        sum += gap * gap;
    }
    if (!is_disjoint || metric == box_metric::axis) return true;
    const double square = d * d;
    if (square >= 0x1p-960 && square <= 0x1p1000) {
        constexpr double margin = 16 * (std::numeric_limits<double>::epsilon() / 2);
        if (sum <= square * (1 - margin)) return true;
        if (sum >= square * (1 + margin)) return false;
    }
    return are_within_exactly(a, b, d);
}

[[nodiscard]] inline bool are_within(const box& a, const box& b, double d,
                                     box_metric metric = box_metric::euclidean) noexcept {
    const auto widened = [](const box& x) { return boxd{in_double(x.min), in_double(x.max)}; };
    return are_within(widened(a), widened(b), d, metric);
}

/// A box grown on every side by at least half of d, and by 2^-22 of its bounds, so that boxes at distance d or less, in
/// either metric, overlap once they are grown, and also if each bound was rounded to float before.
///
/// The sum of a bound and half of d is rounded to double, moved by 2^-21 of its magnitude and that of the bound, and
/// rounded to float, by 2^-24 of its magnitude or 2^-150. Bounds are clamped to the range of float, which is monotone.
[[nodiscard]] inline box grown(const box& b, double d) noexcept {
    constexpr double most = std::numeric_limits<float>::max();
    const double half = d / 2;
    box larger;
    for (int k = 0; k < 3; ++k) {
        const double low = b.min[k] - half, high = b.max[k] + half;
        const auto margin = [](double moved, float bound) {
            return 0x1p-21 * (std::abs(moved) + std::abs(double{bound})) + 0x1p-147;
        };
        larger.min[k] = static_cast<float>(std::clamp(low - margin(low, b.min[k]), -most, most));
        larger.max[k] = static_cast<float>(std::clamp(high + margin(high, b.max[k]), -most, most));
    }
    return larger;
}

/// The same in double: the sum is rounded by 2^-53 of its magnitude, and moved by 2^-50.
[[nodiscard]] inline boxd grown(const boxd& b, double d) noexcept {
    constexpr double most = std::numeric_limits<double>::max();
    const double half = d / 2;
    boxd larger;
    for (int k = 0; k < 3; ++k) {
        const double low = b.min[k] - half, high = b.max[k] + half;
        const auto margin = [](double moved) { return 0x1p-50 * std::abs(moved) + 0x1p-1070; };
        larger.min[k] = std::clamp(low - margin(low), -most, most);
        larger.max[k] = std::clamp(high + margin(high), -most, most);
    }
    return larger;
}

}  // namespace aabb
