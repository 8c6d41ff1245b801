#include <random>

#include "temporary_folder.hpp"

import aabb;
import aabblab.pair_output;

TEST_CASE("A pair or contact that a stage reports twice is a defect") {
    std::vector<aabb::index_pair> pairs = {{0, 1}, {0, 7}, {2, 3}};
    REQUIRE_NOTHROW(aabblab::require_each_once(pairs, "a stage"));
    pairs.insert(pairs.begin() + 1, {0, 7});
    REQUIRE_THROWS_MATCHES(aabblab::require_each_once(pairs, "a stage, frame 3"), aabblab::defect,
                           Catch::Matchers::Message("a stage, frame 3: the pair 0,7 was reported more than once"));
    std::vector<aabb::contact> contacts = {{0, 1, 2, 3}, {0, 1, 7, 3}, {0, 1, 7, 3}};
    REQUIRE_THROWS_MATCHES(aabblab::require_each_once(contacts, "a stage"), aabblab::defect,
                           Catch::Matchers::Message("a stage: the contact 0,1,7,3 was reported more than once"));
    contacts.pop_back();
    REQUIRE_NOTHROW(aabblab::require_each_once(contacts, "a stage"));
}

TEST_CASE_METHOD(in_folder, "A number table is written only when it is committed") {
    {
        aabblab::number_table uncommitted(folder / "left.csv", "a,b");
        uncommitted.add({0, 1});
    }
    REQUIRE(folder.files() == 0);
    aabblab::number_table table(folder / "pairs.csv", "frame,a,b");
    table.add({0, 0, 1});
    table.add({2, 0, 4294967295});
    table.commit();
    REQUIRE(bytes_of_file(folder / "pairs.csv") == "frame,a,b\n0,0,1\n2,0,4294967295\n");
}

TEST_CASE("Rows are sorted from any order and with any bit pattern") {
    std::mt19937 numbers(1);
    const auto random = [&] { return static_cast<std::uint32_t>(numbers()); };
    for (const std::size_t size : {0U, 1U, 2U, 64U, 65U, 1000U, 20000U})
        for (const std::uint32_t mask_a : {0xffffffffU, 0x100U, 0xfff000U, 1U, 0U})
            for (const std::uint32_t mask_b : {0xffffffffU, 0x1ffffU, 0x80000001U, 0U}) {
                std::vector<aabb::index_pair> pairs;
                std::vector<aabb::contact> contacts;
                for (std::size_t i = 0; i < size; ++i) {
                    pairs.push_back({random() & mask_a, random() & mask_b});
                    contacts.push_back({random() & mask_a, random() & mask_b, random() & mask_b, random() & mask_a});
                }
                const std::vector<aabb::index_pair> sorted_pairs = sorted(pairs);
                aabblab::sort_rows(pairs);
                CHECK(pairs == sorted_pairs);
                std::ranges::reverse(pairs);
                aabblab::sort_rows(pairs);
                CHECK(pairs == sorted_pairs);
                const std::vector<aabb::contact> sorted_contacts = sorted(contacts);
                aabblab::sort_rows(contacts);
                CHECK(contacts == sorted_contacts);
            }
}
