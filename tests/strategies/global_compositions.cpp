#include <rapidcheck.h>
#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_exception.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "../compositions.hpp"
#include "overlapping.hpp"

using namespace aabb;
using Catch::Matchers::Message;

namespace {

/// Corners on a coarse lattice, so that most of them tie.
box any_box(int world) {
    box b;
    for (int k = 0; k < 3; ++k) {
        b.min[k] = static_cast<float>(*rc::gen::inRange(0, world)) / 2;
        // Some large ones, for limits of cuts and for splitting.
        b.max[k] = b.min[k] + static_cast<float>(*rc::gen::element(0, 0, 1, 1, 2, 3, 40)) / 2;
    }
    return b;
}

/// Whether all boxes of a test are so few for it that none is sorted or cut.
bool tests_all(const aabb::composition& c) {
    return std::ranges::any_of(c[strategy_kind::partition].settings,
                               [](const auto& s) { return s.name == "few" && s.value == "4096"; });
}

}  // namespace

// The sort and the splitting are drawn with the boxes: a property for each of them too would take minutes. With
// RC_PARAMS=max_success=14000 in the environment these are more than a million cases.
TEST_CASE("every composition finds exactly the overlapping pairs while objects come, move and go") {
    const std::vector<strategy_choice> sorts = all_choices(strategy_kind::sort);
    std::vector<strategy_choice> prepares = all_choices(strategy_kind::prepare);
    prepares.push_back({"split_large", {{"size", "0.5"}}});
    for (const strategy_choice& partition : all_choices(strategy_kind::partition))
        for (const strategy_choice& sweep : all_choices(strategy_kind::sweep)) {
            std::vector<aabb::composition> compositions;
            for (const strategy_choice& sort : sorts)
                for (const strategy_choice& prepare : prepares) {
                    aabb::composition c;
                    c[strategy_kind::prepare] = prepare;
                    c[strategy_kind::sort] = sort;
                    c[strategy_kind::partition] = partition;
                    c[strategy_kind::sweep] = sweep;
                    if (refusal_of(c, stage::global_search).empty() && is_exact(c, stage::global_search) &&
                        needs_meshes(c).empty())
                        compositions.push_back(c);
                }
            if (compositions.empty()) continue;
            INFO(to_text(partition) << " + " << to_text(sweep));
            REQUIRE(rc::check([&] {
                const aabb::composition composition = *rc::gen::elementOf(compositions);
                RC_LOG(text_of_global(composition));
                const auto stage = global_of(composition, instrumentation::none);
                const int world = *rc::gen::element(1, 6, 40);
                const bool flat = *rc::gen::arbitrary<bool>();
                const auto n = *rc::gen::inRange<std::size_t>(0, 60);
                std::vector<box> boxes(n);
                std::vector<bool> present(n);
                std::vector<index_pair> found;
                bool any_yet = false;
                for (int frame = 0; frame < 6; ++frame) {
                    // From frames in which all move to frames in which none does.
                    const int unrest = *rc::gen::element(0, 1, 4);
                    for (std::uint32_t id = 0; id < n; ++id) {
                        if (frame == 0 || (unrest > 0 && *rc::gen::inRange(0, unrest) == 0)) boxes[id] = any_box(world);
                        if (flat) boxes[id].min[1] = boxes[id].max[1] = static_cast<float>(frame / 2 % 2 * id);
                        for (int times = *rc::gen::element(0, 0, 0, 1, 2); times > 0; --times) {
                            present[id] ? stage->remove(id) : stage->insert(id);
                            present[id] = !present[id];
                        }
                    }
                    found.clear();
                    // Before the first object comes there are no boxes: a scene of nobody may begin.
                    any_yet |= std::ranges::find(present, true) != present.end();
                    stage->update(std::span(boxes).first(any_yet ? n : 0));
                    stage->search(found);
                    std::ranges::sort(found);
                    RC_ASSERT(found == overlapping(boxes, present));
                }
            }));
        }
}

