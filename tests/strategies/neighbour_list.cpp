#include <rapidcheck.h>
#include <catch2/catch_approx.hpp>

#include "searches.hpp"

import aabb.prepare.list_backoff;
import aabb.prepare.relative_motion;

using namespace aabb;

namespace {

aabb::composition listing(const std::string& margin, const std::string& every) {
    return composed({{strategy_kind::prepare, ("neighbour_list:margin=" + margin + ",every=" + every).c_str()}});
}

std::unique_ptr<global_stage> listing_stage(std::size_t objects) {
    return search_of(composed({{strategy_kind::prepare, "neighbour_list"}}), objects);
}

box cube(float at) {
    return {{at, 0, 0}, {at + 1, 1, 1}};
}

/// So many, each so far behind the one before.
std::vector<box> row(std::size_t n, float spacing) {
    std::vector<box> boxes;
    for (std::size_t i = 0; i < n; ++i) boxes.push_back(cube(spacing * static_cast<float>(i)));
    return boxes;
}

/// Anywhere in a cube of that edge around the origin.
/// @param random what comes next
std::vector<vec3f> scattered(std::size_t n, float edge, std::uint64_t& random) {
    const auto any = [&] {
        random = random * 6364136223846793005U + 1442695040888963407U;
        return edge * (static_cast<float>(random >> 40U) * 0x1p-24F - 0.5F);
    };
    std::vector<vec3f> places(n);
    for (vec3f& place : places) place = {any(), any(), any()};
    return places;
}

/// What is told of the list that serves a frame; 0 where none does.
double told_of_list(const global_stage& stage, const char* what) {
    for (const stage_plan& plan : stage.plans())
        if (plan.kind == plan_kind::neighbour_list) return plan.decision[what];
    return 0;
}

double margin_of(const global_stage& stage) {
    return told_of_list(stage, "margin");
}

/// Cubes about homes that are scattered in a cube of that edge, each of which goes a way of its own, up to 1/2 on each
/// axis, and a stage that they are in.
struct travellers {
    travellers(std::size_t n, float world) : stage(listing_stage(n)) {
        std::uint64_t random = 1;
        homes = scattered(n, world, random);
        ways = scattered(n, 1, random);
    }

    /// @param by of a cube: how much of its way it has gone
    template <std::invocable<std::size_t> By>
    [[nodiscard]] std::vector<box> at(By by, float edge = 1) const {
        std::vector<box> boxes;
        for (std::size_t i = 0; i < homes.size(); ++i) {
            vec3f place = homes[i];
            for (int k = 0; k < 3; ++k) place[k] += by(i) * ways[i][k];
            boxes.push_back({place, place + vec3f{edge, edge, edge}});
        }
        return boxes;
    }
    [[nodiscard]] std::vector<box> at(float by, float edge = 1) const {
        return at([=](std::size_t) { return by; }, edge);
    }

    /// A frame whose pairs must be exact; the margin of its list.
    double play(const std::vector<box>& boxes) {
        CHECK(found_by(*stage, boxes) == overlapping(boxes));
        return margin_of(*stage);
    }

