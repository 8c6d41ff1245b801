#include "costs.hpp"
#include "searches.hpp"

using namespace aabb;

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

box moved_a_little(const box& b) {
    vec3f by{};
    const auto k = *rc::gen::inRange(0, 3);
    by[k] = static_cast<float>(*rc::gen::inRange(-2, 3)) / 32;
    return moved(b, by);
}

/// Whether its brute-force threshold exceeds a test's number of boxes, so that none is sorted or cut.
bool is_brute_force(const aabb::composition& c) {
    return std::ranges::any_of(c[strategy_kind::partition].settings,
                               [](const auto& s) { return s.name == "few" && s.value == "4096"; });
}

}  // namespace

// The sort, the splitting and the costs of work are drawn with the boxes: a property for each of them too would take
// minutes. With RC_PARAMS=max_success=14000 in the environment these are more than a million cases.
TEST_CASE("every composition finds exactly the overlapping pairs as objects come, move and go, whatever work costs",
          "[long]") {
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
                    if (rejection_of(c, stage::global_search).empty() && is_exact(c, stage::global_search) &&
                        needs_meshes(c).empty())
                        compositions.push_back(c);
                }
            if (compositions.empty()) continue;
            INFO(to_text(partition) << " + " << to_text(sweep));
            REQUIRE(rc::check([&] {
                const scoped_costs costs(*rc::gen::arbitrary<bool>() ? any_costs() : cost_model());
                const aabb::composition composition = *rc::gen::elementOf(compositions);
                RC_LOG(text_of_global(composition));
                const auto stage = global_of(composition);
                const int world = *rc::gen::element(1, 6, 40);
                const bool flat = *rc::gen::arbitrary<bool>();
                // Small steps, so that lists may serve.
                const bool creeps = *rc::gen::arbitrary<bool>();
                const auto n = *rc::gen::inRange<std::size_t>(0, 60);
                std::vector<box> boxes(n), before;
                std::vector<bool> present(n);
                bool any_yet = false;
                for (int frame = 0; frame < 6; ++frame) {
                    // From frames in which all move to frames in which none does.
                    const int one_in = *rc::gen::element(0, 1, 4);
                    for (std::uint32_t id = 0; id < n; ++id) {
                        const bool moves = frame == 0 || (one_in > 0 && *rc::gen::inRange(0, one_in) == 0);
                        if (moves) boxes[id] = frame > 0 && creeps ? moved_a_little(boxes[id]) : any_box(world);
                        if (flat) boxes[id].min[1] = boxes[id].max[1] = static_cast<float>(frame / 2 % 2 * id);
                        for (int times = *rc::gen::element(0, 0, 0, 1, 2); times > 0; --times) {
                            present[id] ? stage->remove(id) : stage->insert(id);
                            present[id] = !present[id];
                        }
                    }
                    // Before the first object comes there are no boxes: a scene may begin empty.
                    any_yet |= std::ranges::find(present, true) != present.end();
                    const auto frame_boxes = std::span(boxes).first(any_yet ? n : 0);
                    const std::vector<std::uint32_t> said = ids_of_moved(before, frame_boxes);
                    if (*rc::gen::arbitrary<bool>()) stage->moved(said);
                    before.assign(frame_boxes.begin(), frame_boxes.end());
                    RC_ASSERT(found_by(*stage, frame_boxes) == overlapping(boxes, present));
                }
            }));
        }
}

TEST_CASE("a composition rejects invalid calls, does not search after them, and stays usable") {
    const std::vector<box> boxes(3, cube(0, 1));
    std::vector<box> inverted = boxes;
    inverted[2].max[0] = -1;
    for (const aabb::composition& composition : global_compositions()) {
        INFO(text_of_global(composition));
        const auto stage = global_of(composition);
        std::vector<index_pair> pairs;
        const auto check_no_frame = [&] {
            CHECK_REFUSED(stage->search(pairs),
                          "there is no frame to search: update was not called, or did not succeed");
        };
        check_no_frame();
        CHECK(found_by(*stage, {}).empty());
        CHECK_REFUSED(stage->update(boxes), "no object was inserted; call insert(id) for each box first");
        insert_all(*stage, 3);
        CHECK_REFUSED(stage->insert(1), "object 1 is inserted twice");
        CHECK_REFUSED(stage->insert_all(std::array<std::uint32_t, 2>{2, 1}), "object 2 is inserted twice");
        CHECK_REFUSED(stage->remove(7), "object 7 is removed but was never inserted");
        CHECK_REFUSED(stage->update(std::span(boxes).first(2)), "object 2 is present, but the frame has only 2 boxes");
        check_no_frame();
        CHECK(found_by(*stage, boxes).size() == 3);
        CHECK_REFUSED(stage->update(inverted), "box 2 is inverted: its minimum is above its maximum");
        check_no_frame();
        CHECK(found_by(*stage, boxes).size() == 3);
        for (std::uint32_t id = 0; id < 3; ++id) stage->remove(id);
        CHECK(found_by(*stage, boxes).empty());
    }
}

