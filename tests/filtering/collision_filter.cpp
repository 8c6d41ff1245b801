#include <rapidcheck.h>

#include <random>
#include <set>

#include "../meshes.hpp"
#include "../strategies/costs.hpp"
#include "../strategies/searches.hpp"
#include "filtered_scenes.hpp"

import aabb.auto_detector;
import aabb.distance.grown_stage;
import aabb.partition.none;
import aabb.prepare.neighbour_list;
import aabb.sort.insertion;
import aabb.sweep.one_axis;

using namespace aabb;

namespace {

using plain_search = global_search<insertion_sort, none_partition, one_axis_sweep>;

/// The same search for boxes within a distance of 0: it finds the same pairs, but a filter does not know that.
std::unique_ptr<global_stage> of_all_objects(std::unique_ptr<global_stage> search) {
    return std::make_unique<within_stage>(std::move(search), 0);
}

bool has_plan(const global_stage& stage, plan_kind kind) {
    return std::ranges::count(stage.plans(), kind, &stage_plan::kind) > 0;
}

std::string text_of_plans(const global_stage& stage) {
    std::string text;
    for (const stage_plan& plan : stage.plans()) text += to_text(plan.decision) + "\n";
    return text;
}

/// Boxes that all overlap.
std::vector<box> pile(std::size_t n) {
    return std::vector<box>(n, box{{0, 0, 0}, {1, 1, 1}});
}

/// A row of resting boxes, each of which overlaps the next, and above it some that move along and touch one or two.
struct row_with_movers {
    std::uint32_t resting, movers;
    collision_filter filter;

    row_with_movers(std::uint32_t r, std::uint32_t m) : resting(r), movers(m) {
        for (std::uint32_t id = 0; id < resting; ++id) filter.set(id, {.rests = true});
    }
    [[nodiscard]] std::vector<box> boxes(int frame) const {
        std::vector<box> row;
        for (std::uint32_t id = 0; id < resting + movers; ++id) {
            const bool rests = id < resting;
            const auto x = static_cast<float>(rests ? id : 7 * (id - resting) + 3 * static_cast<std::uint32_t>(frame));
            row.push_back({{x, rests ? 0.0F : 1.0F, 0}, {x + 1, rests ? 1.0F : 2.0F, 1}});
        }
        return row;
    }
    [[nodiscard]] std::vector<index_pair> expected(int frame) const {
        std::vector<index_pair> pairs = overlapping(boxes(frame));
        std::erase_if(pairs, [&](index_pair p) { return p.b < resting; });
        return pairs;
    }
};

}  // namespace

TEST_CASE("a pair is kept if each object's group is in the other's mask") {
    collision_filter filter;
    CHECK(filter.keeps(0, 1));
    CHECK(filter[7] == object_filter{.group = 1, .mask = 0xffffffff});
    filter.set(1, {.group = 4, .mask = 0xffffffff});
    CHECK(filter.keeps(0, 1));
    filter.set(0, {.group = 1, .mask = 3});  // does not want group 4
    CHECK_FALSE(filter.keeps(0, 1));
    CHECK_FALSE(filter.keeps(1, 0));
    CHECK(filter.keeps(0, 2));
    CHECK(filter.keeps(1, 2));
    filter.set(0, {.group = 2, .mask = 6});
    filter.set(1, {.group = 4, .mask = 5});  // nor does the other way
    CHECK_FALSE(filter.keeps(0, 1));
    filter.set(1, {.group = 0x8000'0004, .mask = 0x8000'0002});
    CHECK(filter.keeps(0, 1));
    filter.set(0, {.group = 0x8000'0000, .mask = 0x8000'0000});
    CHECK(filter.keeps(1, 0));
    filter.set(1, {.group = 0});
    CHECK_FALSE(filter.keeps(1, 2));
}

TEST_CASE("once an object has a set, only pairs of both sets are kept") {
    collision_filter filter;
    filter.set(0, {.set = object_set::a});
    CHECK_FALSE(filter.keeps(0, 1));
    CHECK_FALSE(filter.keeps(1, 2));
    filter.set(1, {.set = object_set::b});
    filter.set(2, {.set = object_set::b});
    CHECK(filter.keeps(0, 1));
    CHECK(filter.keeps(2, 0));
    CHECK_FALSE(filter.keeps(1, 2));
    for (const std::uint32_t id : {0U, 1U, 2U}) filter.set(id, {});
    CHECK(filter.keeps(1, 2));
}

