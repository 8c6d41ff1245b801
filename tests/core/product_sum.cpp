#include <random>

#include "../testing.hpp"

import aabb.geometry;

using namespace aabb;

TEST_CASE("sums of products have the sign of the sum in integers, however often carries are propagated") {
    __extension__ using wide = __int128;
    std::mt19937_64 random(59);
    std::size_t zeros = 0, negative = 0;
    for (int i = 0; i < 3000; ++i) {
        product_sum sum, carried;
        wide expected = 0;
        const int exponent = static_cast<int>(random() % 1900) - 1040;
        const auto add = [&](double x, double y, double z) {
            // Divided among the factors, so that none is rounded.
            const double of_x = std::ldexp(x, exponent / 2), of_y = std::ldexp(y, exponent - exponent / 2);
            sum.add(of_x, of_y, z);
            carried.add(of_x, of_y, z);
            expected +=
                wide{static_cast<std::int64_t>(x)} * static_cast<std::int64_t>(y) * static_cast<std::int64_t>(z);
        };
        const auto number = [&] { return static_cast<double>(static_cast<int>(random() % 2001) - 1000); };
        std::vector<std::array<double, 3>> added;
        for (std::size_t n = random() % 20; n > 0; --n) {
            added.push_back({number(), number(), number()});
            add(added.back()[0], added.back()[1], added.back()[2]);
            if (random() % 2 == 0) carried.carry();
        }
        if (i % 3 == 0) {  // cancels all
            for (const auto& [x, y, z] : added) {
                add(-x, y, z);
                if (random() % 2 == 0) carried.carry();
            }
        }
        const int sign = static_cast<int>(expected > 0) - static_cast<int>(expected < 0);
        CHECK(sum.sign() == sign);
        CHECK(carried.sign() == sign);
        const scaled_double of_sum = sum.rounded(), of_carried = carried.rounded();
        CHECK(of_carried.mantissa == of_sum.mantissa);
        CHECK(of_carried.exponent == of_sum.exponent);
        zeros += expected == 0;
        negative += expected < 0;
    }
    CHECK(zeros > 500);
    CHECK(negative > 500);
}

TEST_CASE("sums of products reach from the least to the greatest double") {
    constexpr double least = std::numeric_limits<double>::denorm_min(), most = std::numeric_limits<double>::max();
    product_sum sum;
    sum.add(most, most, most);
    sum.add(most, most, most);
    sum.add(-least, least, least);
    sum.carry();
    CHECK(sum.sign() == 1);
    for (int i = 0; i < 2; ++i) sum.subtract(most, most, most);
    CHECK(sum.sign() == -1);
    sum.carry();
    CHECK(sum.sign() == -1);
    sum.add(0x1p1023, 0x1p1023, 0x1p1023);
    sum.add(least, least, least);
    CHECK(sum.sign() == 1);
    sum.subtract(0x1p1023, 0x1p1023, 0x1p1023);
    CHECK(sum.sign() == 0);
}
