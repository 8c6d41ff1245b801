#include <catch2/matchers/catch_matchers.hpp>

#include "configs.hpp"

#include "../altered_search.hpp"

import aabb.registry;
import aabblab.trials;
import aabblab.tables;

using aabblab::candidate;
using aabblab::existing_results;
using aabblab::experiment;
using aabblab::results_folder;
using aabblab::row;

namespace {

experiment boxes(std::size_t repeats = 2) {
    return aabblab::parse_experiment(
        "name = \"boxes\"\nengines = [\"brute_force\", \"libccd\"]\n[[scene]]\n"
        "kind = \"brownian\"\nobjects = 200\nframes = 3\n[compose]\n"
        "sort = [\"insertion\", \"std\"]\ntree = [\"canonical\", \"leafless\"]\n"
        "[measure]\nrepeats = " +
            std::to_string(repeats) + "\n",
        "boxes.toml", aabblab::experiment_size::full);
}

experiment meshes() {
    return aabblab::parse_experiment(
        "name = \"meshes\"\nengines = [\"cgal\", \"fcl\", \"libccd\"]\n[[scene]]\n"
        "kind = \"mesh_swarm\"\nmeshes = [\"icosphere:triangles=80\"]\nobjects = 20\n"
        "frames = 3\ndensity = 0.5\n[compose]\ntree = [\"canonical\", \"leafless\"]\n"
        "triangle = [\"exact\", \"moller\"]\n[measure]\nrepeats = 1\n",
        "meshes.toml", aabblab::experiment_size::full);
}

enum class fault { loses, repeats };

candidate altered_candidate(const std::string& name, const std::function<void()>& before,
                            const altered_search::change& after) {
    candidate tested;
    tested.name[aabb::strategy_kind::sort] = name;
    tested.make_global = [=](aabb::instrumentation) {
        return std::make_unique<altered_search>(aabb::compose_global_search({}, aabb::instrumentation::none), before,
                                                after);
    };
    return tested;
}

/// Loses a pair of frame 2, or reports it twice.
candidate wrong_candidate(fault what) {
    return altered_candidate(
        "wrong", [] {},
        [what, frame = 0](auto& pairs) mutable {
            if (frame++ != 2) return;
            if (what == fault::loses)
                pairs.pop_back();
            else
                pairs.push_back(pairs.back());
        });
}

/// Runs the only scene with new results in that folder, and requires that nothing fails.
std::vector<row> rows_of_run(const experiment& e, const std::filesystem::path& folder) {
    results_folder results(folder, record_of(e), existing_results::reject);
    REQUIRE(aabblab::run_scene(e, e.scenes[0], aabblab::candidates_for(e, e.scenes[0]), results).empty());
    const std::span<const row> rows = results.rows();
    return {rows.begin(), rows.end()};
}

/// Keys, digests and statuses, which do not depend on the time of measurement.
std::set<std::string> results_of(std::span<const row> rows) {
    std::set<std::string> results;
    for (const row& r : rows) results.insert(r.key() + r.digest + r.status);
    return results;
}

}  // namespace

TEST_CASE_METHOD(in_folder, "A scene of boxes is run by every global search and every engine that searches boxes") {
    const experiment e = boxes();
    REQUIRE(aabblab::candidates_for(e, e.scenes[0]).size() == 3);
    rows_of_run(e, folder / "r");
    const std::vector<row> rows = aabblab::read_rows(folder / "r/results.csv");
    REQUIRE(rows.size() == 6);
    for (const row& r : rows) {
        REQUIRE(r.status == "exact");
        REQUIRE(r.digest == rows[0].digest);
        REQUIRE(r.candidates > 0);
        REQUIRE(r.frames == 4);
        REQUIRE_FALSE(r.contacts);
        REQUIRE(r.update_ms.has_value());
        REQUIRE(r.false_negatives.value_or(1) == 0);
        REQUIRE(r.counts[0].has_value() == r.name.engine.empty());
    }
}

TEST_CASE_METHOD(in_folder, "A scene of meshes is run by both stages together, engines included") {
    const std::vector<row> rows = rows_of_run(meshes(), folder / "r");
    REQUIRE(rows.size() == 4 + 3);
    for (const row& r : rows) {
        INFO(r.key());
        REQUIRE(r.contacts.value_or(0) > 0);
        if (r.name[aabb::strategy_kind::triangle] == "exact" || r.name.engine == "cgal") REQUIRE(r.status == "exact");
        if (r.name.engine == "libccd") REQUIRE(r.name[aabb::strategy_kind::sort] == "bucket");
    }
}