TEST_CASE("two objects at rest are not tested, and exceptions hold in either order") {
    collision_filter filter;
    filter.set(3, {.rests = true});
    CHECK(filter.keeps(3, 4));
    filter.set(4, {.rests = true});
    filter.set(4, {.rests = true});
    CHECK(filter.resting() == 2);
    CHECK_FALSE(filter.keeps(3, 4));
    filter.set(3, {});
    CHECK(filter.resting() == 1);
    CHECK(filter.keeps(3, 4));
    filter.add_exception({4, 3});
    filter.add_exceptions(std::vector<index_pair>{{9, 1}, {3, 4}, {0, 2}, {2, 0}});
    CHECK_FALSE(filter.keeps(3, 4));
    CHECK_FALSE(filter.keeps(1, 9));
    CHECK_FALSE(filter.keeps(2, 0));
    CHECK(filter.keeps(1, 2));
    const auto exceptions = [&] { return sorted(filter.exceptions()); };
    CHECK(exceptions() == std::vector<index_pair>{{0, 2}, {1, 9}, {3, 4}});
    filter.remove_exception({9, 1});
    CHECK(filter.keeps(1, 9));
    CHECK(exceptions() == std::vector<index_pair>{{0, 2}, {3, 4}});
    filter.remove_exceptions(std::vector<index_pair>{{4, 3}, {5, 6}, {2, 0}, {0, 2}});
    CHECK(exceptions().empty());
    CHECK(filter.keeps(0, 2));
    CHECK(filter.keeps(3, 4));
}

TEST_CASE("any pair is an exception exactly from when it is added to when it is removed") {
    REQUIRE(rc::check([] {
        collision_filter filter;
        std::set<index_pair> expected;
        for (int call = 0; call < 6; ++call) {
            const auto id = rc::gen::inRange<std::uint32_t>(0, 9);
            std::vector<index_pair> pairs;
            for (int i = *rc::gen::inRange(0, 9); i > 0; --i) pairs.push_back({*id, *id});
            const bool adds = *rc::gen::inRange(0, 3) > 0;
            adds ? filter.add_exceptions(pairs) : filter.remove_exceptions(pairs);
            for (const auto [a, b] : pairs)
                adds ? static_cast<void>(expected.insert(ordered_pair(a, b)))
                     : static_cast<void>(expected.erase(ordered_pair(a, b)));
            for (std::uint32_t a = 0; a < 12; ++a)
                for (std::uint32_t b = 0; b < 12; ++b)
                    RC_ASSERT(filter.keeps(a, b) == !expected.contains(ordered_pair(a, b)));
            RC_ASSERT(sorted(filter.exceptions()) == std::vector<index_pair>(expected.begin(), expected.end()));
        }
    }));
}

TEST_CASE("a search that is filtered appends to what is there") {
    collision_filter filter;
    filter.add_exception({0, 1});
    const auto stage = filtered(global_of({}), filter);
    insert_all(*stage, 3);
    std::vector<index_pair> pairs{{0, 1}};  // of someone else
    const std::vector<box> boxes = pile(3);
    stage->update(boxes);
    stage->search(pairs);
    CHECK(pairs.front() == index_pair{0, 1});
    CHECK(sorted(pairs) == std::vector<index_pair>{{0, 1}, {0, 2}, {1, 2}});
}

TEST_CASE("many objects at rest are searched in some frames, and then not at all") {
    row_with_movers scene(4000, 10);
    std::map<bool, std::uint64_t> tests;
    for (const bool searches_all : {false, true}) {
        auto search = global_of(composed({{strategy_kind::sort, "insertion"}}), instrumentation::counters);
        if (searches_all) search = of_all_objects(std::move(search));
        const auto stage = filtered(std::move(search), scene.filter, instrumentation::counters);
        insert_all(*stage, 4010);
        for (int frame = 0; frame < 20; ++frame) {
            if (frame == 14) tests[searches_all] = stage->counters()[work::box_tests];
            CHECK(found_by(*stage, scene.boxes(frame)) == scene.expected(frame));
        }
        tests[searches_all] = stage->counters()[work::box_tests] - tests[searches_all];
        CHECK(has_plan(*stage, plan_kind::resting_index) == !searches_all);
        CHECK(holds(text_of_plans(*stage),
                    searches_all ? "all objects are searched: pairs need not overlap"
                                 : "4000 objects at rest are in an index, in which 10 others are looked up"));
    }
    CHECK(scene.expected(3).size() > 10);
    CHECK(tests[true] > 6 * 4000);
    // A query tests eight boxes in each node that it opens.
    CHECK_BETWEEN(6 * 10 * 8, tests[false], 6 * 10 * 8 * 30);
}

