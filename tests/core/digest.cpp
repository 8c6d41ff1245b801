#include "../testing.hpp"

import aabb;

using namespace aabb;

TEST_CASE("a digest is XXH3-64 of the little-endian u32 triples") {
    digest empty;
    CHECK(empty.text() == "2d06800538d394c2");  // of no bytes, as XXH3 defines it
    digest d;
    const std::vector<index_pair> first = {{0, 1}, {2, 3}};
    const std::vector<index_pair> second = {{0, 7}};
    d.add(0, first);
    d.add(1, second);
    digest numbers;
    numbers.add(std::array<std::uint32_t, 9>{0, 0, 1, 0, 2, 3, 1, 0, 7});
    CHECK(d.value() == numbers.value());
    CHECK(d.text().size() == 16);
    digest other_frame;
    other_frame.add(0, first);
    other_frame.add(2, second);
    CHECK(d.value() != other_frame.value());
}

TEST_CASE("a digest is the same whether pairs are added together or one by one") {
    std::vector<index_pair> pairs;
    for (std::uint32_t a = 0; a < 1000; ++a) pairs.push_back({a, a + 1});
    digest at_once;
    at_once.add(3, pairs);
    digest one_by_one;
    for (const auto [a, b] : pairs) one_by_one.add(std::array{std::uint32_t{3}, a, b});
    CHECK(at_once.value() == one_by_one.value());
}
