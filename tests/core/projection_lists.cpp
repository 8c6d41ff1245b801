#include <rapidcheck.h>

#include "../testing.hpp"

#include "fakes.hpp"

using namespace aabb;

namespace {

/// Records the ids that it is given.
struct recording_sort {
    static constexpr std::string_view name = "recording";
    static constexpr std::string_view summary = "a sort that records";
    std::vector<std::vector<std::uint32_t>> given;

    void sort(std::span<projection> list, auto& counters) {
        std::vector<std::uint32_t>& ids = given.emplace_back();
        for (const projection& p : list) ids.push_back(p.id);
        fake_sort::sort(list, counters);
    }
};

box at(float x) {
    return {{x, 0, 0}, {x + 1, 1, 1}};
}

std::vector<std::uint32_t> ids_of(std::span<const projection> list) {
    std::vector<std::uint32_t> ids;
    for (const projection& p : list) ids.push_back(p.id);
    return ids;
}

}  // namespace

TEST_CASE("only moved objects are given to the sort, in the order of the list") {
    std::vector<box> boxes{at(0), at(10), at(20), at(30), at(40)};
    membership objects;
    for (std::uint32_t id = 0; id < 4; ++id) objects.insert(id);
    projection_lists<no_counters> lists;
    recording_sort sort;
    no_counters counters;
    const auto run_frame = [&] {
        lists.settle(objects);
        objects.settle();
        lists.sort(boxes, 0b001, sort, counters);
        return ids_of(lists.all(boxes).lists[0]);
    };
    // New objects are not given to the sort: they would be far from their places.
    CHECK(run_frame() == std::vector<std::uint32_t>{0, 1, 2, 3});
    CHECK(sort.given.empty());
    CHECK(run_frame() == std::vector<std::uint32_t>{0, 1, 2, 3});
    CHECK(sort.given.empty());
    boxes[3] = at(5);
    boxes[1] = at(22);
    CHECK(run_frame() == std::vector<std::uint32_t>{0, 3, 2, 1});
    CHECK(sort.given == std::vector<std::vector<std::uint32_t>>{{1, 3}});
    for (box& b : boxes) b.min[0] -= 1;
    objects.insert(4);
    objects.remove(2);
    CHECK(run_frame() == std::vector<std::uint32_t>{0, 3, 1, 4});
    CHECK(sort.given.back() == std::vector<std::uint32_t>{0, 3, 1});
}

TEST_CASE("lists are sorted and complete on any axes, as objects move, come and go") {
    REQUIRE(rc::check([] {
        const auto n = *rc::gen::inRange<std::uint32_t>(0, 50);
        std::vector<box> boxes(n, at(0));
        std::vector<bool> present(n);
        membership objects;
        projection_lists<work_counters> lists;
        fake_sort sort;
        work_counters counters;
        for (int frame = 0; frame < 8; ++frame) {
            const int one_in = *rc::gen::element(0, 1, 6);
            for (std::uint32_t id = 0; id < n; ++id) {
                if (one_in > 0 && *rc::gen::inRange(0, one_in) == 0)
                    for (int k = 0; k < 3; ++k) boxes[id].min[k] = static_cast<float>(*rc::gen::inRange(0, 9));
                if (*rc::gen::inRange(0, 4) == 0) {
                    present[id] ? objects.remove(id) : objects.insert(id);
                    present[id] = !present[id];
                }
            }
            const auto axes = *rc::gen::inRange<axis_set>(1, 8);
            lists.settle(objects);
            objects.settle();
            lists.sort(boxes, axes, sort, counters);
            RC_ASSERT(lists.axes() == axes);
            for (std::size_t k = 0; k < 3; ++k) {
                const auto list = lists.all(boxes).lists[k];
                std::vector<std::uint32_t> expected;
                for (std::uint32_t id = 0; id < n; ++id)
                    if (present[id] && has_axis(axes, k)) expected.push_back(id);
                RC_ASSERT(sorted(ids_of(list)) == expected);
                RC_ASSERT(std::ranges::is_sorted(list, precedes));
                for (const projection& p : list) RC_ASSERT(p.key == boxes[p.id].min[static_cast<int>(k)]);
            }
        }
    }));
}

TEST_CASE("inversions are counted like in a double loop") {
    REQUIRE(rc::check([] {
        std::vector<projection> list(*rc::gen::inRange<std::size_t>(0, 100));
        for (projection& p : list) p = {static_cast<float>(*rc::gen::inRange(0, 20)), 0};
        std::uint64_t expected = 0;
        for (std::size_t i = 0; i < list.size(); ++i)
            for (std::size_t j = i + 1; j < list.size(); ++j) expected += list[j].key < list[i].key;
        inversion_counter counter;
        RC_ASSERT(counter.count(list) == expected);
    }));
}