TEST_CASE("few objects at rest among many are searched with them") {
    row_with_movers scene(30, 100);
    const auto stage = filtered(global_of({}), scene.filter, instrumentation::counters);
    insert_all(*stage, 130);
    for (int frame = 0; frame < 20; ++frame) CHECK(found_by(*stage, scene.boxes(frame)) == scene.expected(frame));
    CHECK(stage->counters()[work::box_tests] == 0);  // of the index
    CHECK(holds(text_of_plans(*stage), "objects at rest are searched: no index is worth its cost yet"));
    const std::size_t kept = scene.expected(19).size();
    CHECK(holds(text_of_plans(*stage), "the filter kept " + std::to_string(kept) + " of " +
                                           std::to_string(overlapping(scene.boxes(19)).size()) +
                                           " pairs that the search found"));
}

TEST_CASE("an index of objects at rest is given up once others wake, and is built again when they rest") {
    row_with_movers scene(400, 10);
    const auto stage = filtered(global_of({}), scene.filter);
    insert_all(*stage, 410);
    std::vector<bool> uses_index;
    for (int frame = 0; frame < 60; ++frame) {
        const bool few_rest = frame >= 20 && frame < 40;
        if (frame % 20 == 0)
            for (std::uint32_t id = 0; id < 400; ++id) scene.filter.set(id, {.rests = id >= 360 || !few_rest});
        std::vector<index_pair> expected = overlapping(scene.boxes(frame));
        std::erase_if(expected, [&](index_pair p) { return p.b < 400 && (p.a >= 360 || !few_rest); });
        CHECK(found_by(*stage, scene.boxes(frame)) == expected);
        uses_index.push_back(has_plan(*stage, plan_kind::resting_index));
    }
    CHECK(uses_index[19]);
    CHECK_FALSE(uses_index[39]);
    CHECK(uses_index[59]);
}

TEST_CASE("objects that wake, that move although they rest, that leave and that come back are found") {
    row_with_movers scene(200, 10);
    const auto stage = filtered(global_of({}), scene.filter);
    insert_all(*stage, 210);
    std::vector<bool> present(210, true);
    std::vector<bool> rests(210, true);
    std::fill(rests.begin() + 200, rests.end(), false);
    std::vector<box> boxes = scene.boxes(0);
    const auto check = [&] {
        std::vector<index_pair> expected = overlapping(boxes, present);
        std::erase_if(expected, [&](index_pair p) { return rests[p.a] && rests[p.b]; });
        CHECK(found_by(*stage, boxes) == expected);
        return expected.size();
    };
    const std::size_t at_first = check();
    for (int frame = 0; frame < 9; ++frame) check();
    CHECK(has_plan(*stage, plan_kind::resting_index));
    boxes[199] = boxes[207];  // moves, but rests
    check();
    CHECK(check() > at_first);  // it overlaps one that moves
    rests[7] = false;           // wakes, where it is
    scene.filter.set(7, {});
    CHECK(check() > at_first + 1);  // its neighbours rest
    present[20] = false;
    stage->remove(20);
    check();
    stage->insert(20);  // where it was
    present[20] = true;
    check();
    stage->remove(21);
    stage->insert(21);
    check();
    stage->remove(22);
    present[22] = false;
    check();
    boxes[22] = boxes[205];
    stage->insert(22);  // elsewhere
    present[22] = true;
    check();
    // All wake, one after the other: the index is given up on the way.
    for (std::uint32_t id = 0; id < 200; ++id) {
        scene.filter.set(id, {});
        rests[id] = false;
        if (id % 20 == 0) check();
    }
    check();
    // All rest: nothing is left to search.
    for (std::uint32_t id = 0; id < 210; ++id) {
        scene.filter.set(id, {.rests = true});
        rests[id] = true;
    }
    for (int frame = 0; frame < 12; ++frame) CHECK(check() == 0);
}