TEST_CASE("a composition refuses boxes and ids that make no sense, and can go on") {
    for (const aabb::composition& composition : all_global_compositions()) {
        INFO(text_of_global(composition));
        const auto stage = global_of(composition, instrumentation::none);
        std::vector<box> boxes(3, box{{0, 0, 0}, {1, 1, 1}});
        for (std::uint32_t id = 0; id < 3; ++id) stage->insert(id);
        CHECK_THROWS_MATCHES(stage->insert(1), input_error, Message("object 1 is inserted twice"));
        CHECK_THROWS_MATCHES(stage->remove(7), input_error, Message("object 7 is removed but was never inserted"));
        CHECK_THROWS_MATCHES(stage->update(std::vector<box>(2, boxes[0])), input_error,
                             Message("object 2 is present, but the frame has only 2 boxes"));
        boxes[2].max[0] = -1;
        CHECK_THROWS_MATCHES(stage->update(boxes), input_error,
                             Message("box 2 is inverted: its minimum is above its maximum"));
        boxes[2].max[0] = 1;
        std::vector<index_pair> found;
        stage->update(boxes);
        stage->search(found);
        CHECK(found.size() == 3);
    }
}

TEST_CASE("boxes of which no object was inserted are refused, and no boxes or objects that have left are not") {
    const std::vector<box> boxes(2, box{{0, 0, 0}, {1, 1, 1}});
    for (const aabb::composition& composition : all_global_compositions()) {
        INFO(text_of_global(composition));
        const auto stage = global_of(composition, instrumentation::none);
        std::vector<index_pair> found;
        stage->update({});
        stage->search(found);
        CHECK_THROWS_MATCHES(stage->update(boxes), input_error,
                             Message("no object was inserted; call insert(id) for each box first"));
        stage->insert(0);
        stage->insert(1);
        stage->update(boxes);
        stage->remove(0);
        stage->remove(1);
        stage->update(boxes);
        stage->search(found);
        CHECK(found.empty());
    }
}

TEST_CASE("a frame that was not taken is not searched") {
    std::vector<box> boxes(2, box{{0, 0, 0}, {1, 1, 1}});
    for (const aabb::composition& composition : all_global_compositions()) {
        INFO(text_of_global(composition));
        const auto stage = global_of(composition, instrumentation::none);
        stage->insert(0);
        stage->insert(1);
        std::vector<index_pair> found;
        const auto nothing = Message("there is no frame to search: update was not called, or did not succeed");
        CHECK_THROWS_MATCHES(stage->search(found), input_error, nothing);
        stage->update(boxes);
        boxes[1].min[0] = 2;
        CHECK_THROWS_AS(stage->update(boxes), input_error);
        CHECK_THROWS_MATCHES(stage->search(found), input_error, nothing);
        boxes[1].min[0] = 1;
        stage->update(boxes);
        stage->search(found);
        CHECK(found.size() == 1);
    }
}

TEST_CASE("counted compositions do the same and say what they did") {
    std::vector<box> boxes;
    for (int i = 0; i < 200; ++i) {
        const auto x = static_cast<float>(i * 37 % 100);
        const auto y = static_cast<float>(i * 61 % 90);
        boxes.push_back({{x, y, 0}, {x + 5, y + 5, 5}});
    }
    for (const aabb::composition& composition : all_global_compositions()) {
        INFO(text_of_global(composition));
        const auto plain = global_of(composition, instrumentation::none);
        const auto counted = global_of(composition, instrumentation::counters);
        std::vector<index_pair> pairs;
        std::vector<index_pair> counted_pairs;
        for (const auto& [stage, out] : {std::pair{plain.get(), &pairs}, std::pair{counted.get(), &counted_pairs}})
            for (int frame = 0; frame < 2; ++frame) {
                if (frame == 0)
                    for (std::uint32_t id = 0; id < boxes.size(); ++id) stage->insert(id);
                std::vector<box> moved = boxes;
                for (std::uint32_t id = 0; id < boxes.size(); ++id)
                    for (int k = 0; k < 3; ++k) {
                        // Apart from each other by more than any margin.
                        const auto way = static_cast<float>(frame) * (0.5F + 20 * static_cast<float>(id % 3));
                        moved[id].min[k] += way;
                        moved[id].max[k] += way;
                    }
                stage->update(moved);
                stage->search(*out);
            }
        std::ranges::sort(pairs);
        std::ranges::sort(counted_pairs);
        CHECK(pairs == counted_pairs);
        // Whoever sorts by comparing counts those, whoever does not the entries moved.
        if (!tests_all(composition))
            CHECK(counted->counters()[work::comparisons] + counted->counters()[work::moves] >= boxes.size() - 1);
        CHECK(counted->counters()[work::box_tests] > 0);
        CHECK(plain->counters()[work::box_tests] == 0);
    }
}

