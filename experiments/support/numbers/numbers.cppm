/// Formats numbers for readers and for files.
export module aabblab.numbers;

import aabb.std;
import aabblab.fmt;

export namespace aabblab {

/// "12,345".
[[nodiscard]] std::string grouped(std::uint64_t n) {
    std::string digits = std::to_string(n);
    for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, ",");
    return digits;
}

/// "12,345 objects", "1 frame".
/// @param what the singular noun
[[nodiscard]] std::string counted(std::uint64_t n, std::string_view what) {
    return grouped(n) + " " + std::string(what) + (n == 1 ? "" : "s");
}

/// Three significant digits, or all before the point: "0.00123", "0.123", "12.3", "1234"; at most six decimals.
[[nodiscard]] std::string three_digits(double value) {
    if (value == 0) return "0";
    // Rounding may carry into another digit: 9.996 becomes 10.0.
    const double rounded = std::strtod(fmt::format("{:.2e}", value).c_str(), nullptr);
    const int before_point = static_cast<int>(std::floor(std::log10(std::abs(rounded)))) + 1;
    return fmt::format("{:.{}f}", value, std::clamp(3 - before_point, 0, 6));
}

/// "0.3" for 0.1 + 0.2: fifteen significant digits, which hide rounding errors in the last bits of a double.
[[nodiscard]] std::string fifteen_digits(double value) {
    return fmt::format("{:.15g}", value);
}

/// Milliseconds rounded to whole nanoseconds, the unit of clocks, which removes rounding errors of sums.
[[nodiscard]] double whole_nanoseconds(double ms) {
    return std::round(ms * 1e6) / 1e6;
}

}  // namespace aabblab