TEST_CASE("an object that is removed after the update of a frame is still in it") {
    row_with_movers scene(100, 10);
    const auto stage = filtered(global_of({}), scene.filter);
    insert_all(*stage, 110);
    for (int frame = 0; frame < 9; ++frame) CHECK(found_by(*stage, scene.boxes(frame)) == scene.expected(frame));
    const std::vector<box> boxes = scene.boxes(1);
    std::vector<index_pair> pairs;
    stage->update(boxes);
    for (std::uint32_t id = 0; id < 110; ++id) stage->remove(id);
    stage->search(pairs);
    CHECK(sorted(pairs) == scene.expected(1));
    CHECK(found_by(*stage, boxes).empty());
}

TEST_CASE("a filtered search rejects what a search rejects, also of objects in the index, and stays usable") {
    row_with_movers scene(100, 10);
    const auto stage = filtered(global_of({}), scene.filter);
    std::vector<index_pair> pairs;
    CHECK_REFUSED(stage->search(pairs), "there is no frame to search: update was not called, or did not succeed");
    CHECK_REFUSED(stage->update(pile(3)), "no object was inserted; call insert(id) for each box first");
    insert_all(*stage, 110);
    CHECK_REFUSED(stage->insert(1), "object 1 is inserted twice");
    CHECK_REFUSED(stage->remove(700), "object 700 is removed but was never inserted");
    CHECK_REFUSED(stage->update(pile(2)), "object 2 is present, but the frame has only 2 boxes");
    for (int frame = 0; frame < 12; ++frame) {
        std::vector<box> inverted = scene.boxes(frame);
        inverted[5].max[0] = -1;
        CHECK_REFUSED(stage->update(inverted), "box 5 is inverted: its minimum is above its maximum");
        CHECK_REFUSED(stage->search(pairs), "there is no frame to search: update was not called, or did not succeed");
        inverted[5] = inverted[6];
        inverted[6].min[2] = std::numeric_limits<float>::quiet_NaN();
        CHECK_REFUSED(stage->update(inverted), "box 6 has a coordinate that is not finite");
        CHECK(pairs.empty());
        CHECK(found_by(*stage, scene.boxes(frame)) == scene.expected(frame));
    }
    for (std::uint32_t id = 100; id < 110; ++id) stage->remove(id);  // all others rest
    std::vector<box> boxes = scene.boxes(0);
    CHECK(found_by(*stage, boxes).empty());
    CHECK(found_by(*stage, boxes).empty());
    boxes[105].min[0] = std::numeric_limits<float>::infinity();  // of an absent object
    CHECK_REFUSED(stage->update(boxes), "box 105 has a coordinate that is not finite");
}

