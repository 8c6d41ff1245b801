#include <rapidcheck.h>
#include <catch2/catch_approx.hpp>

#include "searches.hpp"

import aabb.prepare.list_backoff;
import aabb.prepare.relative_motion;

using namespace aabb;

namespace {

aabb::composition list_with(const std::string& margin, const std::string& every) {
    return composed({{strategy_kind::prepare, ("neighbour_list:margin=" + margin + ",every=" + every).c_str()}});
}

std::unique_ptr<global_stage> list_stage(std::size_t objects) {
    return search_of(composed({{strategy_kind::prepare, "neighbour_list"}}), objects);
}

box cube(float at) {
    return {{at, 0, 0}, {at + 1, 1, 1}};
}

/// n unit cubes in a row, with this spacing.
std::vector<box> row(std::size_t n, float spacing) {
    std::vector<box> boxes;
    for (std::size_t i = 0; i < n; ++i) boxes.push_back(cube(spacing * static_cast<float>(i)));
    return boxes;
}

/// Random points in a cube of that edge around the origin.
/// @param random the state of the generator
std::vector<vec3f> scattered(std::size_t n, float edge, std::uint64_t& random) {
    const auto any = [&] {
        random = random * 6364136223846793005U + 1442695040888963407U;
        return edge * (static_cast<float>(random >> 40U) * 0x1p-24F - 0.5F);
    };
    std::vector<vec3f> places(n);
    for (vec3f& place : places) place = {any(), any(), any()};
    return places;
}

/// What the list of a frame reports; 0 if there is none.
double list_value(const global_stage& stage, const char* what) {
    for (const stage_plan& plan : stage.plans())
        if (plan.kind == plan_kind::neighbour_list) return plan.decision[what];
    return 0;
}

double margin_of(const global_stage& stage) {
    return list_value(stage, "margin");
}

/// A stage, and cubes at homes that are scattered in a cube of that edge. Each has a displacement of its own, up to 1/2
/// on each axis.
struct moving_cubes {
    moving_cubes(std::size_t n, float world) : stage(list_stage(n)) {
        std::uint64_t random = 1;
        homes = scattered(n, world, random);
        displacements = scattered(n, 1, random);
    }

    /// @param fraction of its displacement, by cube
    template <std::invocable<std::size_t> Fraction>
    [[nodiscard]] std::vector<box> at(Fraction fraction, float edge = 1) const {
        std::vector<box> boxes;
        for (std::size_t i = 0; i < homes.size(); ++i) {
            vec3f place = homes[i];
            for (int k = 0; k < 3; ++k) place[k] += fraction(i) * displacements[i][k];
            boxes.push_back({place, place + vec3f{edge, edge, edge}});
        }
        return boxes;
    }
    [[nodiscard]] std::vector<box> at(float fraction, float edge = 1) const {
        return at([=](std::size_t) { return fraction; }, edge);
    }

    /// Runs a frame, whose pairs must be exact, and returns the margin of its list.
    double run(const std::vector<box>& boxes) {
        CHECK(found_by(*stage, boxes) == overlapping(boxes));
        return margin_of(*stage);
    }

    std::unique_ptr<global_stage> stage;
    std::vector<vec3f> homes;
    std::vector<vec3f> displacements;
};

/// The box tests of a frame, whose pairs must be exact.
std::uint64_t tests_of(global_stage& stage, const std::vector<box>& boxes) {
    const std::uint64_t before = stage.counters()[work::box_tests];
    CHECK(found_by(stage, boxes) == overlapping(boxes));
    return stage.counters()[work::box_tests] - before;
}

/// The work with a Verlet list, by frame.
struct list_run {
    std::vector<std::uint64_t> tests;  // of listed pairs
    std::vector<std::size_t> pairs;    // that overlap
    int searches = 0;                  // of all boxes
    int last_search = 0;               // the frame
    double margin = 0;                 // of the last list
};

/// Runs frames of unit cubes at scattered homes.
/// @param displacement by frame and box: the fraction of its own displacement, which is up to 1/2 on each axis
template <class Displacement>
list_run run_at_homes(int frames, Displacement displacement) {
    const moving_cubes cubes(600, 5);
    aabb::composition c = composed({{strategy_kind::prepare, "neighbour_list"}});
    c[strategy_kind::sort] = {"std", {}};
    c[strategy_kind::partition] = {"uniform_grid", {{"cell_size", "2"}}};
    c[strategy_kind::sweep] = {"one_axis", {}};
    const auto stage = search_of(c, 600);
    list_run p;
    for (int frame = 0; frame < frames; ++frame) {
        const std::vector<box> boxes = cubes.at([&](std::size_t i) { return displacement(frame, i); });
        const work_counters before = stage->counters();
        const std::vector<index_pair> pairs = found_by(*stage, boxes);
        REQUIRE(pairs == overlapping(boxes));
        p.pairs.push_back(pairs.size());
        p.tests.push_back(stage->counters()[work::box_tests] - before[work::box_tests]);
        if (stage->counters()[work::subsets] == before[work::subsets]) continue;
        ++p.searches;
        p.last_search = frame;
    }
    p.margin = margin_of(*stage);
    return p;
}

bool keeps_list(const global_stage& stage) {
    return !leaves_out(stage, absence::neighbour_list);
}

// Displacements by frame and cube.
float swings(int frame, std::size_t /*cube*/) {
    return 0.01F * std::sin(0.8F * static_cast<float>(frame));
}
auto drifts(float pace) {
    return [pace](int frame, std::size_t) { return pace * static_cast<float>(frame); };
}

}  // namespace

