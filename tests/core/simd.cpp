#include <random>

#include "../testing.hpp"

import aabb.columns.kernels;
import aabb.wide_tree.kernels;

using namespace aabb;

namespace {

constexpr std::size_t n = simd::width;

simd::words numbers(std::uint32_t factor, std::uint32_t offset) {
    return simd::places() * factor + offset;
}

}  // namespace

TEST_CASE("compress_store stores a set of lanes contiguously") {
    for (std::uint32_t set = 0; set <= simd::every_lane; set += n == 16 ? 37 : 1) {
        std::array<std::uint32_t, 2 * n> to{};
        const simd::words v = numbers(3, 5);
        REQUIRE(simd::compress_store(to.data(), v, set) == static_cast<std::size_t>(std::popcount(set)));
        std::size_t next = 0;
        for (std::size_t i = 0; i < n; ++i)
            if (set >> i & 1U) REQUIRE(to[next++] == v[i]);
    }
}

TEST_CASE("lanes_below is empty up to 0, and at most all lanes") {
    for (int end = -3; end < static_cast<int>(n) + 3; ++end) {
        const std::uint32_t expected = end <= 0                     ? 0
                                       : end >= static_cast<int>(n) ? simd::every_lane
                                                                    : (std::uint32_t{1} << end) - 1;
        const simd::words lanes = simd::lanes_below(simd::broadcast(static_cast<std::uint32_t>(end)));
        for (std::size_t i = 0; i < n; ++i) REQUIRE(lanes[i] == expected);
        if (end >= 0) REQUIRE(simd::lanes_below(static_cast<std::size_t>(end)) == expected);
    }
}