TEST_CASE("A composition that loses a pair or reports one twice is named and gets no row") {
    for (const fault what : {fault::loses, fault::repeats}) {
        const temporary_folder folder;
        const experiment e = boxes();
        results_folder results(folder / "r", record_of(e), existing_results::reject);
        std::vector<candidate> candidates = aabblab::candidates_for(e, e.scenes[0]);
        candidates.insert(candidates.begin() + 1, wrong_candidate(what));
        const auto failures = aabblab::run_scene(e, e.scenes[0], candidates, results);
        REQUIRE(failures.size() == 1);
        INFO(failures[0]);
        CHECK(failures[0].starts_with(
            "wrong has a wrong result on brownian (objects=200 frames=3 seed=1), frame 2: the pair "));
        REQUIRE(failures[0].ends_with(what == fault::loses ? " is a false negative" : " is reported more than once"));
        REQUIRE(results.rows().size() == 6);
        for (const row& r : results.rows()) REQUIRE(r.name[aabb::strategy_kind::sort] != "wrong");
        const auto differences = aabblab::read_differences(folder / "r/differences.csv");
        REQUIRE(differences.size() == 1);
        REQUIRE(differences[0].what == (what == fault::loses ? "missing" : "invented"));
        REQUIRE(differences[0].kind == "boxes");
        REQUIRE(differences[0].count == 1);
    }
}

TEST_CASE("Differences of an inexact triangle test are counted by class and are no failure") {
    const experiment e = meshes();
    const auto candidates = aabblab::candidates_for(e, e.scenes[0]);
    const aabblab::scene_validation result = aabblab::validate_scene(e.scenes[0], candidates);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
        const aabblab::validated_row& v = result.candidates[i];
        INFO(aabblab::text_of(v.name));
        REQUIRE(candidates[i].exact ==
                (v.name[aabb::strategy_kind::triangle] == "exact" ? v.name.engine.empty() : v.name.engine == "cgal"));
        REQUIRE(v.failure.empty());
        std::uint64_t by_class = 0;
        for (const aabblab::difference& d : v.differences) by_class += d.count;
        REQUIRE(by_class == *v.false_negatives + *v.false_positives);
        if (candidates[i].exact) REQUIRE((by_class == 0 && v.digest == result.digest));
    }
}

TEST_CASE_METHOD(in_folder, "A candidate that is stopped early runs once, and not again when the run is resumed") {
    experiment e = boxes(4);
    e.patience = 10;
    std::vector<candidate> candidates = aabblab::candidates_for(e, e.scenes[0]);
    const auto wait = [] { std::this_thread::sleep_for(std::chrono::milliseconds(50)); };
    candidates.push_back(altered_candidate("slow", wait, [](auto&) {}));
    results_folder results(folder / "r", record_of(e), existing_results::reject);
    REQUIRE(aabblab::run_scene(e, e.scenes[0], candidates, results).empty());
    const auto rows_of = [&](const std::string& sort) {
        return std::ranges::count_if(results.rows(),
                                     [&](const row& r) { return r.name[aabb::strategy_kind::sort] == sort; });
    };
    CHECK(rows_of("slow") == 1);
    CHECK(rows_of("std") == 4);
    CHECK(holds(aabblab::heading_of(aabblab::summarise(results.rows())[0]), "repeated less often than others: slow"));
    const std::size_t row_count = results.rows().size();
    const std::string text = bytes_of_file(folder / "r/results.csv");
    REQUIRE(aabblab::run_scene(e, e.scenes[0], candidates, results).empty());
    CHECK(results.rows().size() == row_count);
    CHECK(bytes_of_file(folder / "r/results.csv") == text);
}

TEST_CASE("Each scene runs its candidates after the baseline in a reproducible random order") {
    experiment e = boxes(1);
    e.recorded.clear();
    std::vector<candidate> candidates = aabblab::candidates_for(e, e.scenes[0]);
    candidates.resize(1);
    for (std::size_t i = 1; i < 8; ++i) {
        candidates.push_back(candidates.front());
        candidates.back().name[aabb::strategy_kind::sort] = std::to_string(i);
    }
    const auto order_in = [&](std::uint64_t seed) {
        const temporary_folder folder;
        aabblab::scene_choice scene = e.scenes[0];
        scene.seed = seed;
        results_folder results(folder / "r", record_of(e), existing_results::reject);
        REQUIRE(aabblab::run_scene(e, scene, candidates, results).empty());
        std::string order;
        for (const row& r : results.rows()) order += r.name[aabb::strategy_kind::sort] + " ";
        CHECK(order.starts_with(candidates.front().name[aabb::strategy_kind::sort] + " "));
        return order;
    };
    const std::string first = order_in(1);
    CHECK(order_in(1) == first);
    CHECK(order_in(2) != first);
    CHECK(order_in(3) != order_in(2));
}

