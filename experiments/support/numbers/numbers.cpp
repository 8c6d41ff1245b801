module aabblab.numbers;

import aabblab.fmt;

namespace aabblab {

std::string grouped(std::uint64_t n) {
    std::string digits = std::to_string(n);
    for (std::size_t at = digits.size(); at > 3;) digits.insert(at -= 3, ",");
    return digits;
}

std::string counted(std::uint64_t n, std::string_view what) {
    return grouped(n) + " " + std::string(what) + (n == 1 ? "" : "s");
}

std::string three_digits(double value) {
    if (value == 0) return "0";
    // Rounding may carry into another digit: 9.996 becomes 10.0.
    const double rounded = std::strtod(fmt::format("{:.2e}", value).c_str(), nullptr);
    const int before_point = static_cast<int>(std::floor(std::log10(std::abs(rounded)))) + 1;
    return fmt::format("{:.{}f}", value, std::clamp(3 - before_point, 0, 6));
}

std::string fifteen_digits(double value) {
    return fmt::format("{:.15g}", value);
}

double whole_nanoseconds(double ms) {
    return std::round(ms * 1e6) / 1e6;
}

}  // namespace aabblab