TEST_CASE("every composition finds the pairs after all boxes moved, with and without counters") {
    constexpr std::uint32_t n = 200;
    std::array<std::vector<box>, 2> frames;
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto x = static_cast<float>(i * 37 % 100);
        const auto y = static_cast<float>(i * 61 % 90);
        frames[0].push_back({{x, y, 0}, {x + 5, y + 5, 5}});
        // Displaced relative to each other by more than any margin.
        const float shift = 0.5F + 20 * static_cast<float>(i % 3);
        frames[1].push_back(moved(frames[0].back(), {shift, shift, shift}));
    }
    const std::array expected{overlapping(frames[0]), overlapping(frames[1])};
    for (const aabb::composition& composition : global_compositions()) {
        INFO(text_of_global(composition));
        const auto plain = global_of(composition);
        const auto counted = search_of(composition, n);
        insert_all(*plain, n);
        for (std::size_t f = 0; f < frames.size(); ++f)
            for (const auto* stage : {&plain, &counted}) CHECK(found_by(**stage, frames[f]) == expected[f]);
        // Sorts that compare count comparisons, the others moved entries.
        if (!is_brute_force(composition))
            CHECK(counted->counters()[work::comparisons] + counted->counters()[work::moves] >= n - 1);
        CHECK(counted->counters()[work::box_tests] > 0);
#if !__has_feature(address_sanitizer)  // with it, every search counts (`aabb.composed`)
        CHECK(plain->counters()[work::box_tests] == 0);
#endif
    }
}

TEST_CASE("without a partition there are no cells and no copies") {
    std::vector<box> boxes;
    for (int i = 0; i < 80; ++i) {
        const vec3f at{static_cast<float>(i), static_cast<float>(i * 7 % 80), static_cast<float>(i * 11 % 80)};
        boxes.push_back({at, at + vec3f{1, 1, 1}});
    }
    for (const aabb::composition& composition : global_compositions()) {
        INFO(text_of_global(composition));
        if (is_brute_force(composition)) continue;
        const auto stage = search_of(composition, boxes.size());
        found_by(*stage, boxes);
        const bool whole = composition[strategy_kind::partition].name == "none";
        const bool has_trees = composition[strategy_kind::sweep].name == "segment_tree";
        const auto parts = stage->bytes();
        CHECK(std::ranges::none_of(parts, [](const part_bytes& p) { return p.part == "partition"; }) == whole);
        CHECK((stage->counters()[work::subsets] == 0) == (whole && !has_trees));
        // A partition that cuts nothing copies nothing.
        CHECK((stage->counters()[work::subset_copies] == 0) == (stage->counters()[work::subsets] <= 1));
        CHECK(leaves_out(*stage, absence::partition) == whole);
    }
}

TEST_CASE("the list of an unused axis takes no memory") {
    std::vector<box> boxes;
    for (int i = 0; i < 500; ++i) boxes.push_back({{1, static_cast<float>(i), 1}, {2, static_cast<float>(i + 1), 2}});
    const auto projections = [&](const char* sweep) {
        const auto stage = search_of(composed({{strategy_kind::sweep, sweep}}), boxes.size());
        stage->update(boxes);
        return stage->bytes()[0].bytes;
    };
    CHECK(projections("one_axis:axis=y") == projections("one_axis:axis=x"));
    CHECK(projections("one_axis:axis=x") < 500 * (sizeof(projection) + 4));
}

TEST_CASE("a flat scene has no list of its flat axis") {
    const auto stage = search_of(composed({{strategy_kind::sweep, "all_axes"}}), 40);
    std::vector<box> boxes = scattered(40, 3);
    for (box& b : boxes) b.min[2] = 0, b.max[2] = 1;
    stage->update(boxes);
    const std::size_t two_lists = stage->bytes()[0].bytes;
    CHECK(leaves_out(*stage, absence::z_list));
    boxes[0].min[2] = boxes[0].max[2] = 5;
    stage->update(boxes);
    CHECK(stage->bytes()[0].bytes >= two_lists + 40 * sizeof(projection));
}

