#include <random>
#include <set>

#include "../meshes.hpp"
#include "../strategies/searches.hpp"
#include "filtered_scenes.hpp"

import aabb.auto_detector;
import aabb.partition.none;
import aabb.prepare.neighbour_list;
import aabb.sort.insertion;
import aabb.sweep.one_axis;

using namespace aabb;

namespace {

using plain_search = global_search<insertion_sort, none_partition, one_axis_sweep>;

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
        std::vector<box> all;
        for (std::uint32_t id = 0; id < resting + movers; ++id) {
            const bool rests = id < resting;
            const auto x = static_cast<float>(rests ? id : 7 * (id - resting) + 3 * static_cast<std::uint32_t>(frame));
            all.push_back({{x, rests ? 0.0F : 1.0F, 0}, {x + 1, rests ? 1.0F : 2.0F, 1}});
        }
        return all;
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
    filter.leave_out({4, 3});
    filter.leave_out(std::vector<index_pair>{{9, 1}, {3, 4}, {0, 2}});
    CHECK_FALSE(filter.keeps(3, 4));
    CHECK_FALSE(filter.keeps(1, 9));
    CHECK_FALSE(filter.keeps(2, 0));
    CHECK(filter.keeps(1, 2));
    const auto pairs = filter.exceptions();
    CHECK(std::vector<index_pair>(pairs.begin(), pairs.end()) == std::vector<index_pair>{{0, 2}, {1, 9}, {3, 4}});
}

TEST_CASE("a search that is filtered appends to what is there") {
    collision_filter filter;
    filter.leave_out({0, 1});
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
    std::map<filtering, std::uint64_t> tests;
    for (const auto when : {filtering::early, filtering::late}) {
        const auto stage =
            filtered(global_of(composed({{strategy_kind::sort, "insertion"}}), instrumentation::counters), scene.filter,
                     when, instrumentation::counters);
        insert_all(*stage, 4010);
        for (int frame = 0; frame < 20; ++frame) {
            if (frame == 14) tests[when] = stage->counters()[work::box_tests];
            CHECK(found_by(*stage, scene.boxes(frame)) == scene.expected(frame));
        }
        tests[when] = stage->counters()[work::box_tests] - tests[when];
    }
    CHECK(scene.expected(3).size() > 10);
    CHECK(tests[filtering::late] > 6 * 4000);
    // A query tests eight boxes in each node that it opens.
    CHECK_BETWEEN(6 * 10 * 8, tests[filtering::early], 6 * 10 * 8 * 30);
}

TEST_CASE("few objects at rest are searched with the others") {
    row_with_movers scene(30, 10);
    const auto stage = filtered(global_of({}), scene.filter, filtering::early, instrumentation::counters);
    insert_all(*stage, 40);
    for (int frame = 0; frame < 9; ++frame) CHECK(found_by(*stage, scene.boxes(frame)) == scene.expected(frame));
    CHECK(stage->counters()[work::box_tests] == 0);  // of the index
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
    for (int frame = 0; frame < 9; ++frame) check();  // until there is an index
    boxes[199] = boxes[207];                          // moves, but rests
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
    filter.leave_out({7, 310});
    std::vector<bool> present(340, true);
    const auto boxes = [](int frame) {
        std::vector<box> all;
        for (int id = 0; id < 340; ++id) {
            const auto low = static_cast<float>(id < 300 ? id % 5 + frame % 2 : 4 * (id - 300) - 40 * frame);
            const auto high = low + static_cast<float>(id < 300 ? 30 : 3);
            all.push_back({{low, low, low}, {high, high, high}});
        }
        return all;
    };
    std::map<filtering, std::uint64_t> tests;
    for (const filtering when : {filtering::early, filtering::late}) {
        present.assign(340, true);
        const auto stage =
            filtered(global_of(composed({{strategy_kind::sort, "insertion"}}), instrumentation::counters), filter, when,
                     instrumentation::counters);
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
            if (frame == 0) tests[when] = stage->counters()[work::box_tests];
        }
        CHECK(kept > 1000);
        tests[when] = stage->counters()[work::box_tests] - tests[when];
    }
    CHECK(tests[filtering::late] > 11 * 300 * 299 / 2);
    CHECK(tests[filtering::early] < 11 * 40 * 300 * 2);
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

TEST_CASE("the index holds its memory for objects at rest only") {
    row_with_movers scene(1000, 10);
    const auto bytes = [&](filtering when) {
        const auto stage = filtered(global_of({}), scene.filter, when);
        insert_all(*stage, 1010);
        for (int frame = 0; frame < 12; ++frame) found_by(*stage, scene.boxes(frame));
        return bytes_of_part(stage->bytes(), "prepare");
    };
    CHECK(bytes(filtering::late) < 1010 * 4);
    CHECK(bytes(filtering::early) > 1000 * (sizeof(box) + sizeof(box)));
}

TEST_CASE("detectors take a filter, composed at compile time or at run time") {
    collision_filter filter;
    filter.leave_out({2, 0});
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
    filter.leave_out(std::vector<index_pair>{{0, 1}, {1, 2}});
    CHECK(of_meshes.contacts(poses).empty());
    CHECK(by_name.pairs(boxes).empty());
}

TEST_CASE("a counted search that is filtered has its counters") {
    using counted = global_search<insertion_sort, none_partition, one_axis_sweep, work_counters>;
    const collision_filter filter;
    filtered_search<counted> search(filter);
    insert_all(search, 3);
    CHECK(found_by(search, pile(3)).size() == 3);
    CHECK(search.counters()[work::box_tests] > 0);
}
