// The segmented interval list alone, against a sorted array.

#include <rapidcheck.h>

#include "../testing.hpp"

import aabb.strategies;
import aabb.sweep.segmented_list;

using namespace aabb;

namespace {

/// An interval on one axis, by its ends; few keys, so that many tie.
struct interval {
    float low;
    float high;

    [[nodiscard]] ordered_end lower(std::uint32_t id) const { return {low, id, false}; }
    [[nodiscard]] ordered_end upper(std::uint32_t id) const { return {high, id, true}; }
};

interval any_interval() {
    const auto low = static_cast<float>(*rc::gen::inRange(-50, 50));
    return {low, low + static_cast<float>(*rc::gen::element(0, 0, 1, 2, 5, 60))};
}

/// A list that is compared with intervals by id.
class checked_list {
public:
    explicit checked_list(std::size_t n) {
        std::vector<ordered_end> ends;
        for (std::uint32_t id = 0; id < n; ++id) {
            intervals_[id] = any_interval();
            ends.push_back(intervals_[id].lower(id));
            ends.push_back(intervals_[id].upper(id));
        }
        std::ranges::sort(ends);
        list_.assign(ends, /*marks_spans=*/true, scratch_);
    }

    void insert(std::uint32_t id) {
        intervals_[id] = any_interval();
        RC_ASSERT(list_.insert(intervals_[id].lower(id), intervals_[id].upper(id)) <= 2 * segmented_list::capacity);
    }
    void erase(std::uint32_t id) {
        const interval gone = intervals_.at(id);
        intervals_.erase(id);
        RC_ASSERT(list_.erase(gone.lower(id), gone.upper(id)) <= 2 * segmented_list::capacity);
    }
    /// Moves both ends, and requires a report of each end that is passed, nearest first.
    void move(std::uint32_t id) {
        const interval from = intervals_.at(id);
        const interval to = any_interval();
        const bool upper_first = to.high > from.high;
        for (const bool is_upper : {upper_first, !upper_first}) {
            const ordered_end start = is_upper ? from.upper(id) : from.lower(id);
            const ordered_end end = is_upper ? to.upper(id) : to.lower(id);
            if (start == end) continue;
            std::vector<ordered_end> expected = ends();
            std::erase_if(expected, [&](const ordered_end& e) {
                return e == start || (start < end ? e < start || end < e : e < end || start < e);
            });
            if (end < start) std::ranges::reverse(expected);
            std::vector<ordered_end> passed;
            list_.move(start, end, [&](const ordered_end& e) {
                passed.push_back(e);
                return true;
            });
            RC_ASSERT(passed == expected);
            (is_upper ? intervals_[id].high : intervals_[id].low) = is_upper ? to.high : to.low;
        }
    }

    [[nodiscard]] bool contains(std::uint32_t id) const { return intervals_.contains(id); }

    /// Each object's neighbourhood has every interval that overlaps its own, once.
    void check() const {
        for (const auto& [id, own] : intervals_) {
            std::vector<std::uint32_t> near;
            list_.for_each_near(own.lower(id), own.upper(id), [&](std::uint32_t other) { near.push_back(other); });
            std::ranges::sort(near);
            RC_ASSERT(std::ranges::adjacent_find(near) == near.end());
            RC_ASSERT(!std::ranges::binary_search(near, id));
            for (const auto& [other, o] : intervals_)
                if (other != id && o.low <= own.high && own.low <= o.high)
                    RC_ASSERT(std::ranges::binary_search(near, other));
            for (const std::uint32_t other : near) RC_ASSERT(intervals_.contains(other));
        }
    }

private:
    [[nodiscard]] std::vector<ordered_end> ends() const {
        std::vector<ordered_end> sorted_ends;
        for (const auto& [id, i] : intervals_) {
            sorted_ends.push_back(i.lower(id));
            sorted_ends.push_back(i.upper(id));
        }
        std::ranges::sort(sorted_ends);
        return sorted_ends;
    }

    std::map<std::uint32_t, interval> intervals_;
    segmented_list list_;
    std::vector<std::uint32_t> scratch_ = std::vector<std::uint32_t>(1000);
};

}  // namespace

TEST_CASE("a segmented list names all intervals near one, whatever was inserted, moved and erased") {
    REQUIRE(rc::check([] {
        checked_list list(*rc::gen::element<std::size_t>(0, 1, 30, 300));
        const auto steps = *rc::gen::inRange(0, 400);
        for (int step = 0; step < steps; ++step) {
            const auto id = *rc::gen::inRange<std::uint32_t>(0, 350);
            if (!list.contains(id))
                list.insert(id);
            else if (*rc::gen::arbitrary<bool>())
                list.move(id);
            else
                list.erase(id);
        }
        list.check();
    }));
}

TEST_CASE("a segmented list ends a move once the callback returns false") {
    std::vector<std::uint32_t> scratch(200);
    std::vector<ordered_end> ends;
    for (std::uint32_t id = 0; id < 200; ++id) {
        ends.emplace_back(static_cast<float>(id), id, false);
        ends.emplace_back(static_cast<float>(id) + 0.5F, id, true);
    }
    segmented_list list;
    list.assign(ends, /*marks_spans=*/false, scratch);
    int passed = 0;
    list.move({150.5F, 150, true}, {190.2F, 150, true}, [&](const ordered_end&) { return ++passed < 10; });
    CHECK(passed == 10);
}