TEST_CASE("a neighbour list is rebuilt when an object leaves its grown box, and not before") {
    // Extents are 1, so boxes are grown by a half.
    std::vector<box> boxes{cube(0), cube(1.75F), cube(10), cube(20)};
    aabb::composition c = list_with("0.5", "0");
    c[strategy_kind::partition] = {"uniform_grid", {}};
    const auto stage = search_of(c, boxes.size());
    // Each search makes new cells.
    const auto cells = [&] { return stage->counters()[work::subsets]; };
    CHECK(found_by(*stage, boxes).empty());
    const std::uint64_t first = cells();
    CHECK(first > 0);
    boxes[0] = cube(0.5F);
    boxes[1] = cube(1.5F);
    CHECK(found_by(*stage, boxes) == std::vector<index_pair>{{0, 1}});
    CHECK(cells() == first);
    stage->remove(3);
    CHECK(found_by(*stage, boxes).size() == 1);
    CHECK(cells() == first);
    boxes[2] = cube(2.25F);
    CHECK(found_by(*stage, boxes) == std::vector<index_pair>{{0, 1}, {1, 2}});
    const std::uint64_t second = cells();
    CHECK(second > first);
    boxes[3] = cube(0);
    stage->insert(3);
    CHECK(found_by(*stage, boxes) == std::vector<index_pair>{{0, 1}, {0, 3}, {1, 2}});
    CHECK(cells() > second);
}

TEST_CASE("the plan of a list is reported in numbers and as a sentence") {
    const auto stage = search_of(list_with("0.5", "0"), 2);
    CHECK(found_by(*stage, std::vector<box>{cube(0), cube(1.75F)}).empty());
    const std::vector<stage_plan> plans = stage->plans();
    REQUIRE(!plans.empty());
    CHECK(plans.back().kind == plan_kind::neighbour_list);
    CHECK(plans.back().decision["pairs"] == 1);
    CHECK(plans.back().decision["margin"] == 0.5);
    CHECK(plans.back().decision["cells"] == 0);
    CHECK(to_text(plans.back().decision) == "a Verlet list of 1 pairs of boxes, with a skin of 0.5");
}

TEST_CASE("a neighbour list serves boxes that move together, however far, and is exact despite rounding") {
    std::size_t served = 0;
    REQUIRE(rc::check([&] {
        const std::string margin = *rc::gen::element("auto", "0", "0.01", "0.3");
        const auto n = *rc::gen::inRange<std::size_t>(1, 60);
        const std::string list = "neighbour_list:margin=" + margin;
        const auto counted = search_of(
            composed({{strategy_kind::prepare, list.c_str()}, {strategy_kind::partition, "columns:few=0"}}), n);
        const auto exact = search_of({}, n);
        // Some coordinates lose bits of what is added to them, others lose none.
        const float origin = *rc::gen::element(0.0F, 1e3F, 1e6F);
        const float drift = *rc::gen::element(0.0F, 0.37F, 1e3F);
        const int speed = *rc::gen::element(0, 1, 40);
        std::vector<box> boxes(n);
        std::vector<vec3f> steps(n);
        for (std::size_t id = 0; id < n; ++id)
            for (int k = 0; k < 3; ++k) {
                boxes[id].min[k] = origin + static_cast<float>(*rc::gen::inRange(0, 300)) / 100;
                boxes[id].max[k] = boxes[id].min[k] + static_cast<float>(*rc::gen::inRange(0, 100)) / 100;
                // Full steps or none, so that some boxes approach each other at the greatest speed.
                steps[id][k] = drift + static_cast<float>(speed * *rc::gen::element(-1, 0, 1)) / 1000;
            }
        for (int frame = 0; frame < 12; ++frame) {
            for (std::size_t id = 0; id < n; ++id)
                for (int k = 0; k < 3; ++k) {
                    boxes[id].min[k] += steps[id][k];
                    boxes[id].max[k] = std::max(boxes[id].min[k], boxes[id].max[k] + steps[id][k]);
                }
            const std::uint64_t before = counted->counters()[work::moves];
            RC_ASSERT(found_by(*counted, boxes) == found_by(*exact, boxes));
            served += drift > 0 && counted->counters()[work::moves] == before;
        }
    }));
    CHECK(served > 100);
}

TEST_CASE("with an automatic margin a list is kept only where it is worth its cost") {
    const auto plain = search_of({}, 1000);
    const auto listed = list_stage(1000);
    std::vector<box> boxes;
    for (int x = 0; x < 10; ++x)
        for (int y = 0; y < 10; ++y)
            for (int z = 0; z < 10; ++z) {
                const vec3f at{1.5F * static_cast<float>(x), 1.5F * static_cast<float>(y), static_cast<float>(z)};
                boxes.push_back({at, at + vec3f{1, 1, 1}});
            }
    // The number of searches while each box moves by so much per frame along x, some forwards and some back.
    std::uint32_t frame = 0;
    const auto searches = [&](float step) {
        std::uint64_t count = 0;
        for (int i = 0; i < 16; ++i, ++frame) {
            for (std::size_t id = 0; id < boxes.size(); ++id)
                boxes[id] = moved(boxes[id], {id / 100 % 2 == frame / 16 % 2 ? step : -step, 0, 0});
            const std::uint64_t before = listed->counters()[work::moves];
            REQUIRE(found_by(*listed, boxes) == found_by(*plain, boxes));
            count += listed->counters()[work::moves] > before;
        }
        return count;
    };
    // The second frame shows that a list serves, and makes it.
    CHECK(searches(0.001F) == 2);
    CHECK(searches(0.001F) <= 2);
    CHECK(searches(0.4F) >= 13);
    CHECK(searches(0.4F) == 16);
    CHECK(searches(0.0005F) <= 10);
    CHECK(searches(0) <= 2);
    CHECK(searches(0) == 0);
}

TEST_CASE("a stale list misses pairs until its next search, and has no false positives") {
    bool missed_any = false;
    REQUIRE(rc::check([&] {
        const auto every = *rc::gen::inRange<std::uint32_t>(1, 5);
        const std::string margin = *rc::gen::element("auto", "0", "0.2", "1", "4");
        const auto n = *rc::gen::inRange<std::size_t>(1, 40);
        const auto stale = search_of(list_with(margin, std::to_string(every)), n);
        const auto exact = search_of({}, n);
        std::vector<box> boxes(n);
        for (std::uint32_t frame = 0; frame < 9; ++frame) {
            for (box& b : boxes) b = cube(static_cast<float>(*rc::gen::inRange(0, 30)) / 2);
            const std::vector<index_pair> expected = found_by(*exact, boxes);
            const std::vector<index_pair> pairs = found_by(*stale, boxes);
            RC_ASSERT(std::ranges::includes(expected, pairs));
            // With a named margin each search runs when it is due, unless nothing moved.
            if (frame % every == 0 && margin != "auto") RC_ASSERT(pairs == expected);
            if (every == 1) RC_ASSERT(pairs == expected);
            missed_any |= pairs != expected;
        }
    }));
    CHECK(missed_any);
}

