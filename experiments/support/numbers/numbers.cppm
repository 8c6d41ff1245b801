/// Numbers as people read them.
export module aabblab.numbers;

import aabb.std;

export namespace aabblab {

/// "12,345".
[[nodiscard]] std::string grouped(std::uint64_t n);

/// "12,345 objects", "1 frame".
/// @param what one of them is called
[[nodiscard]] std::string counted(std::uint64_t n, std::string_view what);

/// With three digits that count, or all that stand before the point: "0.00123", "0.123", "12.3", "1234"; at most six
/// behind the point.
[[nodiscard]] std::string three_digits(double value);

}  // namespace aabblab