TEST_CASE("a grid of too many cells is rejected") {
    const auto pairs = [](const std::string& cell_size, const std::vector<box>& boxes) {
        const std::string grid = "uniform_grid:cell_size=" + cell_size;
        const auto stage = search_of(composed({{strategy_kind::partition, grid.c_str()}}), boxes.size());
        return found_by(*stage, boxes).size();
    };
    const std::vector<box> far = {cube(0, 1), cube(99, 1)};
    CHECK_REFUSED(pairs("1e-09", far), "uniform_grid: a cell_size of 1e-09 cuts this world into more than 2^26 cells");
    CHECK_THROWS_AS(pairs("1e-310", far), input_error);
    CHECK(pairs("1000", far) == 0);
    // On a flat axis there is one cell, whatever its size.
    const std::vector<box> point(2, {{1, 2, 3}, {1, 2, 3}});
    CHECK(pairs("1e-310", point) == 1);
}

TEST_CASE("too many copies are counted and rejected, and the search stays usable") {
    std::vector<box> nested;  // box i spans 300 - i segments of each axis
    for (int i = 0; i < 300; ++i) {
        const auto low = static_cast<float>(i);
        nested.push_back({{low, low, low}, {1000, 1000, 1000}});
    }
    for (const auto& [partition, boxes, sentence] :
         {std::tuple{"axial_cut:axes=3,segments=65535,limit=off", nested,
                     "axial_cut makes 2038522500 copies of 300 objects, but at most 16796416 (2^24 + 64 per object) "
                     "are allowed; fewer cuts make fewer copies"},
          std::tuple{"uniform_grid:cell_size=1", std::vector(200, cube(0, 400)),
                     "uniform_grid makes 12896240200 copies of 200 objects, but at most 16790016 (2^24 + 64 per "
                     "object) are allowed; fewer cuts make fewer copies"},
          std::tuple{"uniform_grid:cell_size=1", std::vector(200, cube(0, 60)),
                     "uniform_grid makes 45396200 copies of 200 objects, but at most 16790016 (2^24 + 64 per "
                     "object) are allowed; fewer cuts make fewer copies"},
          std::tuple{"sorted_grid:cell_size=1", std::vector(200, cube(0, 400)),
                     "sorted_grid makes 32160200 copies of 200 objects, but at most 16790016 (2^24 + 64 per object) "
                     "are allowed; larger cells make fewer copies"}}) {
        const auto stage = search_of(composed({{strategy_kind::partition, partition}}), boxes.size());
        CHECK_REFUSED(stage->update(boxes), sentence);
        // Nothing of that size was allocated.
        CHECK(stage->bytes()[2].bytes < std::size_t{1} << 30);
    }
    for (const auto& [partition, rejected] :
         {std::pair{"uniform_grid:cell_size=0.1", 1e6F}, {"axial_cut:axes=3,segments=65535", 0.0F}}) {
        INFO(partition);
        const auto stage =
            search_of(composed({{strategy_kind::sort, "insertion"}, {strategy_kind::partition, partition}}), 1000);
        std::vector<box> points;
        for (int i = 0; i < 1000; ++i) {
            const vec3f p{static_cast<float>(i) + (i == 0 ? rejected : 0), static_cast<float>(i * 7 % 1000),
                          static_cast<float>(i * 11 % 1000)};
            points.push_back({p, p});
        }
        CHECK_THROWS_AS(stage->update(points), input_error);
        CHECK(found_by(*stage, std::vector(1000, cube(0, 1))).size() == 1000 * 999 / 2);
    }
}

TEST_CASE("the sort axis is the one on which objects vary, even far from the origin") {
    const auto stage = search_of(composed({{strategy_kind::sweep, "one_axis"}}), 100);
    std::vector<box> boxes;
    for (int i = 0; i < 100; ++i) {
        const vec3f at{1e9F, 1e9F, static_cast<float>(i)};
        boxes.push_back({at, at});
    }
    stage->update(boxes);
    CHECK(leaves_out(*stage, absence::x_list));
    CHECK_FALSE(leaves_out(*stage, absence::z_list));
}