TEST_CASE("a neighbour list is exact unless it may be stale") {
    for (const std::string every : {"0", "1", "2"}) {
        const aabb::composition c = list_with("0.1", every);
        INFO(text_of_global(c));
        CHECK(is_exact(c, stage::global_search) == (every != "2"));
    }
}

TEST_CASE("a neighbour list stays usable after its search rejects a frame") {
    aabb::composition c = list_with("0.5", "0");
    c[strategy_kind::partition] = {"uniform_grid", {{"cell_size", "1e-30"}}};
    const auto stage = search_of(c, 2);
    std::vector<box> boxes{cube(0), cube(1e6F)};
    CHECK_THROWS_AS(stage->update(boxes), input_error);
    boxes = {box{{0, 0, 0}, {0, 0, 0}}, box{{0, 0, 0}, {0, 0, 0}}};
    CHECK(found_by(*stage, boxes).size() == 1);
}

TEST_CASE("the margin is a number of at least 0, or auto") {
    for (const std::string text : {"", "-1", "nan", "inf", "2x"})
        CHECK_REFUSED(require_known(strategy_kind::prepare, {"neighbour_list", {{"margin", text}}}),
                      "neighbour_list: margin must be a number of at least 0 or auto, not '" + text + "'");
    CHECK_NOTHROW(require_known(strategy_kind::prepare, {"neighbour_list", {{"margin", "0"}}}));
}

TEST_CASE("boxes that came to rest are not tested again") {
    const auto listed = list_stage(1000);
    std::vector<box> boxes = row(1000, 0.8F);
    // The number of frames with tests if this number of boxes moves along y.
    const auto tested_frames = [&](int frames, std::size_t moving) {
        int tested = 0;
        for (int frame = 0; frame < frames; ++frame) {
            for (std::size_t i = 1; i <= moving; ++i) boxes[i] = moved(boxes[i], {0, 0.004F, 0});
            const std::uint64_t before = listed->counters()[work::box_tests];
            CHECK(found_by(*listed, boxes).size() == 999);
            tested += listed->counters()[work::box_tests] > before;
        }
        return tested;
    };
    CHECK(tested_frames(20, 900) > 10);
    const std::uint64_t searched = listed->counters()[work::moves];
    CHECK(tested_frames(10, 0) <= 4);
    CHECK(tested_frames(10, 0) == 0);
    // No search was needed: the list holds every overlapping pair.
    CHECK(listed->counters()[work::moves] == searched);
}

TEST_CASE("boxes that never move are not tested again after two frames") {
    const auto listed = list_stage(1000);
    const std::vector<box> boxes = row(1000, 0.8F);
    for (int frame = 0; frame <= 2; ++frame) CHECK(found_by(*listed, boxes).size() == 999);
    const work_counters before = listed->counters();
    for (int frame = 0; frame < 5; ++frame) CHECK(found_by(*listed, boxes).size() == 999);
    CHECK(listed->counters()[work::box_tests] == before[work::box_tests]);
    CHECK(listed->counters()[work::moves] == before[work::moves]);
}

TEST_CASE("a neighbour list is exact where displacements overflow") {
    const float far = 0.9F * std::numeric_limits<float>::max();
    // In whole vectors and in remainders.
    for (const std::size_t n : {2U, 16U, 33U})
        for (const std::string margin : {"auto", "1"}) {
            const auto stage = search_of(list_with(margin, "0"), n);
            std::vector<box> boxes(n);
            const auto pairs_of_row = [&](float at, float spacing) {
                for (std::size_t i = 0; i < n; ++i) {
                    const float x = at + spacing * static_cast<float>(i);
                    boxes[i] = {{x, 0, 0}, {x, 1, 1}};
                }
                return found_by(*stage, boxes).size();
            };
            INFO(n << " boxes, margin " << margin);
            CHECK(pairs_of_row(-far, far / 100) == 0);
            CHECK(pairs_of_row(far, 0) == n * (n - 1) / 2);
            CHECK(pairs_of_row(-far, far / 100) == 0);
        }
}

TEST_CASE("an object removed before a rejected frame has left the neighbour list") {
    for (const std::string margin : {"auto", "0.5"}) {
        INFO(margin);
        const auto stage = search_of(list_with(margin, "0"), 3);
        std::vector<box> boxes{cube(0), cube(0.5F), cube(0.75F)};
        CHECK(found_by(*stage, boxes).size() == 3);
        stage->remove(1);
        const box valid = boxes[2];
        boxes[2].max[2] = boxes[2].min[2] - 1;
        CHECK_THROWS_AS(stage->update(boxes), input_error);
        boxes[2] = valid;
        CHECK(found_by(*stage, boxes) == std::vector<index_pair>{{0, 2}});
    }
}

TEST_CASE("a neighbour list ends just beyond its margin") {
    // Two boxes approach, each by a little more than the margin of a half, from a little more than twice that.
    for (const std::size_t others : {0U, 40U}) {
        const auto stage = search_of(list_with("0.5", "0"), 2 + others);
        std::vector<box> boxes{cube(0), cube(2.02F)};
        for (std::size_t i = 0; i < others; ++i) boxes.push_back(cube(100 + 10 * static_cast<float>(i)));
        INFO(others << " others");
        CHECK(found_by(*stage, boxes).empty());
        boxes[0] = cube(0.52F);
        boxes[1] = cube(1.5F);
        CHECK(found_by(*stage, boxes) == std::vector<index_pair>{{0, 1}});
    }
}

