#include <nlohmann/json.hpp>
#include <random>

#include "configs.hpp"

import aabb.registry;
import aabblab.comparison;
import aabblab.statistics;
import aabblab.trials;

using aabblab::outcome;
using aabblab::row;
using aabblab::scene_choice;

namespace {

scene_choice brownian(std::uint64_t seed) {
    return {"brownian", {{"objects", "10"}, {"frames", "3"}}, {}, seed};
}

/// Synthetic results: the sorts that run a scene, with their times per frame.
struct measured {
    std::vector<std::pair<std::string, double>> sorts = {{"insertion", 1}, {"std", 2}, {"shell", 0.5}};
    double machine = 1;   ///< its relative slowness
    double noise = 0.01;  ///< relative, independent for each time
    double drift = 1;     ///< relative slowdown of the machine per repeat
    std::uint64_t seeds = 3, repeats = 9;
    std::string experiment = "test";
    std::uint32_t hour = 1;  ///< seeds the noise
};

std::vector<row> rows_of(const measured& m) {
    std::mt19937 random(m.hour);
    const auto noise = [&] { return 1 + m.noise * (static_cast<double>(random() % 2001) / 1000 - 1); };
    std::vector<row> rows;
    for (std::uint64_t seed = 1; seed <= m.seeds; ++seed)
        for (std::uint64_t repeat = 0; repeat < m.repeats; ++repeat)
            for (const auto& [sort, ms] : m.sorts) {
                row& r = rows.emplace_back();
                r.experiment = m.experiment;
                r.scene = brownian(seed);
                r.objects = 10;
                r.frames = 4;
                r.name[aabb::strategy_kind::sort] = sort;
                r.name[aabb::strategy_kind::sweep] = "one_axis";
                r.repeat = repeat;
                r.process = repeat % 3;
                r.build_ms = 1;
                r.first_ms = 5;
                r.update_ms = 3 * ms * m.machine * noise() * (1 + m.drift * static_cast<double>(repeat));
                r.search_ms = r.detect_ms = 0;
                r.candidates = 7;
                r.digest = "00000000000000a" + std::to_string(seed);
                r.counts[0] = 1000 * seed;
                r.bytes[0] = 4096;
                r.status = "exact";
            }
    return rows;
}

aabblab::run_results run_of(const measured& m) {
    return {"run", rows_of(m), {}};
}

/// The outcomes of the ratios of two runs, in order.
std::vector<outcome> outcomes_of(const measured& a, const measured& b) {
    const aabblab::comparison result = compare(run_of(a), run_of(b), aabblab::compared::ratios);
    REQUIRE(result.scenes.size() == 1);  // seeds are pooled
    std::vector<outcome> outcomes;
    for (const aabblab::compared_time& time : result.scenes[0].ratios) outcomes.push_back(time.verdict);
    return outcomes;
}

std::string write_results(const std::filesystem::path& folder, const std::vector<row>& rows) {
    const aabblab::experiment e = aabblab::parse_experiment(
        "name = \"" + (rows.empty() ? "test" : rows.front().experiment) +
            "\"\nseed = [1, 2, 3]\n[[scene]]\nkind = \"brownian\"\nobjects = 10\nframes = 3\n[compose]\nsort = "
            "\"std\"\n",
        "test.toml", aabblab::experiment_size::full);
    aabblab::results_folder results(folder, record_of(e), aabblab::existing_results::reject);
    for (const row& r : rows) results.add(r);
    return folder.string();
}

void change_processor(const std::filesystem::path& folder, const nlohmann::ordered_json& cpu) {
    auto manifest = nlohmann::ordered_json::parse(bytes_of_file(folder / "manifest.json"));
    manifest["build"]["cpu"] = cpu;
    std::ofstream(folder / "manifest.json") << manifest.dump();
}

}  // namespace

TEST_CASE("Unchanged ratios compare as the same despite noise") {
    REQUIRE(outcomes_of({}, {.hour = 2}) == std::vector{outcome::same, outcome::same});
}

