#include <algorithm>
#include <array>
#include <bit>
#include <catch2/catch_test_macros.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

import aabb.simd;

using namespace aabb;

namespace {

constexpr std::size_t n = simd::width;

simd::words numbers(std::uint32_t factor, std::uint32_t offset) {
    return simd::places() * factor + offset;
}

}  // namespace

TEST_CASE("a set of lanes is stored one after the other") {
    for (std::uint32_t set = 0; set <= simd::every_lane; set += n == 16 ? 37 : 1) {
        std::array<std::uint32_t, 2 * n> to{};
        const simd::words v = numbers(3, 5);
        REQUIRE(simd::store_where(to.data(), v, set) == static_cast<std::size_t>(std::popcount(set)));
        std::size_t next = 0;
        for (std::size_t i = 0; i < n; ++i)
            if (set >> i & 1U) REQUIRE(to[next++] == v[i]);
    }
}

TEST_CASE("lanes below an end are none below 0, and at most all") {
    for (int end = -3; end < static_cast<int>(n) + 3; ++end) {
        const std::uint32_t expected = end <= 0                     ? 0
                                       : end >= static_cast<int>(n) ? simd::every_lane
                                                                    : (std::uint32_t{1} << end) - 1;
        const simd::words all = simd::lanes_below(simd::all(static_cast<std::uint32_t>(end)));
        for (std::size_t i = 0; i < n; ++i) REQUIRE(all[i] == expected);
        if (end >= 0) REQUIRE(simd::lanes_below(static_cast<std::size_t>(end)) == expected);
    }
}

TEST_CASE("rows become columns and columns rows") {
    std::vector<float> sixes(6 * n);
    for (std::size_t i = 0; i < sixes.size(); ++i) sixes[i] = static_cast<float>(i);
    simd::floats columns[6];
    simd::load_rows_of_six(sixes.data(), columns);
    std::vector<std::uint32_t> fours(4 * n);
    for (std::size_t i = 0; i < fours.size(); ++i) fours[i] = static_cast<std::uint32_t>(7 * i);
    simd::words four[4];
    simd::load_rows_of_four(fours.data(), four);
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t k = 0; k < 6; ++k) REQUIRE(columns[k][i] == sixes[6 * i + k]);
        for (std::size_t k = 0; k < 4; ++k) REQUIRE(four[k][i] == fours[4 * i + k]);
    }
    std::vector<std::uint32_t> back(4 * n);
    simd::store_rows_of_four(back.data(), {four[0], four[1], four[2], four[3]});
    REQUIRE(back == fours);
}

TEST_CASE("numbers of 16 bits are multiplied and taken from each other in halves") {
    const simd::words a = numbers(0x1234'5679U, 0xffff'0001U);
    const simd::words b = numbers(0x0f31'7a11U, 0x8001'ffffU);
    const simd::words products = simd::upper_products(a, b);
    const simd::words excess = simd::excess(a, b);
    for (std::size_t i = 0; i < n; ++i)
        for (const unsigned shift : {0U, 16U}) {
            const std::uint32_t x = a[i] >> shift & 0xffffU;
            const std::uint32_t y = b[i] >> shift & 0xffffU;
            REQUIRE((products[i] >> shift & 0xffffU) == x * y >> 16);
            REQUIRE((excess[i] >> shift & 0xffffU) == (x > y ? x - y : 0));
        }
}

TEST_CASE("sums run, places are gathered, comparisons become bits") {
    const simd::words v = numbers(11, 2);
    const simd::words sums = simd::running_sum(v);
    std::array<std::uint32_t, 4 * n> table{};
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = static_cast<std::uint32_t>(i * i);
    const simd::words gathered = simd::gather(table.data(), numbers(3, 1));
    std::array<std::uint16_t, n> lower{};
    simd::store_lower_halves(lower.data(), numbers(0x10003, 9));
    const simd::words widened = simd::load_halves(lower.data());
    std::uint32_t sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
        REQUIRE(widened[i] == 3 * i + 9);
        REQUIRE(sums[i] == (sum += v[i]));
        REQUIRE(gathered[i] == (3 * i + 1) * (3 * i + 1));
        REQUIRE(lower[i] == 3 * i + 9);
    }
    REQUIRE(simd::bits(simd::places() < 3U) == 7U);
    REQUIRE(simd::bits(simd::places() == simd::places()) == simd::every_lane);
}