TEST_CASE("a list of nearly all pairs is never kept, and does not prevent later lists") {
    // One box in sixteen is large and moves a little; in crowded frames the others lie so close that they all overlap
    // when grown by that.
    constexpr std::size_t n = 4096;
    const auto boxes_at = [](int frame, bool crowded) {
        std::vector<box> boxes(n);
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t row = i / 16 % 16;
            const std::size_t layer = i / 256;
            const float by = 0.01F * static_cast<float>(i % 2 == 0 ? frame : -frame);
            if (i % 16 == 0 || !crowded) {
                const vec3f low{2.5F * static_cast<float>(i % 16) + by, 2.5F * static_cast<float>(row),
                                1.5F * static_cast<float>(layer)};
                boxes[i] = {low, {low[0] + 2, low[1] + 2, low[2] + 2}};
            } else {
                const vec3f low{0.02F * static_cast<float>(i % 16), 0.02F * static_cast<float>(row),
                                0.02F * static_cast<float>(layer)};
                boxes[i] = {low, low + vec3f{1e-4F, 1e-4F, 1e-4F}};
            }
        }
        return boxes;
    };
    for (const bool begins_crowded : {true, false}) {
        const auto stage = list_stage(n);
        const auto exact = search_of({}, n);
        int kept = 0;
        for (int frame = 0; frame < 140; ++frame) {
            // Crowded frames alternate with others, which come last.
            const bool crowded = (frame / 20 % 2 == 0) == begins_crowded && frame < 60;
            const std::vector<box> boxes = boxes_at(frame, crowded);
            REQUIRE(found_by(*stage, boxes) == found_by(*exact, boxes));
            for (const part_bytes& part : stage->bytes()) {
                CAPTURE(frame, part.part);
                CHECK(part.bytes < 1000 * n);
            }
            if (frame >= 120) kept += keeps_list(*stage);
        }
        CHECK(kept == 20);
    }
}

TEST_CASE("lists are kept once boxes are large enough for their motion") {
    constexpr std::size_t n = 1000;
    const auto stage = list_stage(n);
    std::uint32_t random = 1;
    const auto any = [&] {
        random = random * 1664525U + 1013904223U;
        return static_cast<float>(random >> 8U) * 0x1p-24F;
    };
    std::vector<box> boxes(n);
    for (int frame = 0; frame < 40; ++frame) {
        for (box& b : boxes) {
            const vec3f low{20 * any(), 20 * any(), 20 * any()};
            b = {low, low + vec3f{0.004F, 0.004F, 0.004F}};
        }
        (void)found_by(*stage, boxes);
    }
    // Rejected frames change nothing.
    std::vector<box> invalid = boxes;
    for (box& b : invalid) b.max[1] = std::numeric_limits<float>::quiet_NaN();
    for (int frame = 0; frame < 20; ++frame) CHECK_THROWS_AS(stage->update(invalid), input_error);
    for (box& b : boxes) b.max = b.min + vec3f{1, 1, 1};
    int kept = 0;
    for (int frame = 0; frame < 60; ++frame) {
        for (std::size_t i = 0; i < n; ++i) boxes[i] = moved(boxes[i], {i % 2 == 0 ? 0.01F : -0.01F, 0, 0});
        (void)found_by(*stage, boxes);
        if (frame >= 40) kept += keeps_list(*stage);
    }
    CHECK(kept == 20);
}

TEST_CASE("an object inserted among boxes at rest causes tests in two frames only") {
    constexpr std::size_t n = 500;
    const auto stage = list_stage(n - 4);
    const std::vector<box> boxes = row(n, 0.8F);
    std::size_t present = n - 4;
    for (int visit = 0; visit < 4; ++visit) {
        for (int frame = 0; frame < 6; ++frame) CHECK(found_by(*stage, boxes).size() == present - 1);
        stage->insert(static_cast<std::uint32_t>(present++));
        for (int frame = 0; frame < 2; ++frame) CHECK(found_by(*stage, boxes).size() == present - 1);
        const work_counters before = stage->counters();
        CHECK(found_by(*stage, boxes).size() == present - 1);
        CHECK(stage->counters()[work::moves] == before[work::moves]);
        CHECK(stage->counters()[work::box_tests] == before[work::box_tests]);
    }
}

