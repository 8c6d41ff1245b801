#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace aabblab {

/// A number in decimal or C99 hexadecimal, correctly rounded to Real, which is float or double.
/// @throws aabb::input_error on anything else, NaN, infinity, or a number too large for Real: "'x' is not a number".
template <class Real>
[[nodiscard]] Real parse_number(const std::string& text);

/// Of --seconds, a number above 0, at most a million.
/// @param to_do what it is the time for, as in "race"
/// @throws aabb::input_error on anything else.
[[nodiscard]] double seconds_of(const std::string& text, std::string_view to_do);

/// The words of a line of numbers, with blanks or one comma between two of them.
/// @throws aabb::input_error on a comma that has no word on either side.
[[nodiscard]] std::vector<std::string> split_numbers(std::string_view line);

}  // namespace aabblab
