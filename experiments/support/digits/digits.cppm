/// Computed numbers without the digits that only rounding has made, as files have them.
export module aabblab.digits;

import aabb.std;

export namespace aabblab {

/// "0.3", of 0.1 + 0.2: fifteen digits, which every double keeps.
[[nodiscard]] std::string fifteen_digits(double value);

/// Milliseconds, rounded to the nanoseconds that clocks count in; sums are off by a little.
[[nodiscard]] double whole_nanoseconds(double ms);

}  // namespace aabblab