TEST_CASE("a neighbour list is exact while boxes creep, rest, jump, come, go, are rejected and swing") {
    std::size_t kept = 0;
    std::size_t rested = 0;
    REQUIRE(rc::check([&] {
        const auto n = *rc::gen::inRange<std::uint32_t>(40, 140);
        const auto stage = global_of(composed({{strategy_kind::prepare, "neighbour_list"}}), instrumentation::none);
        const auto exact = global_of({}, instrumentation::none);
        // The expected number of frames is too low, too high or not given.
        if (const auto frames = *rc::gen::inRange<std::size_t>(0, 120); frames > 0) stage->expect(frames);
        std::vector<bool> present(n);
        const auto change = [&](std::uint32_t id) {
            for (global_stage* s : {stage.get(), exact.get()}) present[id] ? s->remove(id) : s->insert(id);
            present[id] = !present[id];
        };
        change(0);
        for (std::uint32_t id = 1; id < n; ++id)
            if (*rc::gen::inRange(0, 10) > 0) change(id);
        std::vector<box> boxes(n);
        std::vector<vec3f> steps(n);
        std::vector<vec3f> upper_steps(n);
        const auto place = [&](std::uint32_t id) {
            for (int k = 0; k < 3; ++k) {
                boxes[id].min[k] = static_cast<float>(*rc::gen::inRange(0, 400)) / 100;
                boxes[id].max[k] = boxes[id].min[k] + static_cast<float>(*rc::gen::inRange(0, 100)) / 100;
                steps[id][k] = static_cast<float>(*rc::gen::inRange(-10, 11)) / 1000;
                // Some change their sizes.
                upper_steps[id][k] = id % 4 > 0 ? steps[id][k] : static_cast<float>(*rc::gen::inRange(-10, 11)) / 1000;
            }
        };
        for (std::uint32_t id = 0; id < n; ++id) place(id);
        const float pace = *rc::gen::element(1.0F, 0.1F, 0.02F);
        const auto advance = [&](const std::vector<box>& from, float frames) {
            const float times = pace * frames;
            for (std::uint32_t i = 0; i < n; ++i)
                for (int k = 0; k < 3; ++k) {
                    boxes[i].min[k] = from[i].min[k] + times * steps[i][k];
                    boxes[i].max[k] = std::max(boxes[i].min[k], from[i].max[k] + times * upper_steps[i][k]);
                }
        };
        // Each part has frames of one kind: all boxes move on, rest, one jumps, one comes or goes, one is rejected, or,
        // more often, all swing about their places while one comes, goes or is rejected now and then.
        for (int part = 0; part < 8; ++part) {
            const int what = *rc::gen::inRange(0, 8);
            const auto id = *rc::gen::inRange<std::uint32_t>(1, n);
            const std::vector<box> places = boxes;
            for (int frame = *rc::gen::inRange(1, what == 0 || what >= 5 ? 30 : 6); frame > 0; --frame) {
                if (what == 0) advance(boxes, 1);
                if (what == 2) place(id);
                const int event = what >= 5 ? *rc::gen::inRange(0, 30) : what;
                if (event == 3) change(id);
                if (what >= 5) advance(places, static_cast<float>(*rc::gen::inRange(-10, 11)));
                if (event == 4 && present[id]) {
                    constexpr float infinity = std::numeric_limits<float>::infinity();
                    std::vector<box> rejected = boxes;
                    rejected[id].max[0] =
                        *rc::gen::element(std::numeric_limits<float>::quiet_NaN(), infinity, -infinity, -1.0F);
                    for (global_stage* s : {stage.get(), exact.get()}) {
                        try {
                            s->update(rejected);
                            RC_FAIL("accepted");
                        } catch (const input_error&) {
                        }
                    }
                }
                RC_ASSERT(found_by(*stage, boxes) == found_by(*exact, boxes));
                const std::vector<stage_plan> plans = stage->plans();
                kept +=
                    static_cast<std::size_t>(std::ranges::count(plans, plan_kind::neighbour_list, &stage_plan::kind));
                rested +=
                    static_cast<std::size_t>(std::ranges::count(plans, plan_kind::static_frame, &stage_plan::kind));
            }
        }
    }));
    CHECK(kept > 100);
    CHECK(rested > 100);
}

TEST_CASE("if no list is worth its cost, only a sample of boxes is watched") {
    constexpr std::size_t n = 500;
    const auto stage = list_stage(n);
    std::vector<box> boxes = row(n, 0.5F);
    const auto kept_frames = [&](float step, int frames) {
        int kept = 0;
        for (int frame = 0; frame < frames; ++frame) {
            for (std::size_t i = 0; i < n; ++i) boxes[i] = cube(boxes[i].min[0] + (i % 2 == 0 ? step : -step));
            (void)found_by(*stage, boxes);
            kept += keeps_list(*stage);
        }
        return kept;
    };
    const auto prepare_bytes = [&] { return bytes_of_part(stage->bytes(), "prepare"); };
    CHECK(kept_frames(1e-4F, 4) > 0);
    CHECK(prepare_bytes() > n * sizeof(box));
    CHECK(kept_frames(3, 10) < 10);
    CHECK(kept_frames(3, 40) == 0);
    CHECK(prepare_bytes() < n * sizeof(box));
    CHECK(kept_frames(1e-4F, 20) > 10);
}

TEST_CASE("the fewer the fast boxes, the longer the back-off between samples") {
    const auto frames_between_samples = [](std::uint32_t n) {
        membership objects;
        insert_all(objects, n);
        objects.settle();
        std::vector<box> boxes(n);
        list_estimate traits;
        traits.boxes = n;
        std::uint32_t drawn = 100;
        list_backoff backoff;
        backoff.begin(n);
        const auto next_sample = [&] {
            for (int frames = 1;; ++frames) {
                for (std::uint32_t id = 0; id < n; ++id)
                    boxes[id] = cube(boxes[id].min[0] + (id % 2 == 0 ? 50.0F : -50.0F));
                if (backoff.advance_frame(boxes, objects, traits, drawn)) return frames;
                REQUIRE(backoff.is_active());
            }
        };
        const int first = next_sample();
        return std::pair(first, next_sample());
    };
    CHECK(frames_between_samples(50) == std::pair(28 + 8, 28 + 8));
    CHECK(frames_between_samples(2000) == std::pair(1 + 8, 8));
}

TEST_CASE("the motion of a sample is never larger than that of all boxes") {
    REQUIRE(rc::check([] {
        const auto n = *rc::gen::inRange<std::uint32_t>(1, 40);
        membership objects;
        for (std::uint32_t id = 0; id < n; ++id)
            if (*rc::gen::inRange(0, 4) > 0) objects.insert(id);
        objects.settle();
        const auto frame = [&] {
            std::vector<box> boxes;
            for (std::uint32_t id = 0; id < n; ++id)
                boxes.push_back(cube(static_cast<float>(*rc::gen::inRange(-50, 50)) / 8));
            return boxes;
        };
        const std::vector<box> from = frame();
        motion_sample sample;
        std::uint32_t drawn = *rc::gen::arbitrary<std::uint32_t>();
        sample.keep(from, drawn);
        for (unsigned age = 1; age <= motion_sample::longest; ++age) {
            const std::vector<box> to = frame();
            RC_ASSERT(sample.least_motion(to, objects) <= motion_between(from, to, objects).margin);
        }
    }));
}

TEST_CASE("boxes that swing get a list that lasts, though the first did not") {
    // The displacements serve as phases.
    const moving_cubes cubes(600, 5);
    int kept = 0;
    for (int frame = 0; frame < 80; ++frame) {
        std::vector<box> boxes;
        for (std::size_t i = 0; i < cubes.homes.size(); ++i) {
            vec3f at = cubes.homes[i];
            for (int k = 0; k < 3; ++k)
                at[k] += 0.12F * std::sin(6.283F * (static_cast<float>(frame) / 12 + cubes.displacements[i][k]));
            boxes.push_back({at, at + vec3f{1, 1, 1}});
        }
        (void)found_by(*cubes.stage, boxes);
        if (frame >= 40) kept += keeps_list(*cubes.stage);
    }
    CHECK(kept == 40);
}