TEST_CASE("A slower ratio is found although the whole machine is twice as slow") {
    const measured b{.sorts = {{"insertion", 1}, {"std", 2.4}, {"shell", 0.5}}, .machine = 2, .hour = 2};
    REQUIRE(outcomes_of({}, b) == std::vector{outcome::more, outcome::same});
    REQUIRE(outcomes_of(b, {}) == std::vector{outcome::less, outcome::same});
    const auto scene = compare(run_of({}), run_of(b), aabblab::compared::ratios_and_times).scenes.at(0);
    REQUIRE(scene.scene == without_seed(brownian(1)));
    REQUIRE(scene.baseline == "insertion");
    REQUIRE(scene.ratios[0].label == "std");
    CHECK(std::abs(scene.ratios[0].in_a - 2) < 0.02);
    CHECK(std::abs(scene.ratios[0].in_b - 2.4) < 0.02);
    CHECK(std::abs(scene.ratios[0].change - 1.2) < 0.02);
    CHECK_BETWEEN(1.15, scene.ratios[0].change_range.low, 1.2);
    CHECK_BETWEEN(1.2, scene.ratios[0].change_range.high, 1.25);
    REQUIRE(scene.times.size() == 3);
    for (const aabblab::compared_time& time : scene.times) CHECK(time.change > 1.9);
}

TEST_CASE("Few noisy repeats are undecided, and too few are reported as such") {
    const measured slower{.sorts = {{"insertion", 1}, {"std", 2.2}}, .noise = 0.2, .seeds = 1, .repeats = 6, .hour = 2};
    measured a = slower;
    a.sorts[1].second = 2;
    a.hour = 1;
    REQUIRE(outcomes_of(a, slower) == std::vector{outcome::undecided});
    // A single repeat shows no noise, so any change would seem to exceed it.
    const measured once{.noise = 0, .seeds = 1, .repeats = 1};
    measured twice_as_slow = once;
    twice_as_slow.sorts[1].second = 4;
    const auto result = compare(run_of(once), run_of(twice_as_slow), aabblab::compared::ratios);
    for (const aabblab::compared_time& time : result.scenes.at(0).ratios) {
        CHECK(time.verdict == outcome::undecided);
        CHECK(time.lacks_repeats);
    }
    const auto enough = compare(run_of(a), run_of(slower), aabblab::compared::ratios);
    CHECK_FALSE(enough.scenes.at(0).ratios.at(0).lacks_repeats);
}

TEST_CASE("One change among hundreds of ratios is found") {
    measured a;
    for (int i = 0; i < 300; ++i) a.sorts.emplace_back("sort" + std::to_string(i), 1);
    measured b = a;
    b.hour = 2;
    b.sorts[7].second *= 1.2;
    const std::vector<outcome> outcomes = outcomes_of(a, b);
    REQUIRE(outcomes.size() == 302);
    REQUIRE(outcomes[6] == outcome::more);
    REQUIRE(std::ranges::count(outcomes, outcome::same) == 301);
}

TEST_CASE("Noise alone changes none of hundreds of ratios") {
    measured a{.noise = 0.05};
    for (int i = 0; i < 300; ++i) a.sorts.emplace_back("sort" + std::to_string(i), 1);
    measured b = a;
    b.hour = 2;
    const auto result = compare(run_of(a), run_of(b), aabblab::compared::ratios);
    std::size_t same = 0;
    for (const aabblab::compared_time& time : result.scenes.at(0).ratios) {
        const bool within = time.change_range.low > 1 / 1.05 && time.change_range.high < 1.05;
        CHECK((time.verdict == outcome::same) == within);
        CHECK((time.verdict == outcome::same || time.verdict == outcome::undecided));
        same += within;
    }
    CHECK_BETWEEN(0, same, 302);
}

TEST_CASE("The baseline is the first candidate in both runs, and unmatched results are counted") {
    aabblab::run_results a = run_of({});
    for (row& r : a.rows)
        if (r.name[aabb::strategy_kind::sort] == "insertion") r.name[aabb::strategy_kind::sweep] = "all_axes";
    const measured b{.sorts = {{"shell", 0.5}, {"std", 2}, {"quick", 1}}, .seeds = 2, .hour = 2};
    const auto result = compare(a, run_of(b), aabblab::compared::ratios);
    REQUIRE(result.scenes.at(0).baseline == "std");
    REQUIRE(result.scenes[0].ratios.size() == 1);
    REQUIRE(result.scenes[0].ratios[0].label == "shell");  // those in both runs differ only in the sort
    REQUIRE(result.results_compared == 2);
    REQUIRE(result.only_in_a == 3 + 2);  // all of the third seed, and insertion in two
    REQUIRE(result.only_in_b == 2);
}