TEST_CASE_METHOD(in_folder, "Results of another config are not resumed") {
    rows_of_run(boxes(), folder / "r");
    REQUIRE_THROWS_AS(results_folder(folder / "r", record_of(boxes(5)), existing_results::resume), aabb::input_error);
    // The table has a row of a scene that is not in the manifest.
    std::string text = bytes_of_file(folder / "r/results.csv");
    REQUIRE_NOTHROW(results_folder(folder / "r", record_of(boxes()), existing_results::resume));
    text.replace(text.rfind("brownian"), 8, "hollow_x");
    folder.write("r/results.csv", text);
    REQUIRE_THROWS_WITH(results_folder(folder / "r", record_of(boxes()), existing_results::resume),
                        Catch::Matchers::ContainsSubstring("manifest.json has no scene hollow_x"));
    std::filesystem::remove(folder / "r/manifest.json");
    REQUIRE_THROWS_AS(results_folder(folder / "r", record_of(boxes()), existing_results::resume), aabb::input_error);
}

TEST_CASE_METHOD(in_folder, "Metrics that were not requested are not measured") {
    experiment e = boxes(5);
    e.recorded.clear();
    const std::vector<row> rows = rows_of_run(e, folder / "r");
    REQUIRE(rows.size() == 3);
    for (const row& r : rows) {
        REQUIRE_FALSE((r.build_ms || r.first_ms || r.search_ms || r.counts[0] || r.bytes[0] || r.false_negatives));
        REQUIRE(r.status == "exact");
    }
}

TEST_CASE("A lost pair of boxes is a failure even with an inexact triangle test") {
    candidate tested = wrong_candidate(fault::loses);
    tested.exact = false;
    const aabblab::scene_validation result = aabblab::validate_scene(boxes().scenes[0], std::vector{tested});
    REQUIRE(result.candidates[0].failure.ends_with("is a false negative"));
}

TEST_CASE_METHOD(in_folder, "A candidate with a wrong result when timed loses the rows of its earlier repeats") {
    const experiment e = boxes(3);
    std::vector<candidate> candidates = aabblab::candidates_for(e, e.scenes[0]);
    candidate late = wrong_candidate(fault::loses);
    // It is right in the validation and in its first repeat.
    late.make_global = [runs = 0, wrong = late.make_global](aabb::instrumentation counted) mutable {
        return runs++ < 2 ? aabb::compose_global_search({}, counted) : wrong(counted);
    };
    candidates.push_back(late);
    results_folder results(folder / "r", record_of(e), existing_results::reject);
    const auto failures = aabblab::run_scene(e, e.scenes[0], candidates, results);
    REQUIRE(failures.size() == 1);
    REQUIRE(holds(failures[0], " when timed, but was "));
    const std::vector<row> rows = aabblab::read_rows(folder / "r/results.csv");
    REQUIRE(rows.size() == 9);
    REQUIRE(results_of(rows) == results_of(results.rows()));
    for (const row& r : rows) REQUIRE(r.name[aabb::strategy_kind::sort] != "wrong");
}

TEST_CASE_METHOD(in_folder, "Results of another config or build are set aside on request, and others resumed") {
    const auto run = [&](const experiment& e) {
        results_folder results(folder / "r", record_of(e), existing_results::replace);
        const std::size_t before = results.rows().size();
        REQUIRE(aabblab::run_scene(e, e.scenes[0], aabblab::candidates_for(e, e.scenes[0]), results).empty());
        return std::pair{before, results.replaced()};
    };
    const std::pair<std::size_t, std::string> no_rows{0, ""};
    const std::pair<std::size_t, std::string> all_rows{6, ""};
    REQUIRE(run(boxes()) == no_rows);
    REQUIRE(run(boxes()) == all_rows);
    const auto [rows_left, reason] = run(boxes(5));
    REQUIRE(rows_left == 0);
    REQUIRE(holds(reason, "another config"));
    REQUIRE(aabblab::read_rows(folder / "r/results.csv").size() == 15);
    // The results are of another build, whose tables had other columns.
    std::string manifest = bytes_of_file(folder / "r/manifest.json");
    const std::string commit = "\"commit\": \"";
    manifest.insert(manifest.find(commit) + commit.size(), "0");
    folder.write("r/manifest.json", manifest);
    folder.write("r/results.csv", "columns,of,then\n1,2,3\n");
    const auto [rows_left_of_build, reason_of_build] = run(boxes(5));
    REQUIRE(rows_left_of_build == 0);
    REQUIRE(holds(reason_of_build, "another build"));
    REQUIRE(bytes_of_file(folder / "r/results.csv.old") == "columns,of,then\n1,2,3\n");
    REQUIRE(aabblab::read_rows(folder / "r/results.csv").size() == 15);
}