TEST_CASE("slow boxes get a shorter list without a search") {
    for (const list_run& p : {run_at_homes(30, swings), run_at_homes(30, drifts(0.001F))}) {
        CHECK(p.searches == 2);  // in the first frame, and for the list
        CHECK(static_cast<double>(p.tests[10]) < 0.9 * static_cast<double>(p.tests[5]));
    }
    // If boxes move further than the shorter list allows, all are searched again.
    const auto swings_then_jumps = [](int frame, std::size_t i) { return frame < 30 ? swings(frame, i) : 0.05F; };
    CHECK(run_at_homes(40, swings_then_jumps).searches > 2);
    // Boxes that need most of the margin keep their list, and so do those that accelerate.
    const auto accelerates = [](int frame, std::size_t) { return 0.00013F * static_cast<float>(frame * frame); };
    for (const list_run& p : {run_at_homes(24, drifts(0.004F)), run_at_homes(24, accelerates)}) {
        CHECK(p.searches == 2);
        CHECK(p.tests[20] == p.tests[5]);
    }
}

TEST_CASE("the fewer pairs a list has, the later it is shortened") {
    const auto shortened_in = [](float world) {
        moving_cubes cubes(100, world);
        const auto margin_in = [&](int frame) { return cubes.run(cubes.at(0.00005F * static_cast<float>(frame))); };
        margin_in(0);
        const double first = margin_in(1);
        for (int age = 1; age < 200; ++age)
            if (margin_in(1 + age) < first) return age;
        return 0;
    };
    CHECK(shortened_in(3) == 8);
    CHECK(shortened_in(8) == 16);
    CHECK(shortened_in(12) == 32);
}

TEST_CASE("a list of overlapping boxes is shortened so that more pairs cannot separate") {
    // A row of cubes that creep. Each overlaps the third one after it by less than two of the first margins, and no
    // cube lies near another that it does not overlap.
    constexpr std::size_t n = 64;
    const auto stage = list_stage(n);
    std::uint64_t tests = 0;
    for (int frame = 0; frame < 40; ++frame) {
        std::vector<box> boxes;
        for (std::size_t i = 0; i < n; ++i) {
            const float shift = (i % 2 == 0 ? 0.00003F : -0.00003F) * static_cast<float>(frame);
            boxes.push_back(cube(0.31F * static_cast<float>(i) + shift));
        }
        tests = tests_of(*stage, boxes);
    }
    CHECK(margin_of(*stage) < 0.05);
    CHECK(tests < n / 8);
}

TEST_CASE("a margin that was shortened too much is not used again") {
    moving_cubes cubes(100, 3);
    std::vector<double> margins;
    for (int frame = 0; frame <= 20; ++frame) {
        // At first the cubes creep.
        const float fraction =
            0.0005F * static_cast<float>(std::min(frame, 9)) + 0.002F * static_cast<float>(std::max(frame - 9, 0));
        margins.push_back(cubes.run(cubes.at(fraction)));
    }
    CHECK(margins[9] < 0.5 * margins[8]);
    CHECK(margins[20] > 1.5 * margins[9]);
}

TEST_CASE("boxes that move together, except for rounding, keep their list") {
    moving_cubes cubes(100, 3);
    std::ranges::fill(cubes.displacements, vec3f{1, 1, 1});
    std::vector<double> margins;
    for (int frame = 0; frame < 200; ++frame) margins.push_back(cubes.run(cubes.at(0.37F * static_cast<float>(frame))));
    // It is shortened, but never to the size of rounding errors.
    CHECK_BETWEEN(0.05 * margins[1], margins.back(), 0.1 * margins[1]);
}

TEST_CASE("drifting boxes get lists with margins for some frames") {
    const list_run drifting = run_at_homes(60, drifts(0.02F));
    CHECK(drifting.searches > 3);
    CHECK(drifting.margin > 0);
    CHECK(drifting.margin < 0.2);
}

TEST_CASE("pairs that cannot separate within the margin are not tested") {
    const list_run swinging = run_at_homes(30, swings);
    CHECK(static_cast<double>(swinging.tests[20]) < 0.3 * static_cast<double>(swinging.pairs[20]));
    // A named margin is kept, and such pairs are detected too; a stale list does not know how far boxes moved.
    for (const char* every : {"0", "50"}) {
        const auto stage = search_of(list_with("0.1", every), 200);
        std::vector<box> boxes = row(200, 0.01F);
        std::uint64_t tests = 0;
        for (int frame = 0; frame < 6; ++frame) {
            boxes[0].max[1] += 0.001F;
            tests = tests_of(*stage, boxes);
        }
        CHECK((tests < overlapping(boxes).size() / 2) == (every[0] == '0'));
    }
}

TEST_CASE("pairs that cannot separate are not determined for a list that is to end soon") {
    // The first list serves three frames, or many.
    const list_run fast = run_at_homes(5, drifts(0.05F));
    CHECK(fast.searches == 2);
    CHECK(fast.tests[4] == fast.tests[2]);
    const list_run slow = run_at_homes(8, drifts(0.005F));
    CHECK(slow.searches == 2);
    CHECK(static_cast<double>(slow.tests[4]) < 0.8 * static_cast<double>(slow.tests[2]));
}

TEST_CASE("pairs that cannot separate are determined once lists outlast their plans") {
    const moving_cubes cubes(100, 3);
    float fraction = 0;
    bool determined = false;
    for (int frame = 0; frame < 80; ++frame) {
        // At first the cubes are too fast for any list to last.
        fraction += frame < 16 ? 0.05F : 0.01F;
        const auto tests = static_cast<double>(tests_of(*cubes.stage, cubes.at(fraction)));
        if (frame >= 30) determined = determined || tests < list_value(*cubes.stage, "pairs");
    }
    CHECK(determined);
}

