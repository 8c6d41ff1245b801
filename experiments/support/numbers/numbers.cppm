/// Numbers as people read them, and as files have them.
export module aabblab.numbers;

import aabb.std;

export namespace aabblab {

/// "12,345".
[[nodiscard]] std::string grouped(std::uint64_t n);

/// "12,345 objects", "1 frame".
/// @param what one of them is called
[[nodiscard]] std::string counted(std::uint64_t n, std::string_view what);

/// With three digits that count, or all before the point: "0.00123", "0.123", "12.3", "1234"; at most six behind it.
[[nodiscard]] std::string three_digits(double value);

/// "0.3", of 0.1 + 0.2: fifteen digits, which every double keeps, without those that only rounding has made.
[[nodiscard]] std::string fifteen_digits(double value);

/// Milliseconds, rounded to the nanoseconds that clocks count in; sums are off by a little.
[[nodiscard]] double whole_nanoseconds(double ms);

}  // namespace aabblab
