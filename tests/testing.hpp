#pragma once

// What most tests include: Catch2, and what they use of the standard library. Other modules are imported after it.

#include <algorithm>
#include <array>
#include <bit>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_exception.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

import aabb.std;

/// The value lies between these two.
#define CHECK_BETWEEN(low, value, high) \
    do {                                \
        CHECK((value) > (low));         \
        CHECK((value) < (high));        \
    } while (false)

/// The call is rejected with this sentence.
#define CHECK_REFUSED(call, sentence) CHECK_THROWS_MATCHES(call, aabb::input_error, Catch::Matchers::Message(sentence))

[[nodiscard]] inline bool holds(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
}

[[nodiscard]] inline std::size_t count_of(std::string_view part, std::string_view text) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string_view::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

/// The text with `by` in place of the first `what`, which must be in it.
[[nodiscard]] inline std::string replaced(std::string text, std::string_view what, std::string_view by) {
    const std::size_t at = text.find(what);
    REQUIRE(at != std::string::npos);
    return text.replace(at, what.size(), by);
}

template <class T, class Allocator>
[[nodiscard]] std::vector<T, Allocator> sorted(std::vector<T, Allocator> values) {
    std::ranges::sort(values);
    return values;
}

template <class T>
[[nodiscard]] std::vector<T> sorted(std::span<const T> values) {
    return sorted(std::vector<T>(values.begin(), values.end()));
}

/// The sentence with which a call is rejected; "accepted" if it is not.
template <class Error, class Call>
std::string refusal_in(Call call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "accepted";
}