TEST_CASE("pairs that could not separate are tested once boxes shrink") {
    const auto stage = list_stage(100);
    std::vector<box> boxes = row(100, 0.3F);
    for (int frame = 0; frame < 8; ++frame) {
        boxes[0] = moved(boxes[0], {0, 0.001F, 0});
        CHECK(found_by(*stage, boxes) == overlapping(boxes));
    }
    CHECK(keeps_list(*stage));
    const std::size_t before = overlapping(boxes).size();
    for (box& b : boxes) b.max[0] = b.min[0] + 0.4F;
    CHECK(overlapping(boxes).size() < before);
    CHECK(found_by(*stage, boxes) == overlapping(boxes));
    CHECK(keeps_list(*stage));
}

TEST_CASE("shortening a list takes shrinking boxes into account") {
    moving_cubes cubes(600, 5);
    for (int frame = 0; frame < 40; ++frame) {
        // In the frames in which a list may be shortened, boxes are smaller, by less than its first margin.
        const float edge = frame == 8 || frame == 16 || frame == 32 ? 0.93F : 1;
        cubes.run(cubes.at(swings(frame, 0), edge));
    }
}

TEST_CASE("boxes at rest for one frame get a list that lasts once they move") {
    const auto accelerates = [](int frame, std::size_t) { return 0.001F * static_cast<float>(std::max(frame - 1, 0)); };
    CHECK(run_at_homes(40, accelerates).last_search == 2);
}

