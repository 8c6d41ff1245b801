#include <catch2/catch_test_macros.hpp>
#include <cfenv>

#include "altered_stages.hpp"

import aabb.base;
import aabb.extreme;

using namespace aabb;

namespace {

extreme_judge judge_of(const std::string& name) {
    std::vector<extreme_scene> scenes = extreme_scenes(extreme_size::small);
    const auto scene = std::ranges::find(scenes, name, &extreme_scene::name);
    REQUIRE(scene != scenes.end());
    return extreme_judge(*scene);
}

extreme_result judged(const extreme_judge& judge, std::function<void(pair_list&)> change) {
    return judge.judge([change = std::move(change)]() -> std::unique_ptr<global_stage> {
        return std::make_unique<altered_boxes>(change);
    });
}

extreme_result judged(const extreme_judge& judge, const alterations& changes) {
    return judge.judge(
        [&changes]() -> std::unique_ptr<local_stage> { return std::make_unique<altered_meshes>(changes); });
}

void reject() {
    throw input_error("not today");
}

}  // namespace

TEST_CASE("the judge detects missing, extra and repeated pairs, rejections and failures of a global search") {
    const extreme_judge judge = judge_of("two_objects");
    const extreme_result exact = judged(judge, [](pair_list&) {});
    CHECK(exact.outcome == verdict::exact);
    CHECK(exact.bytes == 42);
    CHECK(is_as_expected(judge.scene(), exact));
    const struct {
        std::function<void(pair_list&)> change;
        verdict outcome;
        std::uint64_t false_negatives, false_positives;
        std::string reason;
    } wrong[] = {{[](pair_list& pairs) { pairs.pop_back(); }, verdict::wrong, 3, 0, "frame 0: the pair 0 1 is missing"},
                 {[](pair_list& pairs) { pairs.push_back({0, 7}); }, verdict::wrong, 0, 3,
                  "frame 0: the pair 0 7 is reported, but is not in the ground truth"},
                 {[](pair_list& pairs) { pairs.push_back(pairs[0]); }, verdict::wrong, 0, 3,
                  "frame 0: the pair 0 1 is reported more than once"},
                 {[](pair_list&) { reject(); }, verdict::rejected, 0, 0, "not today"},
                 {[](pair_list&) { throw std::runtime_error("no more"); }, verdict::wrong, 0, 0, "fails: no more"}};
    for (const auto& [change, outcome, false_negatives, false_positives, reason] : wrong) {
        const extreme_result result = judged(judge, change);
        CHECK(result.outcome == outcome);
        CHECK(result.false_negatives == false_negatives);
        CHECK(result.false_positives == false_positives);
        CHECK(result.reason == reason);
        CHECK_FALSE(is_as_expected(judge.scene(), result));
    }
    // A stage that need not be exact may be wrong.
    CHECK(is_as_expected(judge.scene(), judged(judge, wrong[0].change), false));
}

TEST_CASE("the judge detects a pair that is missing in a later frame only") {
    const extreme_judge judge = judge_of("all_leave");
    int searches = 0;
    const extreme_result result = judged(judge, [&](pair_list& pairs) {
        if (++searches == 6) pairs.pop_back();
    });
    CHECK(searches == 6);
    CHECK(result.false_negatives == 1);
    CHECK(result.reason.starts_with("frame 5: the pair "));
}

TEST_CASE("the judge detects a local detection that is wrong in any query") {
    const extreme_judge judge = judge_of("touch_at_faces");
    CHECK(judged(judge, alterations{}).outcome == verdict::exact);
    const extreme_result missing = judged(judge, {.all_pairs = [](pair_list& pairs) { pairs.pop_back(); }});
    CHECK(missing.false_negatives == 2);
    CHECK(missing.false_positives == 0);
    CHECK(missing.reason.starts_with("frame 0: the pair "));
    // Pairs that touch in a face are coplanar or touching, and moving them rounds nothing.
    std::size_t classified = 0;
    for (const std::size_t count : missing.classes.false_negatives) classified += count;
    CHECK(classified == 2);
    const extreme_result twice = judged(judge, {.all_pairs = [](pair_list& pairs) { pairs.push_back(pairs[0]); }});
    CHECK(twice.false_positives == 2);
    for (const extreme_result& result : {missing, twice}) CHECK_FALSE(is_as_expected(judge.scene(), result));
    const std::pair<alterations, std::string> others[] = {
        {{.first_pair = [](auto& first) { first.reset(); }}, "frame 0: first_pair finds none, but there is one"},
        {{.first_pair = [](auto& first) { first = {0, 4711}; }},
         "frame 0: first_pair finds 0 4711, which do not intersect"},
        {{.more_counted = 1}, "frame 0: count_pairs returns "},
        {{.self_pairs = [](pair_list& pairs) { pairs.pop_back(); }}, "self_pairs: the pair "},
        {{.all_pairs = [](pair_list&) { reject(); }}, "not today"}};
    for (const auto& [change, reason] : others) {
        const extreme_result result = judged(judge, change);
        CHECK(result.reason.starts_with(reason));
        CHECK((result.outcome == verdict::rejected) == (reason == "not today"));
        CHECK_FALSE(is_as_expected(judge.scene(), result));
    }
}

TEST_CASE("a result for a scene that must be rejected is wrong, and so is another reason") {
    extreme_scene scene = judge_of("two_objects").scene();
    scene.rejection = "box 7";
    const extreme_judge judge(scene);
    CHECK(judged(judge, [](pair_list&) {}).reason == "returns a result, but must reject the scene");
    const extreme_result other = judged(judge, [](pair_list&) { reject(); });
    CHECK(other.outcome == verdict::rejected);
    CHECK_FALSE(is_as_expected(scene, other));
    CHECK_FALSE(is_as_expected(scene, other, false));
    CHECK(is_as_expected(scene, judged(judge, [](pair_list&) { throw input_error("box 7 is odd"); })));
}

