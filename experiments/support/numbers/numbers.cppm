/// Formats numbers for readers and for files.
export module aabblab.numbers;

import aabb.std;

export namespace aabblab {

/// "12,345".
[[nodiscard]] std::string grouped(std::uint64_t n);

/// "12,345 objects", "1 frame".
/// @param what the singular noun
[[nodiscard]] std::string counted(std::uint64_t n, std::string_view what);

/// Three significant digits, or all before the point: "0.00123", "0.123", "12.3", "1234"; at most six decimals.
[[nodiscard]] std::string three_digits(double value);

/// "0.3" for 0.1 + 0.2: fifteen significant digits, which hide rounding errors in the last bits of a double.
[[nodiscard]] std::string fifteen_digits(double value);

/// Milliseconds rounded to whole nanoseconds, the unit of clocks, which removes rounding errors of sums.
[[nodiscard]] double whole_nanoseconds(double ms);

}  // namespace aabblab