TEST_CASE("rows are transposed to columns and back") {
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

TEST_CASE("16-bit halves are multiplied, and subtracted with saturation") {
    const simd::words a = numbers(0x1234'5679U, 0xffff'0001U);
    const simd::words b = numbers(0x0f31'7a11U, 0x8001'ffffU);
    const simd::words products = simd::high_products(a, b);
    const simd::words difference = simd::saturated_difference(a, b);
    for (std::size_t i = 0; i < n; ++i)
        for (const unsigned shift : {0U, 16U}) {
            const std::uint32_t x = a[i] >> shift & 0xffffU;
            const std::uint32_t y = b[i] >> shift & 0xffffU;
            REQUIRE((products[i] >> shift & 0xffffU) == x * y >> 16);
            REQUIRE((difference[i] >> shift & 0xffffU) == (x > y ? x - y : 0));
        }
}

TEST_CASE("prefix sums, gathers and comparison bits equal those of scalar code") {
    const simd::words v = numbers(11, 2);
    const simd::words sums = simd::prefix_sum(v);
    std::array<std::uint32_t, 4 * n> table{};
    for (std::size_t i = 0; i < table.size(); ++i) table[i] = static_cast<std::uint32_t>(i * i);
    const simd::words gathered = simd::gather(table.data(), numbers(3, 1));
    std::array<std::uint16_t, n> lower{};
    simd::store_low_halves(lower.data(), numbers(0x10003, 9));
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

TEST_CASE("eight numbers are permuted, converted to bytes and compared each with each") {
    const std::array<float, 8> from{-1, 0.5F, 254.9F, 255, 256, 1e30F, std::numeric_limits<float>::quiet_NaN(), 7.99F};
    const simd::eight_words places{7, 8, 1, 2, 3, 4, 13, 15};
    const simd::eight_floats taken = simd::permuted(from.data(), places);
    for (int i = 0; i < 8; ++i) {
        const float source = from[places[i] & 7U];
        REQUIRE((taken[i] == source || (taken[i] != taken[i] && source != source)));
    }
    const simd::eight_bytes whole = simd::whole_bytes(simd::load_eight<simd::eight_floats>(from.data()));
    const std::array<int, 8> expected{0, 0, 254, 254, 254, 254, 0, 7};
    for (int i = 0; i < 8; ++i) REQUIRE(int{whole[i]} == expected[static_cast<std::size_t>(i)]);
    const std::array<std::uint8_t, 8> a{0, 1, 127, 128, 200, 254, 255, 7};
    const std::uint64_t no_greater = simd::pairs_no_greater(a.data(), whole);
    for (unsigned j = 0; j < 8; ++j)
        for (unsigned i = 0; i < 8; ++i) REQUIRE((no_greater >> (8 * j + i) & 1U) == (a[i] <= whole[j] ? 1U : 0U));
}

TEST_CASE("the columns of six rows are found whose numbers are no greater than those of the rows") {
    std::mt19937 random(58);
    std::array<std::uint8_t, 48> rows;
    for (int repeat = 0; repeat < 1000; ++repeat) {
        // Small or large numbers, so that many are equal.
        const auto number = [&] { return static_cast<std::uint8_t>((random() & 1U) * 252 + (random() & 3U)); };
        std::ranges::generate(rows, number);
        simd::eight_bytes most{};
        for (int r = 0; r < 6; ++r) most[r] = static_cast<std::uint8_t>(repeat % 2 == 0 ? 255 : number());
        most[repeat % 6] = number();
        std::uint32_t expected = 0;
        for (unsigned i = 0; i < 8; ++i) {
            bool is_no_greater = true;
            for (unsigned r = 0; r < 6; ++r) is_no_greater &= rows[8 * r + i] <= most[static_cast<int>(r)];
            expected |= static_cast<std::uint32_t>(is_no_greater) << i;
        }
        REQUIRE(simd::columns_no_greater(rows.data(), most) == expected);
    }
}

TEST_CASE("conversion to 16-bit integers is monotone") {
    constexpr float inf = std::numeric_limits<float>::infinity();
    const simd::sixteen_floats growing{-inf, -1e38F, -32768, -32767, -32766.5F, -2.5F, -1,   -0.5F,
                                       0,    1e-40F, 0.999F, 1,      32766.5F,  32767, 1e9F, inf};
    const simd::sixteen_i16 whole = simd::whole_i16(growing);
    const std::array<int, 16> expected{-32767, -32767, -32767, -32767, -32766, -2,    -1,    0,
                                       0,      0,      0,      1,      32766,  32767, 32767, 32767};
    for (int i = 0; i < 16; ++i) REQUIRE(int{whole[i]} == expected[static_cast<std::size_t>(i)]);
    CHECK(simd::bits_of_sixteen(whole < simd::sixteen_i16{}) == 0x7fU);
    CHECK(simd::least(-growing) == -inf);
    for (int i = 0; i < 16; ++i) {
        simd::sixteen_floats values{};
        values[i] = -1;
        CHECK(simd::least(values) == -1);
    }
}

TEST_CASE("the indices of set bits are stored in order") {
    for (const std::uint64_t set : {std::uint64_t{0}, std::uint64_t{1}, std::uint64_t{1} << 63, ~std::uint64_t{0},
                                    std::uint64_t{0x8421f00d00c0ffee}}) {
        std::array<std::uint8_t, 64> places{};
        simd::store_set_bits(places.data(), set);
        std::size_t next = 0;
        for (unsigned i = 0; i < 64; ++i)
            if (set >> i & 1U) REQUIRE(unsigned{places[next++]} == i);
    }
}

TEST_CASE("unpack_sixteen reads numbers of one to four bytes, and repeats the first for missing ones") {
    for (std::size_t bytes = 1; bytes <= 4; ++bytes)
        for (std::uint32_t count = 1; count <= 16; ++count) {
            std::array<std::byte, 64 + 64> from{};
            for (std::size_t i = 0; i < from.size(); ++i) from[i] = static_cast<std::byte>(7 * i + 129);
            std::array<std::uint32_t, 16> to{};
            simd::unpack_sixteen(to.data(), from.data(), bytes, count);
            for (std::uint32_t i = 0; i < 16; ++i) {
                std::uint32_t expected = 0;
                for (std::size_t b = 0; b < bytes; ++b)
                    expected |= std::to_integer<std::uint32_t>(from[bytes * (i < count ? i : 0) + b]) << 8 * b;
                REQUIRE(to[i] == expected);
            }
        }
}

TEST_CASE("columns that share a number are found") {
    const std::array<std::uint32_t, 24> a{1,  2,  3,  4,  5,  6,  7,  8,  11, 12, 13, 14,
                                          15, 16, 17, 18, 21, 22, 23, 24, 25, 26, 27, 28};
    const std::array<std::uint32_t, 24> b{90, 2,  90, 24, 15, 90, 90, 8, 21, 90, 90, 90,
                                          90, 90, 13, 90, 90, 90, 90, 4, 90, 6,  90, 90};
    const std::uint64_t shared = simd::columns_with_shared_number(a.data(), b.data());
    for (std::size_t j = 0; j < 8; ++j)
        for (std::size_t i = 0; i < 8; ++i) {
            bool expected = false;
            for (std::size_t c = 0; c < 24; c += 8)
                for (std::size_t d = 0; d < 24; d += 8) expected |= a[c + i] == b[d + j];
            REQUIRE((shared >> (8 * j + i) & 1U) == std::uint64_t{expected});
        }
}

TEST_CASE("eight points are transposed to three columns") {
    std::array<std::array<float, 3>, 8> points{};
    std::array<const float*, 8> from{};
    for (std::size_t i = 0; i < 8; ++i) {
        for (std::size_t k = 0; k < 3; ++k) points[i][k] = static_cast<float>(10 * i + k);
        from[i] = points[i].data();
    }
    const auto columns = simd::transpose_eight_points(from.data());
    for (std::size_t i = 0; i < 8; ++i)
        for (std::size_t k = 0; k < 3; ++k) REQUIRE(columns[k][i] == points[i][k]);
}
