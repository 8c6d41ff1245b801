/// Computes the range of an axis and its ticks.
export module aabblab.scale;

import aabb.std;
import aabblab.fmt;

namespace aabblab {

export struct tick {
    double at;
    std::string label;    ///< empty for a small tick
    std::string power{};  ///< superscript after the label: "6" in 10^6
};

export struct scale {
    double from, to;
    bool logarithmic;
    std::vector<tick> ticks{};
    bool named = false;  ///< ticks have names, not numbers

    /// 0 at the left or lower end, 1 at the other.
    [[nodiscard]] double place(double value) const {
        return logarithmic ? std::log(value / from) / std::log(to / from) : (value - from) / (to - from);
    }
};

export enum class scale_end : unsigned char {
    near_values,  ///< slightly beyond the values
    on_ticks,     ///< on a tick if the axis is linear, and at 0 if that is near
};

/// The decimal exponent of the first digit.
[[nodiscard]] int exponent_of(double value) {
    return static_cast<int>(std::floor(std::log10(value) + 1e-9));
}

/// The smallest step of 1, 2 or 5 times a power of ten for which at most `most` fit into the span.
export [[nodiscard]] double round_step(double span, double most) {
    const double least = span / most;
    const double power = std::pow(10, exponent_of(least));
    for (const double times : {1, 2, 5})
        if (times * power >= least * (1 - 1e-9)) return times * power;
    return 10 * power;
}

/// The multiples of the step from `from` to `to`; ends that are multiples up to rounding are included.
export [[nodiscard]] std::vector<double> round_values(double from, double to, double step) {
    const double first = std::ceil(from / step - 1e-6);  // as a multiple
    std::vector<double> values;
    // Counted by an integer, because far from 0 adding a small step may have no effect.
    for (int i = 0; i <= std::floor(to / step + 1e-6) - first; ++i)
        values.push_back((first + i) * step + 0.0);  // turns -0 into 0
    return values;
}

[[nodiscard]] std::string number_text(double value, int decimals) {
    std::string digits = fmt::format("{:.{}f}", std::abs(value), decimals);
    for (std::size_t i = std::min(digits.find('.'), digits.size()); i > 3; i -= 3) digits.insert(i - 3, ",");
    return (value < 0 ? "\u2212" : "") + digits;
}

[[nodiscard]] tick power_tick(double at, double mantissa, int exponent, int decimals) {
    return {at, mantissa == 1 ? "10" : number_text(mantissa, decimals) + "\u00d710", number_text(exponent, 0)};
}

/// Ticks at the multiples of a step, labelled with numbers. If these are very large or very small (`has_power`), all
/// have one power of ten, that of the largest: 0.5 x 10^7, 1 x 10^7.
[[nodiscard]] std::vector<tick> linear_ticks(double from, double to, double step) {
    const std::vector<double> values = round_values(from, to, step);
    double largest = 0;
    for (const double at : values) largest = std::max(largest, std::abs(at));
    const bool has_power = largest >= 1e7 || step < 1e-5;
    const int exponent = has_power ? exponent_of(largest) : 0;
    const int decimals = std::max(0, exponent - exponent_of(step));  // enough to distinguish neighbouring ticks
    std::vector<tick> ticks;
    for (const double at : values)
        ticks.push_back(has_power && at != 0 ? power_tick(at, at * std::pow(10, -exponent), exponent, decimals)
                                             : tick{at, number_text(at, has_power ? 0 : decimals)});
    return ticks;
}

/// Ticks of a logarithmic axis: at 1, 2, … 9 times each power of ten, or only at the powers if `decades` is above 1.
/// Those at the given multiples of every `decades`-th power have labels.
[[nodiscard]] std::vector<tick> decade_ticks(double from, double to, std::span<const int> multiples, int decades) {
    const bool has_power = from < 0.9e-4 || to > 1.1e6;  // 1e-4 and 1e6, with some room for wider ends
    std::vector<tick> ticks;
    for (int exponent = exponent_of(from); exponent <= exponent_of(to); ++exponent)
        for (int multiple = 1; multiple < 10; ++multiple) {
            // Division, because powers below 1 are not exact.
            const double value = exponent < 0 ? multiple / std::pow(10, -exponent) : multiple * std::pow(10, exponent);
            if (value < from * (1 - 1e-9) || value > to * (1 + 1e-9)) continue;
            const bool is_labelled = std::ranges::find(multiples, multiple) != multiples.end();
            if (is_labelled && exponent % decades == 0)
                ticks.push_back(has_power ? power_tick(value, multiple, exponent, 0)
                                          : tick{value, number_text(value, std::max(0, -exponent))});
            else if (decades == 1 || multiple == 1)
                ticks.push_back({value, {}});
        }
    return ticks;
}

/// Ticks of a logarithmic axis, with at least three labels: at powers of ten (not all, in long ranges), or else also at
/// 2 and 5 times these, or else at the multiples of a round step, as in a range within one decade.
[[nodiscard]] std::vector<tick> log_ticks(double from, double to) {
    constexpr std::array<int, 3> multiples{1, 2, 5};
    const auto has_three_labels = [](const std::vector<tick>& ticks) {
        return std::ranges::count_if(ticks, [](const tick& t) { return !t.label.empty(); }) >= 3;
    };
    const int decades = 1 + static_cast<int>(std::log10(to / from) / 7);  // seven labels are readable
    const std::span powers = std::span(multiples).first(1);
    if (auto ticks = decade_ticks(from, to, powers, decades); has_three_labels(ticks)) return ticks;
    if (auto ticks = decade_ticks(from, to, multiples, 1); has_three_labels(ticks)) return ticks;
    return linear_ticks(from, to, round_step(to - from, /*most=*/6));
}

/// The scale of an axis that shows the values from `least` to `greatest`. It is somewhat wider, so that no value lies
/// on the border. The values may be equal; on a logarithmic axis they must be positive.
/// @param end where a linear axis ends: on ticks, or near the values
export [[nodiscard]] scale scale_of(double least, double greatest, bool logarithmic, scale_end end) {
    scale s{.from = least, .to = greatest, .logarithmic = logarithmic};
    if (logarithmic) {
        const double beyond = least == greatest ? 2 : std::pow(greatest / least, 0.04);
        s.from = least / beyond;
        s.to = greatest * beyond;
        s.ticks = log_ticks(s.from, s.to);
        return s;
    }
    if (least == greatest) {
        const double beyond = least == 0 ? 1 : std::abs(least) / 2;
        s.from -= beyond;
        s.to += beyond;
    }
    if (end == scale_end::on_ticks) {
        // From zero the axis shows proportions. It begins there if the values still fill half of it.
        if (s.from > 0 && s.from <= s.to / 2) s.from = 0;
        const double step = round_step(s.to - s.from, /*most=*/5);
        s.from = std::floor(s.from / step + 1e-6) * step;
        s.to = std::ceil(s.to / step - 1e-6) * step;
        s.ticks = linear_ticks(s.from, s.to, step);
    } else {
        const double beyond = 0.03 * (s.to - s.from);
        s.from = s.from >= 0 && s.from <= 3 * beyond ? 0 : s.from - beyond;  // not slightly above or below zero
        s.to += beyond;
        s.ticks = linear_ticks(s.from, s.to, round_step(s.to - s.from, /*most=*/6));
    }
    return s;
}

}  // namespace aabblab