TEST_CASE("without a partition there are no cells and no copies") {
    std::vector<box> boxes;
    for (int i = 0; i < 80; ++i) {
        const vec3f at{static_cast<float>(i), static_cast<float>(i * 7 % 80), static_cast<float>(i * 11 % 80)};
        boxes.push_back({at, at + vec3f{1, 1, 1}});
    }
    for (const aabb::composition& composition : all_global_compositions()) {
        INFO(text_of_global(composition));
        if (tests_all(composition)) continue;
        const auto stage = global_of(composition, instrumentation::counters);
        for (std::uint32_t id = 0; id < boxes.size(); ++id) stage->insert(id);
        std::vector<index_pair> pairs;
        stage->update(boxes);
        stage->search(pairs);
        const bool whole = composition[strategy_kind::partition].name == "none";
        const auto parts = stage->bytes();
        CHECK(std::ranges::none_of(parts, [](const part_bytes& p) { return p.part == "partition"; }) == whole);
        CHECK((stage->counters()[work::subsets] == 0) == whole);
        // A partition that cuts nothing copies nothing.
        CHECK((stage->counters()[work::subset_copies] == 0) == (stage->counters()[work::subsets] <= 1));
        CHECK(std::ranges::any_of(stage->left_out(), [](const omission& one) { return one.what == "no partition"; }) ==
              whole);
    }
}

TEST_CASE("a list of an axis that is not needed takes no memory") {
    std::vector<box> boxes;
    for (int i = 0; i < 500; ++i) boxes.push_back({{1, static_cast<float>(i), 1}, {2, static_cast<float>(i + 1), 2}});
    const auto projections = [&](const char* axis) {
        const auto stage =
            global_of(composed({{strategy_kind::sweep, (std::string("one_axis:axis=") + axis).c_str()}}));
        for (std::uint32_t id = 0; id < boxes.size(); ++id) stage->insert(id);
        stage->update(boxes);
        return stage->bytes()[0].bytes;
    };
    CHECK(projections("y") == projections("x"));
    CHECK(projections("x") < 500 * (sizeof(projection) + 4));
}

TEST_CASE("a flat scene drops its flat axis") {
    const auto stage = global_of(composed({{strategy_kind::sweep, "all_axes"}}));
    std::vector<box> boxes;
    for (std::uint32_t id = 0; id < 40; ++id) {
        stage->insert(id);
        const auto x = static_cast<float>(id * 7 % 40);
        const auto y = static_cast<float>(id * 11 % 40);
        boxes.push_back({{x, y, 0}, {x + 3, y + 3, 1}});
    }
    stage->update(boxes);
    const std::size_t two_lists = stage->bytes()[0].bytes;
    CHECK(std::ranges::count(stage->left_out(), "no projection list of the z axis", &omission::what) == 1);
    boxes[0].min[2] = boxes[0].max[2] = 5;
    stage->update(boxes);
    CHECK(stage->bytes()[0].bytes >= two_lists + 40 * sizeof(projection));
}