TEST_CASE("a result in other arithmetic is wrong, whichever query returns it") {
    // A stage that does not check the arithmetic in its searches.
    class careless final : public global_stage {
    public:
        void insert(std::uint32_t) override {}
        void remove(std::uint32_t) override {}
        void update(std::span<const box>) override { require_ieee_arithmetic(); }
        void search(pair_list&) override {}
        [[nodiscard]] work_counters counters() const override { return {}; }
        [[nodiscard]] std::vector<part_bytes> bytes() const override { return {}; }
        [[nodiscard]] std::vector<omission> left_out() const override { return {}; }
    };
    // The scenes that this processor supports.
    std::vector<const char*> names = {"upward_boxes"};
    if (can_flush_denormals()) names.push_back("flushed_boxes");
    for (const char* name : names) {
        const extreme_judge judge = judge_of(name);
        const extreme_result result =
            judge.judge([]() -> std::unique_ptr<global_stage> { return std::make_unique<careless>(); });
        CHECK(result.outcome == verdict::wrong);
        CHECK(result.reason == "search returns a result, but must reject the scene");
    }
}

TEST_CASE("in_arithmetic changes the arithmetic of its own thread only") {
    const volatile double least = 5e-324;
    const volatile double unit = 1;
    bool flushed = false;
    bool upward = false;
    if (can_flush_denormals()) in_arithmetic(arithmetic::denormals_flushed, [&] { flushed = least * unit == 0; });
    CHECK(flushed == can_flush_denormals());
    in_arithmetic(arithmetic::rounded_upward, [&] { upward = unit + least != 1; });
    CHECK(upward);
    CHECK(least * unit != 0);
    CHECK(unit + least == 1);
    CHECK_THROWS_AS(in_arithmetic(arithmetic::ieee, reject), input_error);
}

TEST_CASE("exceeding the memory limit of a scene is wrong") {
    extreme_scene scene;
    scene.most_bytes = 100;
    extreme_result result;
    result.bytes = 100;
    require_stated_memory(scene, result);
    CHECK(result.outcome == verdict::exact);
    result.bytes = 101;
    require_stated_memory(scene, result);
    CHECK(result.outcome == verdict::wrong);
    CHECK(result.reason == "holds 101 bytes, more than the limit of 100");
}

TEST_CASE("the ground truth equals the definition") {
    known_boxes boxes({{{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {2, 2, 2}}, {{1.5F, 0, 0}, {3, 3, 3}}},
                       {{{0, 0, 0}, {1, 1, 1}}, {{1, 1, 1}, {2, 2, 2}}, {{1.5F, 0, 0}, {3, 3, 3}}}},
                      {{1, 1, 0}, {0, 1, 1}});
    const exact_boxes exact = exact_boxes_of(boxes);
    REQUIRE(exact.size() == 2);
    CHECK(exact[0].pairs == pair_list{{0, 1}});
    CHECK(exact[1].pairs == pair_list{{1, 2}});
    CHECK(exact[0].arrivals == std::vector<std::uint32_t>{0, 1});
    CHECK(exact[1].arrivals == std::vector<std::uint32_t>{2});
    CHECK(exact[1].departures == std::vector<std::uint32_t>{0});
    // Three triangles of each cube share that corner.
    const auto touching = judge_of("touch_at_vertices").scene();
    const auto meshes = touching.make_meshes();
    const exact_meshes truth = exact_meshes_of(*meshes, extreme_query::all_pairs);
    REQUIRE(truth.frames.size() == 2);
    for (const exact_mesh_frame& frame : truth.frames) {
        REQUIRE(frame.objects.size() == 1);
        CHECK(frame.objects[0].intersect);
    }
    CHECK(truth.frames[0].objects[0].pairs.size() == 9);
}

TEST_CASE("names of scenes are unique, and many scenes have more than a few pairs") {
    std::set<std::string> names;
    std::size_t with_pairs = 0;
    for (const extreme_scene& scene : extreme_scenes(extreme_size::small)) {
        CHECK(names.insert(scene.name).second);
        CHECK(scene.name.size() <= 20);
        CHECK_FALSE(scene.summary.empty());
        CHECK((scene.make_boxes != nullptr) != (scene.make_meshes != nullptr));
        if (!scene.make_boxes) continue;
        const auto boxes = scene.make_boxes();
        for (const exact_box_frame& frame : exact_boxes_of(*boxes))
            if (frame.pairs.size() > 20) ++with_pairs;
    }
    CHECK(with_pairs > 40);
}

TEST_CASE("a case is run in every order of its corners and of the two triangles") {
    const triangle_case separated{.name = "a",
                                  .source = "",
                                  .about = "",
                                  .kind = "",
                                  .first = {{{0, 0, 0}, {1, 0, 0}, {0, 0.1, 0}}},
                                  .second = {{{5, 5, 5}, {6, 5, 5}, {5, 6, 5}}},
                                  .intersect = false,
                                  .intersect_double = false};
    const std::vector<triangle_pair<float>> orders = every_order<float>(separated);
    CHECK(orders.size() == 72);
    CHECK(every_order<double>(separated)[0].a[2][1] == 0.1);
    CHECK(orders[0].a[2][1] == 0.1F);
    for (std::size_t i = 0; i < orders.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) CHECK_FALSE((orders[i].a == orders[j].a && orders[i].b == orders[j].b));
}