TEST_CASE("Counts, bytes and exact results are compared one by one") {
    const aabblab::run_results a = run_of({});
    aabblab::run_results b = run_of({.hour = 2});
    for (row& r : b.rows)
        if (r.name[aabb::strategy_kind::sort] == "std")
            r.counts[0] = *r.counts[0] + 60;
        else if (r.name[aabb::strategy_kind::sort] == "shell" && r.scene.seed != 3)
            r.counts[0] = 3000 - *r.counts[0];
    const auto changed = compare(a, b, aabblab::compared::ratios);
    REQUIRE(changed.different_results.empty());
    REQUIRE(changed.scenes.at(0).changed.size() == 2);
    const aabblab::changed_number& number = changed.scenes[0].changed[0];
    REQUIRE(number.label == "std");
    REQUIRE(number.quantity == "comparisons");
    REQUIRE(number.in_a == 6000);
    REQUIRE(number.in_b == 6180);
    // The sum over the seeds does not show this change.
    REQUIRE(changed.scenes[0].changed[1].label == "shell");
    REQUIRE(changed.scenes[0].changed[1].in_a == changed.scenes[0].changed[1].in_b);
    REQUIRE(changed.numbers_compared == 3 * 3);  // with the pairs

    for (row& r : b.rows)
        if (r.name[aabb::strategy_kind::sort] == "std" && r.scene.seed == 2) {
            r.digest = "0123456789abcdef";
            r.status = "inexact";
        }
    REQUIRE(compare(a, b, aabblab::compared::ratios).different_results.empty());
    for (row& r : b.rows) r.status = "exact";
    const auto different = compare(a, b, aabblab::compared::ratios);
    REQUIRE(different.different_results.size() == 1);
    REQUIRE(different.different_results[0].scene == brownian(2));
    REQUIRE(different.different_results[0].in_a == "00000000000000a2");
}

TEST_CASE("The baseline is the first composition even after an engine") {
    std::vector<row> rows = rows_of({});
    for (row& r : rows) {
        if (r.name[aabb::strategy_kind::sort] != "insertion") continue;
        r.name = {};
        r.name.engine = "cgal";
    }
    const aabblab::comparison result = compare({"a", rows, {}}, {"b", rows, {}}, aabblab::compared::ratios);
    REQUIRE(result.scenes.size() == 1);
    CHECK(result.scenes[0].baseline == "std");
}

TEST_CASE_METHOD(in_folder, "compare lists changes beyond noise, or all ratios, and exits with status 0") {
    const std::string a = write_results(folder / "a", rows_of({}));
    std::vector<row> slower = rows_of({.sorts = {{"insertion", 1}, {"std", 2.4}, {"shell", 0.5}}, .hour = 2});
    for (row& r : slower) r.bytes[0] = 8192;
    const std::string b = write_results(folder / "b", slower);
    const program_result result = run_well({"compare", a, b});
    CHECK(result.err.empty());
    CHECK(result.out.starts_with("A: " + a + " (commit "));
    CHECK(holds(result.out, "test: brownian, objects=10 frames=3; time relative to that of 'insertion'\n"));
    CHECK(holds(result.out, "\nstd "));
    CHECK_FALSE(holds(result.out, " same\n"));
    CHECK(holds(result.out, "\n2 ratios compared: 1 changed beyond noise, 1 unchanged (within 5 %), 0 undecided\n"));
    CHECK(holds(result.out, "bytes_projections  12288  24576  +100.00\n"));
    CHECK(holds(result.out, "\n9 counts and sizes compared: 3 changed\n"));
    const program_result full = run_program({"compare", a, b, "--all"});
    CHECK(holds(full.out, "\nshell "));
    CHECK(holds(full.out, " same\n"));
    CHECK_FALSE(holds(full.out, "\nopen: "));
    const std::string noisy = write_results(folder / "noisy", rows_of({.noise = 0.3, .hour = 3}));
    CHECK(holds(run_program({"compare", a, noisy}).out,
                " 2 undecided\nundecided: the interval of B/A extends beyond a change of 5 %, or the change is "
                "significant only without Holm's correction for all ratios; --all lists them\n"));
    const program_result unchanged = run_well({"compare", a, a});
    CHECK(holds(unchanged.out,
                "\n2 ratios compared: 0 changed beyond noise, 2 unchanged (within 5 %), 0 undecided\n"
                "9 counts and sizes compared: 0 changed\n"));
    CHECK_FALSE(holds(unchanged.out, "not compared"));
}