TEST_CASE("of lists of similar cost the one with the longest margin is planned") {
    std::array<box, 16> sample;
    for (std::size_t i = 0; i < sample.size(); ++i) sample[i] = ::cube(static_cast<float>(i), 1);
    // By the number of overlapping pairs: the more there are, the more come within reach.
    const auto planned = [&](std::size_t pairs) {
        list_estimate seen{.boxes = 1000, .pairs = pairs, .growth = growth_of_pairs(sample)};
        for (std::size_t age = 1; age <= 4; ++age) seen.law.observe(age, 0.001 * static_cast<double>(age));
        return plan_list(seen);
    };
    REQUIRE(planned(30'000).frames > 1);
    CHECK(planned(0).margin > 1.4 * planned(30'000).margin);
    CHECK(planned(0).frames > planned(30'000).frames);
}

TEST_CASE("infinite boxes are rejected, wherever they lie") {
    const auto stage = list_stage(40);
    std::vector<box> floors;
    for (int i = 0; i < 40; ++i) floors.push_back({{0, 0, static_cast<float>(i)}, {1, 1, static_cast<float>(i)}});
    (void)found_by(*stage, floors);
    for (box& b : floors) b.max[0] = std::numeric_limits<float>::infinity();
    CHECK_THROWS_AS(stage->update(floors), input_error);
}

TEST_CASE("plans that failed are trusted less") {
    // Boxes accelerate for `period` frames, then start elsewhere: they are slow when each list is planned.
    const auto kept = [](float acceleration, int period) {
        moving_cubes cubes(70, 4);
        int frames = 0;
        for (int frame = 0; frame < 400; ++frame) {
            const auto time = static_cast<float>(frame % period);
            const float fraction = acceleration * time * time + static_cast<float>(frame / period % 3);
            cubes.run(cubes.at(fraction));
            frames += keeps_list(*cubes.stage);
        }
        return frames;
    };
    CHECK(kept(0.01F, 7) < 40);
    CHECK(kept(0.02F, 10) < 50);
}

TEST_CASE("lists of few boxes must save more, since planning them takes as long") {
    const std::array<box, 16> sample{cube(0), cube(3), cube(6), cube(9)};
    const auto frames_of = [&](std::size_t n) {
        list_estimate seen{.boxes = n, .pairs = n / 10, .growth = growth_of_pairs(std::span(sample).first(4))};
        seen.law.observe(1, 0.8);
        return plan_list(seen).frames;
    };
    CHECK(frames_of(20) == 1);
    CHECK(frames_of(4000) > 1);
}

TEST_CASE("a list that lasted as planned is rebuilt with its margin, unless it lists far more pairs") {
    const auto boxes_at = [](float spacing, int frame) {
        std::vector<box> boxes;
        for (int id = 0; id < 100; ++id) {
            const int row = id / 5 % 5;
            const int layer = id / 25;
            const float moved = (id % 2 == 0 ? 0.01F : -0.01F) * static_cast<float>(frame);
            const vec3f at{spacing * static_cast<float>(id % 5) + moved, spacing * static_cast<float>(row),
                           spacing * static_cast<float>(layer)};
            boxes.push_back({at, at + vec3f{1, 1, 1}});
        }
        return boxes;
    };
    const auto stage = list_stage(100);
    for (int frame = 0; frame <= 1; ++frame) (void)found_by(*stage, boxes_at(3, frame));
    // No boxes lie near, so that longer margins list no more pairs.
    const double first = margin_of(*stage);
    CHECK(first > 0.5);
    for (int frame = 2; frame <= 15; ++frame) (void)found_by(*stage, boxes_at(3, frame));
    std::size_t lists = 0;
    for (int frame = 16; frame <= 160; ++frame) {
        const std::uint64_t moves = stage->counters()[work::moves];
        (void)found_by(*stage, boxes_at(3, frame % 80));
        lists += stage->counters()[work::moves] > moves ? 1U : 0U;
    }
    INFO(lists << " lists");
    CHECK(margin_of(*stage) > first);
    // All boxes lie within reach of each other, and none overlap.
    for (int frame = 0; frame < 3; ++frame) CHECK(found_by(*stage, boxes_at(1.15F, frame)).empty());
    CHECK(list_value(*stage, "pairs") < 200);
}

TEST_CASE("few boxes get no list, unless its margin is named") {
    for (const std::size_t n : {std::size_t{2} * simd::width, std::size_t{2} * simd::width + 1}) {
        INFO(n << " boxes");
        const auto stage = list_stage(n);
        std::vector<box> boxes(n, cube(0));
        (void)found_by(*stage, boxes);
        const omission few{absence::neighbour_list, "none yet, not worth its cost for so few boxes"};
        CHECK(std::ranges::count(stage->left_out(), few) == (n == 2 * simd::width ? 1 : 0));
        // A named margin is kept.
        const auto named = search_of(composed({{strategy_kind::prepare, "neighbour_list:margin=1"}}), n);
        (void)found_by(*named, boxes);
        CHECK(keeps_list(*named));
    }
}

TEST_CASE("pairs within reach grow with each axis on which boxes are spread") {
    std::vector<box> along;
    std::vector<box> spread;
    for (int i = 0; i < 16; ++i) {
        const auto at = static_cast<float>(i);
        along.push_back({{4 * at, 0.01F * at, 0}, {4 * at + 1, 0.01F * at + 1, 1}});
        spread.push_back({{4 * at, 3 * static_cast<float>(i * 7 % 16), 5 * at},
                          {4 * at + 1, 3 * static_cast<float>(i * 7 % 16) + 1, 5 * at + 1}});
    }
    // Two boxes of edge 1 span 2; grown by 0.5 on every side, 4.
    CHECK(growth_of_pairs(along).factor(0.5) == 2);
    CHECK(growth_of_pairs(spread).factor(0.5) == 8);
}

TEST_CASE("displacement is extrapolated by the power of time that it followed") {
    const auto law_of = [](auto moved) {
        displacement_law law;
        for (std::size_t age = 1; age <= 12; ++age) law.observe(age, moved(static_cast<double>(age)));
        return law;
    };
    const displacement_law drift = law_of([](double age) { return 0.5 * age; });
    CHECK(drift.exponent() == Catch::Approx(1));
    CHECK(drift.displacement_after(40) == Catch::Approx(20));
    CHECK(drift.displacement_after(3) == Catch::Approx(1.5));
    const displacement_law walk = law_of([](double age) { return std::sqrt(age); });
    CHECK(walk.displacement_after(300) == Catch::Approx(std::sqrt(300)));
    // The largest displacement so far counts, not the current one.
    const displacement_law swing = law_of([](double age) { return std::fmod(age, 3); });
    CHECK(swing.exponent() == 0);
    CHECK(swing.displacement_after(1000) == 2);
    const displacement_law fall = law_of([](double age) { return age * age; });
    CHECK(fall.displacement_after(24) == Catch::Approx(24 * 24));
    CHECK(law_of([](double age) { return age * age * age; }).exponent() == 2);
    // One frame does not show the exponent, but an earlier law does.
    displacement_law young;
    young.observe(1, 3);
    CHECK(young.displacement_after(4) == Catch::Approx(12));
    displacement_law known = walk;
    known.begin();
    known.observe(1, 3);
    CHECK(known.displacement_after(4) == Catch::Approx(6));
}

TEST_CASE("a list is built only after the motion of boxes shows that it repays in the frames left") {
    // The first frame that has a list, of boxes that move at that pace; `expected` if none has.
    const auto first_list = [](std::size_t expected, float pace) {
        moving_cubes cubes(1000, 6);
        cubes.stage->expect(expected);
        for (std::size_t frame = 0; frame < expected; ++frame)
            if (cubes.run(cubes.at(pace * static_cast<float>(frame))) > 0) return frame;
        return expected;
    };
    CHECK(first_list(200, 0.001F) == 1);
    CHECK_BETWEEN(1, first_list(60, 0.001F), 4);
    CHECK(first_list(60, 1) == 60);
    CHECK(first_list(6, 0.001F) == 6);
    // Nor if the objects come after some of the frames.
    moving_cubes late(1000, 6);
    late.stage = list_stage(0);
    late.stage->expect(6);
    for (int frame = 0; frame < 2; ++frame) REQUIRE(found_by(*late.stage, {}).empty());
    insert_all(*late.stage, 1000);
    for (int frame = 2; frame < 6; ++frame) CHECK(late.run(late.at(0.001F * static_cast<float>(frame))) == 0);
}

TEST_CASE("no list is planned beyond the frames left, in which new memory must be repaid") {
    std::array<box, 16> sample;
    for (std::size_t i = 0; i < sample.size(); ++i) sample[i] = cube(3 * static_cast<float>(i));
    const auto planned = [&](const list_horizon& horizon) {
        list_estimate seen{.boxes = 1000, .pairs = 100, .growth = growth_of_pairs(sample), .horizon = horizon};
        seen.law.observe(1, 0.001);
        return plan_list(seen);
    };
    const list_plan without_end = planned({});
    REQUIRE(without_end.frames > 20);
    CHECK(planned({.frames_left = 1}).frames == 1);
    for (const std::size_t left : {7, 20}) {
        CHECK(planned({.frames_left = left}).frames == left);
        CHECK(planned({.frames_left = left}).cost > without_end.cost);
        CHECK(planned({.frames_left = left, .in_new_memory = true}).cost > planned({.frames_left = left}).cost);
    }
    CHECK(planned({.frames_left = 5, .in_new_memory = true}).frames == 1);
    CHECK(planned({.in_new_memory = true}).cost == without_end.cost);
}

TEST_CASE("what moved is searched again after lists, also where most boxes rest") {
    for (const float drift : {0.01F, 0.02F, 0.04F, 0.08F}) {
        const moving_cubes cubes(600, 5);
        std::vector<box> before;
        int lists = 0;
        for (int frame = 0; frame < 160; ++frame) {
            // A tenth drifts and then, for some frames, moves too far for any list.
            const float far =
                drift * static_cast<float>(frame) + (frame % 80 < 60 ? 0 : 2 * static_cast<float>(frame % 7));
            const std::vector<box> boxes = cubes.at([&](std::size_t i) { return i % 10 == 0 ? far : 0; });
            const std::vector<std::uint32_t> said = ids_of_moved(before, boxes);
            cubes.stage->moved(said);
            before = boxes;
            CHECK(found_by(*cubes.stage, boxes) == overlapping(boxes));
            lists += keeps_list(*cubes.stage);
        }
        CHECK(lists > 20);
        CHECK(lists < 150);
    }
}
