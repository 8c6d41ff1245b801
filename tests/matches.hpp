#pragma once

#include <regex>

#include "testing.hpp"

/// What the pattern's first group takes from a text, each time.
[[nodiscard]] inline std::vector<std::string> found_in(const std::string& text, const std::string& pattern) {
    std::vector<std::string> all;
    const std::regex wanted(pattern);
    for (std::sregex_iterator i(text.begin(), text.end(), wanted), end; i != end; ++i) all.push_back((*i)[1]);
    return all;
}
