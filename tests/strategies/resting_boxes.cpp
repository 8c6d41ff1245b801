#include <rapidcheck.h>

#include "costs.hpp"
#include "searches.hpp"

import aabb.columns;
import aabb.strategies;

using namespace aabb;

namespace {

struct search_by_columns : global_search<bucket_sort, columns_partition, simd_sweep, work_counters> {
    explicit search_by_columns(std::size_t objects, const columns_partition::config& config = {})
        : global_search({}, columns_partition(config), {}) {
        ::insert_all(*this, objects);
    }
};

struct frame_result {
    std::vector<index_pair> pairs;
    std::uint64_t tests;
};

frame_result result_of(search_by_columns& search, const std::vector<box>& boxes) {
    const std::uint64_t before = search.counters()[work::box_tests];
    std::vector<index_pair> pairs = found_by(search, boxes);
    return {std::move(pairs), search.counters()[work::box_tests] - before};
}

/// The numbers of boxes at rest and of active ones by the plan of a search; 0 if all boxes are searched.
std::array<double, 2> resting_and_active(const auto& search) {
    for (const stage_plan& plan : search.own().plans())
        if (plan.kind == plan_kind::resting_boxes) return {plan.decision["resting"], plan.decision["active"]};
    return {0, 0};
}

/// Moves every `step`-th box, so little that pairs hardly change.
void move_some(std::vector<box>& boxes, std::size_t step, std::size_t first = 0) {
    for (std::size_t i = first; i < boxes.size(); i += step)
        boxes[i] = moved(boxes[i], {static_cast<float>(i % 7) / 64, -1.0F / 64, 1.0F / 64});
}

}  // namespace

TEST_CASE("boxes at rest are found with any others, in any order of motion, rest, arrival and departure") {
    REQUIRE(rc::check([] {
        cost_model assumed;
        if (*rc::gen::arbitrary<bool>()) assumed = any_costs();
        if (*rc::gen::arbitrary<bool>()) assumed.active_box = 1e-9;  // even if most boxes move
        const scoped_costs costs(assumed);
        columns_partition::config config{.few = 0};
        config.group = *rc::gen::element<std::optional<std::uint32_t>>(std::nullopt, 20U, 200U);
        config.threads = *rc::gen::element(1U, 2U);
        search_by_columns search(0, config);
        const auto n = *rc::gen::inRange<std::uint32_t>(1, 300);
        std::mt19937 random(*rc::gen::arbitrary<std::uint32_t>());
        const std::uint32_t side = *rc::gen::element(4U, 12U, 40U);
        const std::uint32_t clumps = *rc::gen::element(1U, 1U, 5U);
        const std::uint32_t giants = *rc::gen::element(1000U, 1000U, 20U);
        const auto any = [&] {
            box b = lattice_box(random, side, random() % giants == 0 ? 2 * side : 3);
            const float shift = 1e5F * static_cast<float>(random() % clumps);
            for (int k = 0; k < 3; ++k) b.min[k] += shift, b.max[k] += shift;
            return b;
        };
        std::vector<box> boxes(n), before;
        std::vector<bool> present(n, false);
        for (std::uint32_t id = 0; id < n; ++id) {
            boxes[id] = any();
            if (id > 0 && random() % 8 == 0) continue;
            search.insert(id);
            present[id] = true;
        }
        for (int frame = 0; frame < 30; ++frame) {
            const std::uint32_t one_in = *rc::gen::element(0U, 0U, 1U, 3U, 10U, 100U);
            const std::uint32_t first = random() % 10;
            const bool same_ones = random() % 2 == 0;
            for (std::uint32_t id = 0; id < n; ++id)
                if (one_in > 0 && (same_ones ? id % one_in == first % one_in : random() % one_in == 0))
                    boxes[id] = any();
            if (*rc::gen::inRange(0, 6) == 0) {
                const std::uint32_t id = random() % n;
                present[id] ? search.remove(id) : search.insert(id);
                present[id] = !present[id];
            }
            bool is_rejected = false;
            if (*rc::gen::inRange(0, 12) == 0) {
                std::vector<box> bad = boxes;
                const std::uint32_t id = random() % n;
                std::swap(bad[id].min[0], bad[id].max[0]);
                bad[id].min[0] += 1;
                try {
                    search.update(bad);
                } catch (const input_error&) {
                    is_rejected = true;
                }
                RC_ASSERT(is_rejected);
            }
            // After a rejected frame, what is said has no effect.
            std::vector<std::uint32_t> said;
            if (!is_rejected) said = ids_of_moved(before, boxes);
            if (*rc::gen::arbitrary<bool>()) search.moved(said);
            before = boxes;
            const auto expected = overlapping(boxes, present);
            RC_ASSERT(found_by(search, boxes) == expected);
            std::vector<index_pair> again;
            search.search(again);
            RC_ASSERT(sorted(again) == expected);
        }
    }));
}

