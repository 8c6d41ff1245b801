#include "../testing.hpp"

import aabb;

using namespace aabb;

namespace {

constexpr std::size_t kib = 1024;

}  // namespace

TEST_CASE("large vectors of any size are aligned and hold their elements") {
    for (const std::size_t bytes :
         {kib, 128 * kib - 4, 128 * kib, 2048 * kib, 4096 * kib - 4, 4096 * kib, 9001 * kib}) {
        CAPTURE(bytes);
        large_vector<std::uint32_t> numbers(bytes / sizeof(std::uint32_t));
        for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = static_cast<std::uint32_t>(i);
        large_vector<std::uint32_t> copy = numbers;
        numbers.resize(numbers.size() / 2);
        copy.resize(2 * copy.size(), 7);
        bool same = true;
        for (std::size_t i = 0; i < numbers.size(); ++i) same &= numbers[i] == i && copy[i] == i;
        CHECK(same);
        CHECK(copy.back() == 7);
        const auto address = reinterpret_cast<std::uintptr_t>(numbers.data());
        if (bytes >= 128 * kib) CHECK(address % 64 == 0);
        if (bytes >= 4096 * kib) CHECK(address % (2048 * kib) == 0);
    }
}

TEST_CASE("a large vector that exceeds memory throws") {
    const std::size_t too_much = std::numeric_limits<std::size_t>::max() / 4;
    CHECK_THROWS_AS(static_cast<void>(large_pages<std::byte>::allocate(too_much)), std::bad_alloc);
}
