#pragma once

#include <regex>

#include "testing.hpp"

/// The first group of each match of the pattern in a text.
[[nodiscard]] inline std::vector<std::string> found_in(const std::string& text, const std::string& pattern) {
    std::vector<std::string> matches;
    const std::regex regex(pattern);
    for (std::sregex_iterator i(text.begin(), text.end(), regex), end; i != end; ++i) matches.push_back((*i)[1]);
    return matches;
}
