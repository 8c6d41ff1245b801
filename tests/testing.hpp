#pragma once

// What most tests include: Catch2, and what they name of the standard library. Modules are imported after it.

#include <algorithm>
#include <array>
#include <bit>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_exception.hpp>
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

/// The call is refused in this sentence.
#define CHECK_REFUSED(call, sentence) CHECK_THROWS_MATCHES(call, aabb::input_error, Catch::Matchers::Message(sentence))
