#include "number.hpp"

#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

import aabb;

namespace aabblab {

template <class Real>
Real parse_number(const std::string& text) {
    char* end = nullptr;
    Real value;
    // strtof and strtod round correctly; a double rounded again to float would not always be the nearest float.
    if constexpr (std::same_as<Real, float>)
        value = std::strtof(text.c_str(), &end);
    else
        value = std::strtod(text.c_str(), &end);
    if (text.empty() || end != text.c_str() + text.size()) throw aabb::input_error("'" + text + "' is not a number");
    if (std::isfinite(value)) return value;
    const bool too_large = std::isinf(value) && text.find_first_of("0123456789") != std::string::npos;
    throw aabb::input_error("'" + text + "' is " + (too_large ? "too large" : "not finite"));
}

template float parse_number<float>(const std::string&);
template double parse_number<double>(const std::string&);

std::vector<std::string> split_numbers(std::string_view line) {
    constexpr std::string_view separators = " ,\t\r";
    std::vector<std::string> words;
    while (true) {
        const std::size_t begin = line.find_first_not_of(separators);
        if (begin == std::string_view::npos) return words;
        line.remove_prefix(begin);
        words.emplace_back(line.substr(0, line.find_first_of(separators)));
        line.remove_prefix(words.back().size());
    }
}

}  // namespace aabblab