TEST_CASE("a grid that no machine can hold is refused") {
    const auto search = [](const char* cell_size, const std::vector<box>& boxes) {
        const auto stage = global_of(
            composed({{strategy_kind::partition, (std::string("uniform_grid:cell_size=") + cell_size).c_str()}}));
        for (std::uint32_t id = 0; id < boxes.size(); ++id) stage->insert(id);
        std::vector<index_pair> pairs;
        stage->update(boxes);
        stage->search(pairs);
        return pairs.size();
    };
    const std::vector<box> far = {{{0, 0, 0}, {1, 1, 1}}, {{99, 99, 99}, {100, 100, 100}}};
    CHECK_THROWS_MATCHES(search("1e-09", far), input_error,
                         Message("uniform_grid: a cell_size of 1e-09 cuts this world into more than 2^26 cells"));
    CHECK_THROWS_AS(search("1e-310", far), input_error);
    CHECK(search("1000", far) == 0);
    // On a flat axis there is one cell, whatever its size.
    const std::vector<box> point = {{{1, 2, 3}, {1, 2, 3}}, {{1, 2, 3}, {1, 2, 3}}};
    CHECK(search("1e-310", point) == 1);
}

TEST_CASE("copies that no machine can hold are counted and refused") {
    std::vector<box> nested;  // box i reaches over 300 - i segments of each axis
    for (int i = 0; i < 300; ++i) {
        const auto low = static_cast<float>(i);
        nested.push_back({{low, low, low}, {1000, 1000, 1000}});
    }
    for (const auto& [partition, boxes, sentence] :
         {std::tuple{"axial_cut:axes=3,segments=65535,limit=off", nested,
                     "axial_cut makes 2038522500 copies of 300 objects, but at most 16796416 (2^24 + 64 an object) are "
                     "allowed; fewer cuts make fewer"},
          std::tuple{"uniform_grid:cell_size=1", std::vector(200, box{{0, 0, 0}, {400, 400, 400}}),
                     "uniform_grid makes 12896240200 copies of 200 objects, but at most 16790016 (2^24 + 64 an "
                     "object) are allowed; fewer cuts make fewer"},
          std::tuple{"uniform_grid:cell_size=1", std::vector(200, box{{0, 0, 0}, {60, 60, 60}}),
                     "uniform_grid makes 45396200 copies of 200 objects, but at most 16790016 (2^24 + 64 an "
                     "object) are allowed; fewer cuts make fewer"}}) {
        const auto stage = global_of(composed({{strategy_kind::partition, partition}}));
        for (std::uint32_t id = 0; id < boxes.size(); ++id) stage->insert(id);
        CHECK_THROWS_MATCHES(stage->update(boxes), input_error, Message(sentence));
        // Nothing of that size was made.
        CHECK(stage->bytes()[2].bytes < std::size_t{1} << 30);
    }
}

TEST_CASE("a search goes on after its partition refused a frame") {
    for (const auto& [partition, refused] :
         {std::pair{"uniform_grid:cell_size=0.1", 1e6F}, {"axial_cut:axes=3,segments=65535", 0.0F}}) {
        INFO(partition);
        const auto stage =
            global_of(composed({{strategy_kind::sort, "insertion"}, {strategy_kind::partition, partition}}));
        std::vector<box> points;
        for (std::uint32_t id = 0; id < 1000; ++id) {
            stage->insert(id);
            const vec3f p{static_cast<float>(id) + (id == 0 ? refused : 0), static_cast<float>(id * 7 % 1000),
                          static_cast<float>(id * 11 % 1000)};
            points.push_back({p, p});
        }
        std::vector<index_pair> pairs;
        CHECK_THROWS_AS(stage->update(points), input_error);
        const std::vector<box> together(1000, box{{0, 0, 0}, {1, 1, 1}});
        stage->update(together);
        stage->search(pairs);
        CHECK(pairs.size() == 1000 * 999 / 2);
    }
}

TEST_CASE("far from the origin the axis to sort along is still the one on which objects vary") {
    const auto stage = global_of(composed({{strategy_kind::sweep, "one_axis"}}));
    std::vector<box> boxes;
    for (std::uint32_t id = 0; id < 100; ++id) {
        stage->insert(id);
        const vec3f at{1e9F, 1e9F, static_cast<float>(id)};
        boxes.push_back({at, at});
    }
    stage->update(boxes);
    CHECK(std::ranges::count(stage->left_out(), "no projection list of the x axis", &omission::what) == 1);
    CHECK(std::ranges::count(stage->left_out(), "no projection list of the z axis", &omission::what) == 0);
}
