#include <catch2/catch_test_macros.hpp>

#include "fakes.hpp"

namespace {

struct other_sort : fake_sort {
    static constexpr std::string_view name = "other";
};

}  // namespace

TEST_CASE("a combination is refused in the words of the policy that refuses it") {
    STATIC_CHECK(aabb::refusal<fake_sort, fake_whole_partition, fake_sweep>().empty());
    STATIC_CHECK(aabb::refusal<fake_sort, fake_whole_partition, picky_sweep>().empty());
    STATIC_CHECK(aabb::refusal<other_sort, fake_whole_partition, picky_sweep>() ==
                 "picky works with the fake sort only");
}