TEST_CASE("only boxes that move are searched, and looked up among those at rest") {
    for (const std::uint32_t group : {100'000U, 1000U}) {
        std::vector<box> boxes = cubes(20'000, {60, 60, 60});
        search_by_columns search(boxes.size(), {.group = group});
        const std::uint64_t full = result_of(search, boxes).tests;
        static_cast<void>(result_of(search, boxes));  // shows that boxes rest
        for (int frame = 0; frame < 8; ++frame) {
            move_some(boxes, 20);
            const frame_result result = result_of(search, boxes);
            CHECK(result.pairs == found_by(*search_of({}, boxes.size()), boxes));
            CHECK(resting_and_active(search) == std::array<double, 2>{19'000, 1000});
            CHECK(7 * result.tests < full);
        }
        // A giant moves through all of them.
        boxes[1] = {{-1, -1, -1}, {70, 70, 70}};
        CHECK(result_of(search, boxes).pairs == found_by(*search_of({}, boxes.size()), boxes));
        // All move.
        move_some(boxes, 1);
        CHECK(result_of(search, boxes).pairs == found_by(*search_of({}, boxes.size()), boxes));
        CHECK(resting_and_active(search) == std::array<double, 2>{0, 0});
    }
}

TEST_CASE("no boxes are tested while all rest, and few once one moves, leaves or comes") {
    std::vector<box> boxes = cubes(3000, {30, 30, 30});
    for (const std::uint32_t group : {100'000U, 200U}) {
        search_by_columns search(boxes.size(), {.group = group});
        std::vector<bool> present(boxes.size(), true);
        const auto tests = [&] {
            const frame_result result = result_of(search, boxes);
            CHECK(result.pairs == overlapping(boxes, present));
            return result.tests / simd::width;
        };
        const std::uint64_t full = tests();
        CHECK(tests() == full);  // shows that nothing moves
        for (int frame = 0; frame < 20; ++frame) CHECK(tests() == 0);
        // A box outside the sample moves a little.
        boxes[1234].max[1] = std::nextafter(boxes[1234].max[1], 100.0F);
        for (int frame = 0; frame < 3; ++frame) CHECK(tests() < full / 100);
        search.remove(77);
        present[77] = false;
        for (int frame = 0; frame < 3; ++frame) CHECK(tests() < full / 100);
        search.insert(77);
        present[77] = true;
        CHECK(tests() < full / 100);
        boxes.push_back(boxes[5]);
        present.push_back(true);
        search.insert(3000);
        CHECK(tests() < full / 100);
        boxes.pop_back();
    }
}

TEST_CASE("boxes are not compared where the caller says which of them have moved") {
    std::vector<box> boxes = cubes(3000, {30, 30, 30});
    search_by_columns search(boxes.size());
    for (int frame = 0; frame < 3; ++frame) static_cast<void>(result_of(search, boxes));
    REQUIRE(resting_and_active(search)[0] == 3000);
    const std::vector<index_pair> pairs = overlapping(boxes);
    boxes[7] = moved(boxes[7], {100, 100, 100});
    search.moved({});  // which is not so
    CHECK(found_by(search, boxes) == pairs);
    const std::array<std::uint32_t, 1> seven{7}, beyond{3000};
    search.moved(seven);
    CHECK(found_by(search, boxes) == overlapping(boxes));
    boxes[8] = moved(boxes[8], {100, 100, 100});
    CHECK(found_by(search, boxes) == overlapping(boxes));
    search.moved(beyond);
    CHECK_REFUSED(search.update(boxes), "object 3000 has moved, but the frame has only 3000 boxes");
}

TEST_CASE("boxes that have come to rest are kept again once that is worth its cost") {
    std::vector<box> boxes = cubes(5000, {40, 40, 40});
    search_by_columns search(boxes.size());
    for (int frame = 0; frame < 2; ++frame) static_cast<void>(result_of(search, boxes));
    for (int frame = 0; frame < 60; ++frame) {
        move_some(boxes, 50, static_cast<std::size_t>(frame));  // others in each frame
        CHECK(result_of(search, boxes).pairs == overlapping(boxes));
        CHECK(resting_and_active(search)[1] <= 2500);
    }
    // Nothing moves: those that still count as active are kept with the others.
    for (int frame = 0; frame < 60; ++frame) static_cast<void>(result_of(search, boxes));
    CHECK(resting_and_active(search) == std::array<double, 2>{5000, 0});
}

TEST_CASE("boxes at rest that leave with their ids, or come in a rejected frame, leave no pairs") {
    const std::vector<box> boxes(100, cube(0, 1));
    search_by_columns search(boxes.size());
    for (int frame = 0; frame < 4; ++frame) CHECK(found_by(search, boxes) == overlapping(boxes));
    const std::vector<box> fewer(boxes.begin(), boxes.end() - 1);
    search.remove(99);
    CHECK(found_by(search, fewer) == overlapping(fewer));
    for (int frame = 0; frame < 4; ++frame) static_cast<void>(found_by(search, fewer));
    // One comes with an invalid box, and leaves before the frame is repeated.
    std::vector<box> more = fewer;
    more.push_back({{1, 1, 1}, {0, 0, 0}});
    search.insert(99);
    CHECK_THROWS_AS(search.update(more), input_error);
    search.remove(99);
    for (int frame = 0; frame < 4; ++frame) {
        CHECK(found_by(search, boxes) == overlapping(fewer));
        CHECK(found_by(search, fewer) == overlapping(fewer));
    }
}

TEST_CASE("rest is given up where queries would take too many tests") {
    // Boxes in one place along the columns, which a query cannot tell apart.
    std::vector<box> boxes(4000, box{{0, 0, 0}, {1, 1, 1}});
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        boxes[i].min[0] = static_cast<float>(i) / 4000;
        boxes[i].max[0] = boxes[i].min[0] + 1e-5F;
        boxes[i].max[1] = 1 + static_cast<float>(i % 50);
    }
    search_by_columns search(boxes.size());
    for (int frame = 0; frame < 12; ++frame) {
        for (std::size_t i = 0; i < boxes.size(); i += 3)
            if (frame > 1) boxes[i].min[2] = -static_cast<float>(frame);
        CHECK(result_of(search, boxes).pairs == overlapping(boxes));
    }
}
