#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace aabblab {

/// A number in decimal or C99 hexadecimal, correctly rounded to Real, which is float or double.
/// @throws aabb::input_error on anything else, NaN, infinity, or a number too large for Real: "'x' is not a number".
template <class Real>
[[nodiscard]] Real parse_number(const std::string& text);

/// The words of a line of numbers: what stands between blanks and commas.
[[nodiscard]] std::vector<std::string> split_numbers(std::string_view line);

}  // namespace aabblab