TEST_CASE_METHOD(in_folder, "compare reports differing results first and exits with status 1") {
    const std::string a = write_results(folder / "a", rows_of({}));
    std::vector<row> wrong = rows_of({.hour = 2});
    for (row& r : wrong)
        if (r.scene.seed == 3) r.digest = "0123456789abcdef";
    const program_result result = run_program({"compare", a, write_results(folder / "b", wrong)});
    INFO(result.out);
    REQUIRE(result.status == 1);
    CHECK(result.err.empty());
    CHECK(holds(result.out, "the results differ in 1 of 3 scenes\n"));
    CHECK(holds(result.out, "seed=3  00000000000000a3  0123456789abcdef\n"));
    CHECK(result.out.find("the results differ") < result.out.find("ratios compared"));
}

TEST_CASE_METHOD(in_folder, "compare --times warns of noise between runs and rejects another machine") {
    const std::string a = write_results(folder / "a", rows_of({.drift = 0}));
    const std::string b = write_results(folder / "b", rows_of({.machine = 2, .drift = 0, .hour = 2}));
    const program_result same_machine = run_well({"compare", a, b, "--times"});
    CHECK(is_one_sentence(same_machine.err));
    CHECK(holds(same_machine.err, "differ by more than the noise within"));
    CHECK(holds(same_machine.out, "\n2 ratios compared: 0 changed beyond noise, 2 unchanged"));
    CHECK(holds(same_machine.out, "\n3 times compared: 3 changed beyond noise, 0 unchanged"));
    change_processor(b, "Abacus 9");
    const program_result other_machine = run_refused({"compare", a, b, "--times"});
    CHECK(other_machine.out.empty());
    CHECK(holds(other_machine.err, "Abacus 9"));
    CHECK(holds(other_machine.err, aabblab::read_manifest(a).cpu));
    const program_result ratios = run_well({"compare", a, b});
    CHECK(holds(ratios.out, "B: " + b + " (commit "));
    CHECK(holds(ratios.out, "Abacus 9)\n"));
}

TEST_CASE_METHOD(in_folder, "compare skips experiments that only one of two folders has") {
    write_results(folder / "a/first", rows_of({.experiment = "first"}));
    write_results(folder / "a/second", rows_of({.experiment = "second"}));
    folder.write("a/c6/process-0.json", "{}");
    const std::string b = write_results(folder / "b", rows_of({.experiment = "second", .hour = 2}));
    const program_result result = run_well({"compare", folder / "a", b, "--all"});
    CHECK(holds(result.out, "\nsecond: brownian, "));
    CHECK_FALSE(holds(result.out, "\nfirst: brownian, "));
    CHECK(holds(result.out, "\n2 ratios compared: "));
    CHECK(
        holds(result.out, "not compared, because the other run lacks them: 9 compositions in a scene of A, 0 of B\n"));
}

TEST_CASE_METHOD(in_folder, "compare rejects folders without valid results in one sentence") {
    const std::string good = write_results(folder / "good", rows_of({}));
    const std::string other = write_results(folder / "other", rows_of({.experiment = "other"}));
    const std::string none = write_results(folder / "none", {});
    const std::string empty = folder / "empty";
    std::filesystem::create_directories(empty);
    const std::string torn = write_results(folder / "torn", rows_of({}));
    std::ofstream(folder / "torn/results.csv", std::ios::app) << "test,brownian\n";
    const std::string bare = write_results(folder / "bare", rows_of({}));
    std::filesystem::remove(folder / "bare/manifest.json");
    const std::string typed = write_results(folder / "typed", rows_of({}));
    change_processor(typed, nlohmann::ordered_json::array());
    const std::string strange = write_results(folder / "strange", rows_of({}));
    std::ofstream(folder / "strange/manifest.json") << R"({"build": {}, "config": {}, "experiment": "test",)"
                                                       "\n"
                                                       R"("scenes": })";
    write_results(folder / "twice/x", rows_of({}));
    write_results(folder / "twice/y", rows_of({}));
    const refusals rejected = {
        {{good}, "B is required"},
        {{good, folder / "nowhere"}, "nowhere does not exist; expected a folder of results"},
        {{folder / "good/results.csv", good}, "results.csv is not a folder"},
        {{good, empty}, "there are no results in " + empty},
        {{none, good}, "there are no results in " + none},
        {{good, other}, "have no scene in common"},
        {{good, torn}, "results.csv:83: the column scene_parameters is missing"},
        {{bare, good}, "manifest.json does not exist"},
        {{good, typed}, "typed/manifest.json: build.cpu must be a string"},
        {{strange, good}, "strange/manifest.json:2: is not a manifest of results: its JSON is malformed"},
        {{folder / "twice", good}, "both hold results of the experiment test"},
        {{good, good, "--tiems"}, "did you mean '--times'?"},
    };
    check_refused({"compare"}, rejected);
}