TEST_CASE("two sets within which many boxes overlap are searched once, and then joined") {
    // A pile of 300 boxes of set a, and a row of 40 of set b that moves through it.
    collision_filter filter;
    for (std::uint32_t id = 0; id < 340; ++id) filter.set(id, {.set = id < 300 ? object_set::a : object_set::b});
    filter.add_exception({7, 310});
    std::vector<bool> present(340, true);
    const auto boxes = [](int frame) {
        std::vector<box> row;
        for (int id = 0; id < 340; ++id) {
            const auto low = static_cast<float>(id < 300 ? id % 5 + frame % 2 : 4 * (id - 300) - 40 * frame);
            const auto high = low + static_cast<float>(id < 300 ? 30 : 3);
            row.push_back({{low, low, low}, {high, high, high}});
        }
        return row;
    };
    std::map<bool, std::uint64_t> tests;
    for (const bool searches_all : {false, true}) {
        present.assign(340, true);
        auto search = global_of(composed({{strategy_kind::sort, "insertion"}}), instrumentation::counters);
        if (searches_all) search = of_all_objects(std::move(search));
        const auto stage = filtered(std::move(search), filter, instrumentation::counters);
        insert_all(*stage, 340);
        std::size_t kept = 0;
        for (int frame = 0; frame < 12; ++frame) {
            if (frame == 5 || frame == 8) {
                for (const std::uint32_t id : {3U, 305U, 339U}) {
                    present[id] ? stage->remove(id) : stage->insert(id);
                    present[id] = !present[id];
                }
            }
            std::vector<index_pair> expected = overlapping(boxes(frame), present);
            std::erase_if(expected, [](index_pair p) { return (p.a < 300) == (p.b < 300) || p == index_pair{7, 310}; });
            CHECK(found_by(*stage, boxes(frame)) == expected);
            kept += expected.size();
            if (frame == 0) tests[searches_all] = stage->counters()[work::box_tests];
        }
        CHECK(kept > 1000);
        tests[searches_all] = stage->counters()[work::box_tests] - tests[searches_all];
        CHECK(has_plan(*stage, plan_kind::set_join) == !searches_all);
        if (!searches_all)
            CHECK(holds(text_of_plans(*stage), "sets a and b are joined: 40 boxes are looked up in an index of 300"));
    }
    CHECK(tests[true] > 11 * 300 * 299 / 2);
    CHECK(tests[false] < 11 * 40 * 300 * 2);
    // Without sets, all are searched again.
    for (std::uint32_t id = 0; id < 340; ++id) filter.set(id, {});
    const auto stage = filtered(global_of({}), filter);
    insert_all(*stage, 340);
    for (const bool has_sets : {true, false, true, false}) {
        for (std::uint32_t id = 0; has_sets && id < 340; ++id)
            filter.set(id, {.set = id < 300 ? object_set::a : object_set::b});
        for (std::uint32_t id = 0; !has_sets && id < 340; ++id) filter.set(id, {});
        for (int frame = 0; frame < 3; ++frame) {
            std::vector<index_pair> expected = overlapping(boxes(frame));
            std::erase_if(expected, [&](index_pair p) {
                return (has_sets && (p.a < 300) == (p.b < 300)) || p == index_pair{7, 310};
            });
            CHECK(found_by(*stage, boxes(frame)) == expected);
        }
    }
}

TEST_CASE("a join ends once searching both sets costs less, and begins again") {
    // Two sets of 300 boxes: piles in the first frames and in the last, apart from each other and from all meanwhile.
    collision_filter filter;
    for (std::uint32_t id = 0; id < 600; ++id) filter.set(id, {.set = id % 2 == 0 ? object_set::a : object_set::b});
    const auto boxes = [](int frame) {
        std::vector<box> row;
        for (int id = 0; id < 600; ++id) {
            const bool in_pile = frame < 10 || frame >= 300;
            const auto low = static_cast<float>(in_pile ? 1000 * (id % 2) + id % 7 : 3 * id + frame % 3);
            row.push_back({{low, low, low}, {low + 4, low + 4, low + 4}});
        }
        return row;
    };
    const auto stage = filtered(global_of({}), filter);
    insert_all(*stage, 600);
    std::vector<bool> joins;
    for (int frame = 0; frame < 310; ++frame) {
        std::vector<index_pair> expected = overlapping(boxes(frame));
        std::erase_if(expected, [](index_pair p) { return p.a % 2 == p.b % 2; });
        REQUIRE(found_by(*stage, boxes(frame)) == expected);
        joins.push_back(has_plan(*stage, plan_kind::set_join));
    }
    CHECK(joins[9]);
    CHECK_FALSE(joins[299]);
    CHECK(holds(text_of_plans(*stage), "sets a and b are joined: 300 boxes are looked up in an index of 300"));
    CHECK(joins[309]);
}