    std::unique_ptr<global_stage> stage;
    std::vector<vec3f> homes;
    std::vector<vec3f> ways;
};

/// Tests of boxes that a frame takes, whose pairs must be exact.
std::uint64_t tests_of(global_stage& stage, const std::vector<box>& boxes) {
    const std::uint64_t before = stage.counters()[work::box_tests];
    CHECK(found_by(stage, boxes) == overlapping(boxes));
    return stage.counters()[work::box_tests] - before;
}

/// What a list of neighbours took, frame by frame.
struct played {
    std::vector<std::uint64_t> tests;  // of the pairs that were listed
    std::vector<std::size_t> pairs;    // that overlapped
    int searches = 0;                  // of all boxes
    int last_search = 0;               // the frame
    double margin = 0;                 // of the last list
};

/// Cubes of one about scattered homes.
/// @param displacement of a frame and a box: how far on its own way, which is up to 1/2 on each axis
template <class Displacement>
played played_about_homes(int frames, Displacement displacement) {
    const travellers cubes(600, 5);
    aabb::composition c = composed({{strategy_kind::prepare, "neighbour_list"}});
    c[strategy_kind::sort] = {"std", {}};
    c[strategy_kind::partition] = {"uniform_grid", {{"cell_size", "2"}}};
    c[strategy_kind::sweep] = {"one_axis", {}};
    const auto stage = search_of(c, 600);
    played p;
    for (int frame = 0; frame < frames; ++frame) {
        const std::vector<box> boxes = cubes.at([&](std::size_t i) { return displacement(frame, i); });
        const work_counters before = stage->counters();
        const std::vector<index_pair> found = found_by(*stage, boxes);
        REQUIRE(found == overlapping(boxes));
        p.pairs.push_back(found.size());
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

// How far things get, by frame and cube.
float swings(int frame, std::size_t /*cube*/) {
    return 0.01F * std::sin(0.8F * static_cast<float>(frame));
}
auto drifts(float pace) {
    return [pace](int frame, std::size_t) { return pace * static_cast<float>(frame); };
}

}  // namespace

TEST_CASE("a neighbour list is searched for again when an object leaves its grown box, and not before") {
    // Extents are 1, so boxes are grown by a half.
    std::vector<box> boxes{cube(0), cube(1.75F), cube(10), cube(20)};
    aabb::composition c = listing("0.5", "0");
    c[strategy_kind::partition] = {"uniform_grid", {}};
    const auto stage = search_of(c, boxes.size());
    // Each search makes cells anew.
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

TEST_CASE("what a list planned is told in numbers, and in a sentence that has them") {
    const auto stage = search_of(listing("0.5", "0"), 2);
    CHECK(found_by(*stage, std::vector<box>{cube(0), cube(1.75F)}).empty());
    const std::vector<stage_plan> plans = stage->plans();
    REQUIRE(!plans.empty());
    CHECK(plans.back().kind == plan_kind::neighbour_list);
    CHECK(plans.back().decision["pairs"] == 1);
    CHECK(plans.back().decision["margin"] == 0.5);
    CHECK(plans.back().decision["cells"] == 0);
    CHECK(to_text(plans.back().decision) == "a Verlet list of 1 pairs of boxes, with a skin of 0.5");
}

TEST_CASE("a neighbour list serves boxes that move alike, however far, and is exact whatever rounding does") {
    std::size_t served = 0;
    REQUIRE(rc::check([&] {
        const std::string margin = *rc::gen::element("auto", "0", "0.01", "0.3");
        const auto n = *rc::gen::inRange<std::size_t>(1, 60);
        const std::string list = "neighbour_list:margin=" + margin;
        const auto counted = search_of(
            composed({{strategy_kind::prepare, list.c_str()}, {strategy_kind::partition, "columns:few=0"}}), n);
        const auto exact = search_of({}, n);
        // Coordinates that lose some bits of what is added to them, and some that lose none.
        const float origin = *rc::gen::element(0.0F, 1e3F, 1e6F);
        const float drift = *rc::gen::element(0.0F, 0.37F, 1e3F);
        const int unrest = *rc::gen::element(0, 1, 40);
        std::vector<box> boxes(n);
        std::vector<vec3f> ways(n);
        for (std::size_t id = 0; id < n; ++id)
            for (int k = 0; k < 3; ++k) {
                boxes[id].min[k] = origin + static_cast<float>(*rc::gen::inRange(0, 300)) / 100;
                boxes[id].max[k] = boxes[id].min[k] + static_cast<float>(*rc::gen::inRange(0, 100)) / 100;
                // All the way or none, so that some come upon each other as fast as any may.
                ways[id][k] = drift + static_cast<float>(unrest * *rc::gen::element(-1, 0, 1)) / 1000;
            }
        for (int frame = 0; frame < 12; ++frame) {
            for (std::size_t id = 0; id < n; ++id)
                for (int k = 0; k < 3; ++k) {
                    boxes[id].min[k] += ways[id][k];
                    boxes[id].max[k] = std::max(boxes[id].min[k], boxes[id].max[k] + ways[id][k]);
                }
            const std::uint64_t before = counted->counters()[work::moves];
            RC_ASSERT(found_by(*counted, boxes) == found_by(*exact, boxes));
            served += drift > 0 && counted->counters()[work::moves] == before;
        }
    }));
    CHECK(served > 100);
}

TEST_CASE("without a margin of its own a list is kept where it pays, and nothing where it does not") {
    const auto plain = search_of({}, 1000);
    const auto listed = listing_stage(1000);
    std::vector<box> boxes;
    for (int x = 0; x < 10; ++x)
        for (int y = 0; y < 10; ++y)
            for (int z = 0; z < 10; ++z) {
                const vec3f at{1.5F * static_cast<float>(x), 1.5F * static_cast<float>(y), static_cast<float>(z)};
                boxes.push_back({at, at + vec3f{1, 1, 1}});
            }
    // How often boxes are brought to their places while each moves by so much along x, some there and some back.
    std::uint32_t frame = 0;
    const auto searches = [&](float way) {
        std::uint64_t found = 0;
        for (int i = 0; i < 16; ++i, ++frame) {
            for (std::size_t id = 0; id < boxes.size(); ++id)
                boxes[id] = moved(boxes[id], {id / 100 % 2 == frame / 16 % 2 ? way : -way, 0, 0});
            const std::uint64_t before = listed->counters()[work::moves];
            REQUIRE(found_by(*listed, boxes) == found_by(*plain, boxes));
            found += listed->counters()[work::moves] > before;
        }
        return found;
    };
    // The first frame has a list already.
    CHECK(searches(0.001F) == 1);
    CHECK(searches(0.001F) <= 2);
    CHECK(searches(0.4F) >= 13);
    CHECK(searches(0.4F) == 16);
    CHECK(searches(0.0005F) <= 10);
    CHECK(searches(0) <= 2);
    CHECK(searches(0) == 0);
}

TEST_CASE("a stale list misses pairs until its search comes round, and invents none") {
    bool missed_any = false;
    REQUIRE(rc::check([&] {
        const auto every = *rc::gen::inRange<std::uint32_t>(1, 5);
        const std::string margin = *rc::gen::element("auto", "0", "0.2", "1", "4");
        const auto n = *rc::gen::inRange<std::size_t>(1, 40);
        const auto stale = search_of(listing(margin, std::to_string(every)), n);
        const auto exact = search_of({}, n);
        std::vector<box> boxes(n);
        for (std::uint32_t frame = 0; frame < 9; ++frame) {
            for (box& b : boxes) b = cube(static_cast<float>(*rc::gen::inRange(0, 30)) / 2);
            const std::vector<index_pair> all = found_by(*exact, boxes);
            const std::vector<index_pair> found = found_by(*stale, boxes);
            RC_ASSERT(std::ranges::includes(all, found));
            // With a margin of its own each search comes when it is due, unless nothing moved.
            if (frame % every == 0 && margin != "auto") RC_ASSERT(found == all);
            if (every == 1) RC_ASSERT(found == all);
            missed_any |= found != all;
        }
    }));
    CHECK(missed_any);
}

TEST_CASE("a neighbour list is exact unless it is kept whatever moves") {
    for (const std::string every : {"0", "1", "2"}) {
        const aabb::composition c = listing("0.1", every);
        INFO(text_of_global(c));
        CHECK(is_exact(c, stage::global_search) == (every != "2"));
    }
}

TEST_CASE("a neighbour list goes on after a frame that its search refuses") {
    aabb::composition c = listing("0.5", "0");
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
    const auto listed = listing_stage(1000);
    std::vector<box> boxes = row(1000, 0.8F);
    // Frames, and how many of them took tests, with so many of the boxes moving on along y.
    const auto work_in = [&](int frames, std::size_t moving) {
        int tested = 0;
        for (int frame = 0; frame < frames; ++frame) {
            for (std::size_t i = 1; i <= moving; ++i) boxes[i] = moved(boxes[i], {0, 0.004F, 0});
            const std::uint64_t before = listed->counters()[work::box_tests];
            CHECK(found_by(*listed, boxes).size() == 999);
            tested += listed->counters()[work::box_tests] > before;
        }
        return tested;
    };
    CHECK(work_in(20, 900) > 10);
    const std::uint64_t searched = listed->counters()[work::moves];
    CHECK(work_in(10, 0) <= 4);
    CHECK(work_in(10, 0) == 0);
    // Those of a list that meet are all that meet.
    CHECK(listed->counters()[work::moves] == searched);
}

TEST_CASE("boxes that never move are not tested again after two frames") {
    const auto listed = listing_stage(1000);
    const std::vector<box> boxes = row(1000, 0.8F);
    for (int frame = 0; frame <= 2; ++frame) CHECK(found_by(*listed, boxes).size() == 999);
    const work_counters before = listed->counters();
    for (int frame = 0; frame < 5; ++frame) CHECK(found_by(*listed, boxes).size() == 999);
    CHECK(listed->counters()[work::box_tests] == before[work::box_tests]);
    CHECK(listed->counters()[work::moves] == before[work::moves]);
}

TEST_CASE("a neighbour list is exact where boxes move by more than floats hold") {
    const float far = 0.9F * std::numeric_limits<float>::max();
    // In whole vectors and in what is left over.
    for (const std::size_t n : {2U, 16U, 33U})
        for (const std::string margin : {"auto", "1"}) {
            const auto stage = search_of(listing(margin, "0"), n);
            std::vector<box> boxes(n);
            const auto spread = [&](float at, float apart) {
                for (std::size_t i = 0; i < n; ++i) {
                    const float x = at + apart * static_cast<float>(i);
                    boxes[i] = {{x, 0, 0}, {x, 1, 1}};
                }
                return found_by(*stage, boxes).size();
            };
            INFO(n << " boxes, margin " << margin);
            CHECK(spread(-far, far / 100) == 0);
            CHECK(spread(far, 0) == n * (n - 1) / 2);
            CHECK(spread(-far, far / 100) == 0);
        }
}

TEST_CASE("an object that leaves in a frame that is refused has left the neighbour list") {
    for (const std::string margin : {"auto", "0.5"}) {
        INFO(margin);
        const auto stage = search_of(listing(margin, "0"), 3);
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
    // Two come upon each other, each by a little more than the margin of a half, from a little more than twice that.
    for (const std::size_t others : {0U, 40U}) {
        const auto stage = search_of(listing("0.5", "0"), 2 + others);
        std::vector<box> boxes{cube(0), cube(2.02F)};
        for (std::size_t i = 0; i < others; ++i) boxes.push_back(cube(100 + 10 * static_cast<float>(i)));
        INFO(others << " others");
        CHECK(found_by(*stage, boxes).empty());
        boxes[0] = cube(0.52F);
        boxes[1] = cube(1.5F);
        CHECK(found_by(*stage, boxes) == std::vector<index_pair>{{0, 1}});
    }
}

TEST_CASE("a list that would hold each box with every other is never kept, nor is it in the way of others later") {
    // One in sixteen is large and moves a little; where boxes are crowded, the others lie so close that they all meet
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
        const auto stage = listing_stage(n);
        const auto exact = search_of({}, n);
        int kept = 0;
        for (int frame = 0; frame < 140; ++frame) {
            // Crowded, not, crowded, not.
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

TEST_CASE("lists are kept once boxes are long enough for how they move") {
    constexpr std::size_t n = 1000;
    const auto stage = listing_stage(n);
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
    // A look at boxes that are no numbers takes nothing away.
    std::vector<box> none = boxes;
    for (box& b : none) b.max[1] = std::numeric_limits<float>::quiet_NaN();
    for (int frame = 0; frame < 20; ++frame) CHECK_THROWS_AS(stage->update(none), input_error);
    for (box& b : boxes) b.max = b.min + vec3f{1, 1, 1};
    int kept = 0;
    for (int frame = 0; frame < 60; ++frame) {
        for (std::size_t i = 0; i < n; ++i) boxes[i] = moved(boxes[i], {i % 2 == 0 ? 0.01F : -0.01F, 0, 0});
        (void)found_by(*stage, boxes);
        if (frame >= 40) kept += keeps_list(*stage);
    }
    CHECK(kept == 20);
}

TEST_CASE("whoever comes to boxes at rest does not unsettle them for long") {
    constexpr std::size_t n = 500;
    const auto stage = listing_stage(n - 4);
    const std::vector<box> boxes = row(n, 0.8F);
    std::size_t there = n - 4;
    for (int visit = 0; visit < 4; ++visit) {
        for (int frame = 0; frame < 6; ++frame) CHECK(found_by(*stage, boxes).size() == there - 1);
        stage->insert(static_cast<std::uint32_t>(there++));
        for (int frame = 0; frame < 2; ++frame) CHECK(found_by(*stage, boxes).size() == there - 1);
        const work_counters before = stage->counters();
        CHECK(found_by(*stage, boxes).size() == there - 1);
        CHECK(stage->counters()[work::moves] == before[work::moves]);
        CHECK(stage->counters()[work::box_tests] == before[work::box_tests]);
    }
}

TEST_CASE("a neighbour list is exact while boxes creep, rest, jump, come, go, are refused and swing") {
    std::size_t kept = 0;
    std::size_t rested = 0;
    REQUIRE(rc::check([&] {
        const auto n = *rc::gen::inRange<std::uint32_t>(40, 140);
        const auto stage = global_of(composed({{strategy_kind::prepare, "neighbour_list"}}), instrumentation::none);
        const auto exact = global_of({}, instrumentation::none);
        // Told too few or too many, or nothing.
        if (const auto frames = *rc::gen::inRange<std::size_t>(0, 120); frames > 0) stage->expect(frames);
        std::vector<bool> present(n);
        const auto change = [&](std::uint32_t id) {
            for (global_stage* one : {stage.get(), exact.get()}) present[id] ? one->remove(id) : one->insert(id);
            present[id] = !present[id];
        };
        change(0);
        for (std::uint32_t id = 1; id < n; ++id)
            if (*rc::gen::inRange(0, 10) > 0) change(id);
        std::vector<box> boxes(n);
        std::vector<vec3f> ways(n);
        std::vector<vec3f> upper_ways(n);
        const auto place = [&](std::uint32_t id) {
            for (int k = 0; k < 3; ++k) {
                boxes[id].min[k] = static_cast<float>(*rc::gen::inRange(0, 400)) / 100;
                boxes[id].max[k] = boxes[id].min[k] + static_cast<float>(*rc::gen::inRange(0, 100)) / 100;
                ways[id][k] = static_cast<float>(*rc::gen::inRange(-10, 11)) / 1000;
                // Some change their sizes.
                upper_ways[id][k] = id % 4 > 0 ? ways[id][k] : static_cast<float>(*rc::gen::inRange(-10, 11)) / 1000;
            }
        };
        for (std::uint32_t id = 0; id < n; ++id) place(id);
        const float pace = *rc::gen::element(1.0F, 0.1F, 0.02F);
        const auto advance = [&](const std::vector<box>& from, float frames) {
            const float times = pace * frames;
            for (std::uint32_t i = 0; i < n; ++i)
                for (int k = 0; k < 3; ++k) {
                    boxes[i].min[k] = from[i].min[k] + times * ways[i][k];
                    boxes[i].max[k] = std::max(boxes[i].min[k], from[i].max[k] + times * upper_ways[i][k]);
                }
        };
        // So many frames of each: moving on, still, one elsewhere, one come or gone, one refused, and more often all
        // about their places, while one comes, goes or is refused now and then.
        for (int part = 0; part < 8; ++part) {
            const int what = *rc::gen::inRange(0, 8);
            const auto id = *rc::gen::inRange<std::uint32_t>(1, n);
            const std::vector<box> places = boxes;
            for (int frame = *rc::gen::inRange(1, what == 0 || what >= 5 ? 30 : 6); frame > 0; --frame) {
                if (what == 0) advance(boxes, 1);
                if (what == 2) place(id);
                const int besides = what >= 5 ? *rc::gen::inRange(0, 30) : what;
                if (besides == 3) change(id);
                if (what >= 5) advance(places, static_cast<float>(*rc::gen::inRange(-10, 11)));
                if (besides == 4 && present[id]) {
                    constexpr float no_end = std::numeric_limits<float>::infinity();
                    std::vector<box> rejected = boxes;
                    rejected[id].max[0] =
                        *rc::gen::element(std::numeric_limits<float>::quiet_NaN(), no_end, -no_end, -1.0F);
                    for (global_stage* one : {stage.get(), exact.get()}) {
                        try {
                            one->update(rejected);
                            RC_FAIL("taken");
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

TEST_CASE("where no list pays, a few boxes are looked at and nothing is kept") {
    constexpr std::size_t n = 500;
    const auto stage = listing_stage(n);
    std::vector<box> boxes = row(n, 0.5F);
    const auto kept_frames = [&](float way, int frames) {
        int kept = 0;
        for (int frame = 0; frame < frames; ++frame) {
            for (std::size_t i = 0; i < n; ++i) boxes[i] = cube(boxes[i].min[0] + (i % 2 == 0 ? way : -way));
            (void)found_by(*stage, boxes);
            kept += keeps_list(*stage);
        }
        return kept;
    };
    const auto held = [&] {
        const std::vector<part_bytes> parts = stage->bytes();
        return std::ranges::find(parts, std::string("prepare"), &part_bytes::part)->bytes;
    };
    CHECK(kept_frames(3, 10) > 0);
    CHECK(held() > n * sizeof(box));
    CHECK(kept_frames(3, 40) == 0);
    CHECK(held() < n * sizeof(box));
    CHECK(kept_frames(1e-4F, 20) > 10);
}

TEST_CASE("the fewer boxes fly, the longer nobody looks whether they still do") {
    const auto frames_from_look_to_look = [](std::uint32_t n) {
        membership objects;
        insert_all(objects, n);
        objects.settle();
        std::vector<box> boxes(n);
        list_estimate traits;
        traits.boxes = n;
        std::uint32_t drawn = 100;
        list_backoff pause;
        pause.begin(n);
        const auto look_in_vain = [&] {
            for (int frames = 1;; ++frames) {
                for (std::uint32_t id = 0; id < n; ++id)
                    boxes[id] = cube(boxes[id].min[0] + (id % 2 == 0 ? 50.0F : -50.0F));
                if (pause.advance_frame(boxes, objects, traits, drawn)) return frames;
                REQUIRE(pause.is_active());
            }
        };
        const int first = look_in_vain();
        return std::pair(first, look_in_vain());
    };
    CHECK(frames_from_look_to_look(50) == std::pair(28 + 8, 28 + 8));
    CHECK(frames_from_look_to_look(2000) == std::pair(1 + 8, 8));
}

TEST_CASE("a few boxes never say that all moved further than they did") {
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
        motion_sample some;
        std::uint32_t drawn = *rc::gen::arbitrary<std::uint32_t>();
        some.keep(from, drawn);
        for (unsigned age = 1; age <= motion_sample::longest; ++age) {
            const std::vector<box> to = frame();
            RC_ASSERT(some.least_motion(to, objects) <= motion_between(from, to, objects).margin);
        }
    }));
}

TEST_CASE("what swings about its place gets a list that lasts, though the first did not") {
    // Their ways are the phases.
    const travellers cubes(600, 5);
    int kept = 0;
    for (int frame = 0; frame < 80; ++frame) {
        std::vector<box> boxes;
        for (std::size_t i = 0; i < cubes.homes.size(); ++i) {
            vec3f at = cubes.homes[i];
            for (int k = 0; k < 3; ++k)
                at[k] += 0.12F * std::sin(6.283F * (static_cast<float>(frame) / 12 + cubes.ways[i][k]));
            boxes.push_back({at, at + vec3f{1, 1, 1}});
        }
        (void)found_by(*cubes.stage, boxes);
        if (frame >= 40) kept += keeps_list(*cubes.stage);
    }
    CHECK(kept == 40);
}

TEST_CASE("what moves by little gets a shorter list without a search") {
    for (const played& p : {played_about_homes(30, swings), played_about_homes(30, drifts(0.001F))}) {
        CHECK(p.searches == 1);
        CHECK(static_cast<double>(p.tests[10]) < 0.9 * static_cast<double>(p.tests[5]));
    }
    // Where they turn out to go further than the shorter list allows, all is searched again.
    const auto swings_and_goes = [](int frame, std::size_t i) { return frame < 30 ? swings(frame, i) : 0.05F; };
    CHECK(played_about_homes(40, swings_and_goes).searches > 1);
    // What needs most of the margin keeps its list, and so does what speeds up.
    const auto falls = [](int frame, std::size_t) { return 0.0001F * static_cast<float>(frame * frame); };
    for (const played& p : {played_about_homes(24, drifts(0.004F)), played_about_homes(24, falls)}) {
        CHECK(p.searches == 1);
        CHECK(p.tests[20] == p.tests[5]);
    }
}

TEST_CASE("a list of few pairs is shortened only once it has served so long that this pays") {
    const auto shortened_in = [](float world) {
        travellers cubes(100, world);
        const double first = cubes.play(cubes.at(0));
        for (int frame = 1; frame < 200; ++frame)
            if (cubes.play(cubes.at(0.00005F * static_cast<float>(frame))) < first) return frame;
        return 0;
    };
    CHECK(shortened_in(3) == 8);
    CHECK(shortened_in(8) == 16);
    CHECK(shortened_in(12) == 32);
}

TEST_CASE("a list of boxes that overlap is shortened for what cannot part then") {
    // A row of cubes that creep, of which each overlaps the third one after it by less than two of the first margins,
    // and none lies near another that it does not overlap.
    constexpr std::size_t n = 64;
    const auto stage = listing_stage(n);
    std::uint64_t tests = 0;
    for (int frame = 0; frame < 40; ++frame) {
        std::vector<box> boxes;
        for (std::size_t i = 0; i < n; ++i) {
            const float way = (i % 2 == 0 ? 0.00003F : -0.00003F) * static_cast<float>(frame);
            boxes.push_back(cube(0.31F * static_cast<float>(i) + way));
        }
        tests = tests_of(*stage, boxes);
    }
    CHECK(margin_of(*stage) < 0.05);
    CHECK(tests < n / 8);
}

TEST_CASE("a list that was shortened too much is not repeated") {
    travellers cubes(100, 3);
    std::vector<double> margins;
    for (int frame = 0; frame <= 20; ++frame) {
        // At first they creep.
        const float way =
            0.0005F * static_cast<float>(std::min(frame, 8)) + 0.002F * static_cast<float>(std::max(frame - 8, 0));
        margins.push_back(cubes.play(cubes.at(way)));
    }
    CHECK(margins[8] < 0.5 * margins[7]);
    CHECK(margins[20] > 1.5 * margins[8]);
}

TEST_CASE("what moves as one, but for roundings, keeps its list") {
    travellers cubes(100, 3);
    std::ranges::fill(cubes.ways, vec3f{1, 1, 1});
    std::vector<double> margins;
    for (int frame = 0; frame < 200; ++frame)
        margins.push_back(cubes.play(cubes.at(0.37F * static_cast<float>(frame))));
    // It is shortened, but never to what roundings make of no motion.
    CHECK_BETWEEN(0.05 * margins.front(), margins.back(), 0.1 * margins.front());
}

TEST_CASE("what drifts gets lists with margins for some frames") {
    const played drifting = played_about_homes(60, drifts(0.02F));
    CHECK(drifting.searches > 3);
    CHECK(drifting.margin > 0);
    CHECK(drifting.margin < 0.2);
}

TEST_CASE("pairs that cannot part within the margin are not tested") {
    const played swinging = played_about_homes(30, swings);
    CHECK(static_cast<double>(swinging.tests[20]) < 0.3 * static_cast<double>(swinging.pairs[20]));
    // One that is named is kept to, and tells them too; a stale one does not know how far boxes moved.
    for (const char* every : {"0", "50"}) {
        const auto stage = search_of(listing("0.1", every), 200);
        std::vector<box> boxes = row(200, 0.01F);
        std::uint64_t tests = 0;
        for (int frame = 0; frame < 6; ++frame) {
            boxes[0].max[1] += 0.001F;
            tests = tests_of(*stage, boxes);
        }
        CHECK((tests < overlapping(boxes).size() / 2) == (every[0] == '0'));
    }
}

TEST_CASE("nobody asks which pairs cannot part of a list that is to end soon") {
    // The first list serves three frames, or many.
    const played fast = played_about_homes(4, drifts(0.05F));
    CHECK(fast.searches == 1);
    CHECK(fast.tests[3] == fast.tests[1]);
    const played slow = played_about_homes(8, drifts(0.005F));
    CHECK(slow.searches == 1);
    CHECK(static_cast<double>(slow.tests[3]) < 0.8 * static_cast<double>(slow.tests[1]));
}

TEST_CASE("pairs that cannot part are told once lists last longer than was planned") {
    const travellers cubes(100, 3);
    float way = 0;
    bool told = false;
    for (int frame = 0; frame < 80; ++frame) {
        // At first too fast for any list to last.
        way += frame < 16 ? 0.05F : 0.01F;
        const auto tests = static_cast<double>(tests_of(*cubes.stage, cubes.at(way)));
        if (frame >= 30) told = told || tests < told_of_list(*cubes.stage, "pairs");
    }
    CHECK(told);
}

TEST_CASE("pairs that could not part are tested once boxes shrink") {
    const auto stage = listing_stage(100);
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

TEST_CASE("a list is shortened by what boxes shrink, too") {
    travellers cubes(600, 5);
    for (int frame = 0; frame < 40; ++frame) {
        // In the frames in which a list may be shortened, boxes are smaller, by less than its first margin.
        const float edge = frame == 8 || frame == 16 || frame == 32 ? 0.93F : 1;
        cubes.play(cubes.at(swings(frame, 0), edge));
    }
}

TEST_CASE("boxes that stand still for one frame keep their first list") {
    const auto falls = [](int frame, std::size_t) { return 0.001F * static_cast<float>(std::max(frame - 1, 0)); };
    CHECK(played_about_homes(40, falls).searches == 1);
}

TEST_CASE("of lists that cost about as little the one with the longest margin is made") {
    std::array<box, 16> some;
    for (std::size_t i = 0; i < some.size(); ++i) some[i] = ::cube(static_cast<float>(i), 1);
    // By the number of pairs that overlap: as there are few or many of them, few or many come into reach.
    const auto planned = [&](std::size_t pairs) {
        list_estimate seen{.boxes = 1000, .pairs = pairs, .growth = growth_of_pairs(some)};
        for (std::size_t age = 1; age <= 4; ++age) seen.law.observe(age, 0.001 * static_cast<double>(age));
        return plan_list(seen);
    };
    REQUIRE(planned(30'000).frames > 1);
    CHECK(planned(0).margin > 1.4 * planned(30'000).margin);
    CHECK(planned(0).frames > planned(30'000).frames);
}

TEST_CASE("boxes without an end are refused, however they lie") {
    const auto stage = listing_stage(40);
    std::vector<box> floors;
    for (int i = 0; i < 40; ++i) floors.push_back({{0, 0, static_cast<float>(i)}, {1, 1, static_cast<float>(i)}});
    (void)found_by(*stage, floors);
    for (box& b : floors) b.max[0] = std::numeric_limits<float>::infinity();
    CHECK_THROWS_AS(stage->update(floors), input_error);
}

TEST_CASE("plans that failed are believed less") {
    // Boxes speed up for so many frames, and begin anew elsewhere: as each list is planned, they are slow.
    const auto kept = [](float acceleration, int period) {
        travellers cubes(70, 4);
        int frames = 0;
        for (int frame = 0; frame < 400; ++frame) {
            const auto time = static_cast<float>(frame % period);
            const float way = acceleration * time * time + static_cast<float>(frame / period % 3);
            cubes.play(cubes.at(way));
            frames += keeps_list(*cubes.stage);
        }
        return frames;
    };
    CHECK(kept(0.01F, 7) < 40);
    CHECK(kept(0.02F, 10) < 50);
}

TEST_CASE("lists of few boxes must promise more, since planning takes as long as of many") {
    const std::array<box, 16> some{cube(0), cube(3), cube(6), cube(9)};
    const auto frames_of = [&](std::size_t n) {
        list_estimate seen{.boxes = n, .pairs = n / 10, .growth = growth_of_pairs(std::span(some).first(4))};
        seen.law.observe(1, 0.8);
        return plan_list(seen).frames;
    };
    CHECK(frames_of(20) == 1);
    CHECK(frames_of(4000) > 1);
}

TEST_CASE("a list that lasted as planned is made again with its margin, unless it lists far more") {
    const auto placed = [](float spacing, int frame) {
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
    const auto stage = listing_stage(100);
    (void)found_by(*stage, placed(3, 0));
    const double first = margin_of(*stage);
    CHECK(first == Catch::Approx(0.1));
    // Nothing lies near, so that longer margins list no more.
    for (int frame = 1; frame <= 15; ++frame) (void)found_by(*stage, placed(3, frame));
    const double second = margin_of(*stage);
    CHECK(second > 2 * first);
    std::size_t made = 0;
    for (int frame = 16; frame <= 160; ++frame) {
        const std::uint64_t moves = stage->counters()[work::moves];
        (void)found_by(*stage, placed(3, frame % 80));
        made += stage->counters()[work::moves] > moves ? 1U : 0U;
    }
    INFO(made << " lists");
    CHECK(margin_of(*stage) > first);
    // All within reach of each other, of which none overlap.
    for (int frame = 0; frame < 3; ++frame) CHECK(found_by(*stage, placed(1.15F, frame)).empty());
    CHECK(told_of_list(*stage, "pairs") < 200);
}

TEST_CASE("a few boxes are not watched") {
    for (const std::size_t n : {std::size_t{2} * simd::width, std::size_t{2} * simd::width + 1}) {
        INFO(n << " boxes");
        const auto stage = listing_stage(n);
        std::vector<box> boxes(n, cube(0));
        (void)found_by(*stage, boxes);
        const omission few{absence::neighbour_list, "not worth its cost for so few boxes"};
        CHECK(std::ranges::count(stage->left_out(), few) == (n == 2 * simd::width ? 1 : 0));
        // A margin that is named is kept to.
        const auto named = search_of(composed({{strategy_kind::prepare, "neighbour_list:margin=1"}}), n);
        (void)found_by(*named, boxes);
        CHECK(keeps_list(*named));
    }
}

TEST_CASE("pairs in reach grow on the axes on which boxes lie apart") {
    std::vector<box> along;
    std::vector<box> spread;
    for (int i = 0; i < 16; ++i) {
        const auto at = static_cast<float>(i);
        along.push_back({{4 * at, 0.01F * at, 0}, {4 * at + 1, 0.01F * at + 1, 1}});
        spread.push_back({{4 * at, 3 * static_cast<float>(i * 7 % 16), 5 * at},
                          {4 * at + 1, 3 * static_cast<float>(i * 7 % 16) + 1, 5 * at + 1}});
    }
    // Two boxes of 1 reach 2; grown by 0.5 on every side, 4.
    CHECK(growth_of_pairs(along).factor(0.5) == 2);
    CHECK(growth_of_pairs(spread).factor(0.5) == 8);
}

TEST_CASE("how far boxes get goes on by the power of time with which it did") {
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
    // Where it has been counts, not where it is.
    const displacement_law swing = law_of([](double age) { return std::fmod(age, 3); });
    CHECK(swing.exponent() == 0);
    CHECK(swing.displacement_after(1000) == 2);
    const displacement_law fall = law_of([](double age) { return age * age; });
    CHECK(fall.displacement_after(24) == Catch::Approx(24 * 24));
    CHECK(law_of([](double age) { return age * age * age; }).exponent() == 2);
    // Of one frame nobody knows, but of how it was before.
    displacement_law young;
    young.observe(1, 3);
    CHECK(young.displacement_after(4) == Catch::Approx(12));
    displacement_law known = walk;
    known.begin();
    known.observe(1, 3);
    CHECK(known.displacement_after(4) == Catch::Approx(6));
}

TEST_CASE("of few frames no list is made before boxes have shown that it repays its making") {
    // The first frame that a list serves, of boxes that move at that pace; `frames` where none does.
    const auto first_list = [](std::size_t expected, float pace) {
        travellers cubes(1000, 6);
        cubes.stage->expect(expected);
        for (std::size_t frame = 0; frame < expected; ++frame)
            if (cubes.play(cubes.at(pace * static_cast<float>(frame))) > 0) return frame;
        return expected;
    };
    CHECK(first_list(200, 0.001F) == 0);
    CHECK_BETWEEN(0, first_list(60, 0.001F), 4);
    CHECK(first_list(60, 1) == 60);
    CHECK(first_list(6, 0.001F) == 6);
    // Nor where the objects come after some of the frames.
    travellers late(1000, 6);
    late.stage = listing_stage(0);
    late.stage->expect(6);
    for (int frame = 0; frame < 2; ++frame) REQUIRE(found_by(*late.stage, {}).empty());
    insert_all(*late.stage, 1000);
    for (int frame = 2; frame < 6; ++frame) CHECK(late.play(late.at(0.001F * static_cast<float>(frame))) == 0);
}

TEST_CASE("no list is planned for more frames than are left, and new memory is to be repaid in them") {
    std::array<box, 16> some;
    for (std::size_t i = 0; i < some.size(); ++i) some[i] = cube(3 * static_cast<float>(i));
    const auto planned = [&](const list_horizon& horizon) {
        list_estimate seen{.boxes = 1000, .pairs = 100, .growth = growth_of_pairs(some), .horizon = horizon};
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