TEST_CASE("what moved while two sets were joined is searched again") {
    std::vector<box> boxes, before;
    for (int id = 0; id < 600; ++id) {
        const auto low = static_cast<float>(1000 * (id % 2) + id % 7);
        boxes.push_back({{low, low, low}, {low + 4, low + 4, low + 4}});
    }
    collision_filter filter;
    const auto stage = filtered(global_of({}), filter);
    insert_all(*stage, 600);
    for (int frame = 0; frame < 16; ++frame) {
        const bool has_sets = 5 <= frame && frame < 12;
        for (std::uint32_t id = 0; id < 600; ++id)
            filter.set(id, {.set = !has_sets ? object_set::none : id % 2 == 0 ? object_set::a : object_set::b});
        if (frame == 9) boxes[0] = moved(boxes[0], {500, 0, 0});
        const std::vector<std::uint32_t> said = ids_of_moved(before, boxes);
        stage->moved(said);
        before = boxes;
        std::vector<index_pair> expected = overlapping(boxes);
        std::erase_if(expected, [&](index_pair p) { return has_sets && p.a % 2 == p.b % 2; });
        CHECK(found_by(*stage, boxes) == expected);
        if (frame == 9) CHECK(has_plan(*stage, plan_kind::set_join));
    }
}

TEST_CASE("small sets without pairs of their own are searched together") {
    collision_filter filter;
    for (std::uint32_t id = 0; id < 200; ++id) filter.set(id, {.set = id < 100 ? object_set::a : object_set::b});
    std::vector<box> boxes;
    for (int id = 0; id < 200; ++id) boxes.push_back(cube(static_cast<float>(2 * (id % 100)), 1));
    const auto stage = filtered(global_of({}), filter);
    insert_all(*stage, 200);
    for (int frame = 0; frame < 30; ++frame) CHECK(found_by(*stage, boxes).size() == 100);
    CHECK_FALSE(has_plan(*stage, plan_kind::set_join));
    CHECK(holds(text_of_plans(*stage), "both sets are searched: no join is worth its cost yet"));
}

TEST_CASE("the index holds its memory for objects at rest only") {
    row_with_movers scene(1000, 10);
    const auto bytes = [&](bool searches_all) {
        const auto stage = filtered(searches_all ? of_all_objects(global_of({})) : global_of({}), scene.filter);
        insert_all(*stage, 1010);
        for (int frame = 0; frame < 12; ++frame) found_by(*stage, scene.boxes(frame));
        return bytes_of_part(stage->bytes(), "prepare");
    };
    CHECK(bytes(true) < 1010 * 4);
    CHECK(bytes(false) > 1000 * (sizeof(box) + sizeof(box)));
}

TEST_CASE("detectors take a filter, composed at compile time or at run time") {
    collision_filter filter;
    filter.add_exception({2, 0});
    const std::vector<index_pair> expected{{0, 1}, {1, 2}};
    const std::vector<box> boxes = pile(3);
    const auto check = [&](auto& tested) {
        insert_all(tested, 3);
        CHECK(sorted(tested.pairs(boxes)) == expected);
        CHECK(sorted(tested.pairs(boxes)) == expected);
    };
    detector<filtered_search<plain_search>> composed{filtered_search<plain_search>(filter)};
    check(composed);
    CHECK(bytes_of_part(composed.bytes(), "projections") > 0);
    using prepared = prepared_search<neighbour_list_prepare, plain_search>;
    detector<filtered_search<prepared>> with_list{filtered_search<prepared>(filter)};
    check(with_list);
    auto_detector by_name({"sort=shell"}, many_frames, &filter);
    check(by_name);
    auto_detector of_meshes({tetrahedron(1)}, {0, 0, 0}, {}, many_frames, &filter);
    const std::vector<pose> poses(3);
    std::set<std::pair<std::uint32_t, std::uint32_t>> objects;
    for (const contact& c : of_meshes.contacts(poses)) objects.emplace(c.a, c.b);
    CHECK(objects == std::set<std::pair<std::uint32_t, std::uint32_t>>{{0, 1}, {1, 2}});
    filter.add_exceptions(std::vector<index_pair>{{0, 1}, {1, 2}});
    CHECK(of_meshes.contacts(poses).empty());
    CHECK(by_name.pairs(boxes).empty());
    filter.remove_exceptions(std::vector<index_pair>{{0, 1}, {0, 2}, {1, 2}});
    CHECK(by_name.pairs(boxes).size() == 3);
}

TEST_CASE("a counted search that is filtered has its counters") {
    using counted = global_search<insertion_sort, none_partition, one_axis_sweep, work_counters>;
    const collision_filter filter;
    filtered_search<counted> search(filter);
    insert_all(search, 3);
    CHECK(found_by(search, pile(3)).size() == 3);
    CHECK(search.counters()[work::box_tests] > 0);
}
