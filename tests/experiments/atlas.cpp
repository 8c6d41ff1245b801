#include "program.hpp"

import aabb.registry;
import aabblab.archive;
import aabblab.atlas;
import aabblab.configs;
import aabblab.scenes;
import aabblab.statistics;
import aabblab.tables;

using aabblab::atlas_candidate;
using aabblab::atlas_scene;
using aabblab::atlas_time;

namespace {

atlas_candidate timed(const std::string& label, double ms, bool is_automatic = false) {
    return {label, is_automatic, {ms, ms * 1.01, ms * 0.99}, {2 * ms, 2 * ms, 2 * ms}};
}

atlas_scene cloud(const std::string& displacement, std::vector<atlas_candidate> candidates, bool is_held_out = false) {
    return {{"cloud", {{"objects", "1000"}, {"displacement", displacement}}, {}, 1},
            is_held_out,
            {},
            std::move(candidates)};
}

std::string cell(const aabblab::table& t, const std::string& tested, const std::string& column) {
    const auto k = std::ranges::find(t.columns, column, &aabblab::column::name) - t.columns.begin();
    for (const auto& cells : t.rows)
        if (cells[1] == tested) return cells[static_cast<std::size_t>(k)];
    return "none";
}

aabblab::judged_statement judged(const std::vector<atlas_scene>& atlas, const std::string& id) {
    const auto statements = judged_statements(atlas);
    return *std::ranges::find(statements, id, &aabblab::judged_statement::id);
}

/// The times of a and b cross at 0.1: their ratio is 1/2 at 0.01 and 2 at 1, and is interpolated in logarithms.
std::vector<atlas_scene> two_scenes() {
    return {cloud("0.01", {timed("a", 1), timed("b", 2), timed("auto", 1.5, true)}),
            cloud("1", {timed("a", 2), timed("b", 1), timed("auto", 1, true)})};
}

}  // namespace

TEST_CASE("The atlas counts wins and the regret of each candidate") {
    const std::vector<atlas_scene> atlas = two_scenes();
    const aabblab::table winners = winners_table(atlas);
    for (const char* tested : {"a", "b"}) {
        CHECK(cell(winners, tested, "fastest in") == "1");
        CHECK(cell(winners, tested, "shown in") == "1");
    }
    // auto ties with the fastest candidate of the second scene, but does not itself count as the fastest.
    CHECK(cell(winners, "auto", "fastest in") == "0");
    CHECK(cell(winners, "auto", "as fast in") == "1");
    const aabblab::table regrets = regrets_table(atlas, atlas_time::per_frame);
    CHECK(cell(regrets, "a", "worst") == "2.00");
    CHECK(cell(regrets, "a", "median") == "1.50");
    CHECK(cell(regrets, "auto", "worst") == "1.50");
    CHECK(cell(regrets, "auto", "over 1.3") == "1");
    // Regrets are relative to auto where it is the fastest.
    std::vector<atlas_scene> auto_wins = atlas;
    auto_wins[1].candidates[2] = timed("auto", 0.5, true);
    const aabblab::table updated = regrets_table(auto_wins, atlas_time::per_frame);
    CHECK(cell(updated, "b", "worst") == "2.00");
    CHECK(cell(updated, "a", "worst") == "4.00");
}

TEST_CASE("A border is where two candidates take the same time as one parameter varies") {
    std::vector<atlas_scene> atlas = two_scenes();
    const std::vector<aabblab::border> borders = borders_of(atlas);
    REQUIRE(borders.size() == 1);
    CHECK(borders[0].parameter == "displacement");
    CHECK(borders[0].before == "a");
    CHECK(borders[0].after == "b");
    CHECK(std::abs(borders[0].position - 0.1) < 1e-3);
    CHECK(borders[0].range.low < 0.1);
    CHECK_BETWEEN(0.1, borders[0].range.high, 0.2);
    const aabblab::table summary = borders_summary(borders);
    REQUIRE(summary.rows.size() == 1);
    CHECK(summary.rows[0][3] == "1");
    CHECK(summary.rows[0][4] == "0.1");
    atlas[1].scene.settings[0].value = "5000";
    CHECK(borders_of(atlas).empty());
    atlas[1].scene.settings[0].value = "1000";
    atlas[1].is_held_out = true;
    CHECK(borders_of(atlas).empty());
}

TEST_CASE("Verlet lists of several margins share the border of the fastest") {
    const std::string wide = "neighbour_list:margin=0.3 + radix";
    const std::string narrow = "neighbour_list:margin=0.03 + radix";
    const std::vector<atlas_scene> atlas{cloud("0.01", {timed(narrow, 1), timed(wide, 2), timed("radix", 4)}),
                                         cloud("0.1", {timed(narrow, 4), timed(wide, 1), timed("radix", 2)}),
                                         cloud("1", {timed(narrow, 8), timed(wide, 2), timed("radix", 1)})};
    const std::vector<aabblab::border> borders = borders_of(atlas);
    REQUIRE(borders.size() == 1);
    CHECK(borders[0].before == "neighbour_list + radix");
    CHECK(borders[0].after == "radix");
    CHECK(std::abs(borders[0].position - std::sqrt(0.1)) < 1e-3);
}

TEST_CASE("The interval of a border between single repeats comes from the repeats of other candidates") {
    std::vector<atlas_scene> atlas = two_scenes();
    for (atlas_scene& scene : atlas)
        for (atlas_candidate& candidate : scene.candidates) candidate.frame_ms.resize(1);
    CHECK(borders_of(atlas).empty());
    for (atlas_scene& scene : atlas) scene.candidates.push_back(timed("another", 9));
    const std::vector<aabblab::border> borders = borders_of(atlas);
    REQUIRE(borders.size() == 1);
    CHECK(borders[0].range.low < 0.0999);
    CHECK(borders[0].range.high > 0.1001);
}

TEST_CASE("Time models are fitted to the map and evaluated on held-out scenes") {
    std::vector<atlas_scene> atlas;
    for (std::size_t objects = 100; objects <= 25600; objects *= 2)
        for (const bool is_held_out : {false, true})
            for (const double pairs_per_object : {0.1, 2.0}) {
                // 10 ns per box and 5 ns per pair; half as much again in held-out scenes.
                const double n = static_cast<double>(objects);
                const double ms = (10 * n + 5 * n * pairs_per_object) * (is_held_out ? 1.5e-6 : 1e-6);
                atlas.push_back(cloud("0.1", {timed("linear", ms), timed("slow", 1e-6 * n * n)}, is_held_out));
                atlas.back().scene.settings[0].value = std::to_string(objects);
                atlas.back().measures.objects = objects;
                atlas.back().measures.pairs_per_object = pairs_per_object;
                atlas.back().candidates[0].frame_ms = {atlas.back().candidates[0].frame_ms[0]};
            }
    const std::vector<aabblab::candidate_model> models = models_of(atlas);
    REQUIRE(models.size() == 2);
    CHECK(models[0].label == "linear");
    CHECK(models[0].in_map.median < 1.01);
    CHECK(std::abs(models[0].held_out.median - 1.5) < 0.02);
    const std::vector<double> regrets = regrets_of_models(atlas, models);
    CHECK(regrets.size() == atlas.size() / 2);
    for (const double regret : regrets) CHECK(regret < 1.2);
}

TEST_CASE("A statement is decided by its own ratios, and undecided without them") {
    std::vector<atlas_scene> atlas;
    for (const char* objects : {"1000", "10000"})
        for (const char* displacement : {"0.001", "0.1", "1"})
            for (const char* density : {"0.1", "1"})
                atlas.push_back(
                    {{"cloud", {{"objects", objects}, {"displacement", displacement}, {"density", density}}, {}, 1},
                     false,
                     {},
                     {timed("embree", 2), timed("embree_refit", 1)}});
    const auto verdict = [&](const std::string& id) { return judged(atlas, id).verdict; };
    CHECK(verdict("B9") == aabblab::verdict_kind::does_not_hold);
    CHECK(verdict("B1") == aabblab::verdict_kind::undecided);
    for (atlas_scene& scene : atlas) std::swap(scene.candidates[0].frame_ms, scene.candidates[1].frame_ms);
    CHECK(verdict("B9") == aabblab::verdict_kind::holds);
}

TEST_CASE("The interval of a ratio of single repeats comes from the repeats of other candidates") {
    std::vector<atlas_scene> atlas{{{"cloud", {{"objects", "10000"}, {"moving", "0"}}, {}, 1},
                                    false,
                                    {},
                                    {timed("insertion + incremental", 8), timed("bucket + columns + simd", 1)}}};
    std::vector<atlas_candidate>& candidates = atlas[0].candidates;
    for (atlas_candidate& candidate : candidates) candidate.frame_ms.resize(1);
    const auto ratios = [&] { return judged(atlas, "B2").ratios; };
    CHECK(ratios().empty());
    candidates.push_back(timed("another", 3));
    REQUIRE(ratios().size() == 1);
    CHECK(ratios()[0].range.low < 7.99);
    CHECK(ratios()[0].range.high > 8.01);
    CHECK(ratios()[0].verdict == aabblab::support::contradicts);
    candidates.back().frame_ms = {1, 3, 9};
    CHECK(ratios()[0].verdict == aabblab::support::undecided);
}

TEST_CASE("The config of the atlas runs every candidate that a statement names") {
    std::set<std::string> labels;
    const auto e = aabblab::read_experiment(AABBLAB_CONFIGS "/atlas/atlas.toml", aabblab::experiment_size::full);
    for (const std::string& engine : e.engines) labels.insert(engine);
    for (const aabb::composition& c : e.compositions) {
        std::string label;
        for (const aabb::strategy_kind kind : aabb::strategy_kinds)
            if (info_of(kind).stage == aabb::stage::global_search && to_text(c[kind]) != "none")
                label += (label.empty() ? "" : " + ") + to_text(c[kind]);
        labels.insert(label);
    }
    for (const std::string& label : aabblab::labels_in_statements()) {
        INFO(label);
        CHECK(labels.contains(label));
    }
}

TEST_CASE_METHOD(in_folder, "atlas --judge draws maps from existing results and reports missing ones") {
    const program_result missing = run_program({"atlas", "--judge", "--out", folder / "none"});
    CHECK(missing.status == 2);
    CHECK(holds(missing.err, "there are no results of an atlas in"));
    folder.write("small.toml",
                 "name = \"atlas\"\n[[scene]]\nkind = \"cloud\"\nobjects = 50\ndisplacement = [0.01, 1]\n"
                 "frames = 3\n[[compose]]\nauto = true\n[[compose]]\nsort = [\"std\", \"radix\"]\n"
                 "[measure]\nrepeats = 2\n");
    run_well({"run", folder / "small.toml", "--out", folder / "map/atlas"});
    const program_result mapped = run_well({"atlas", "--judge", "--out", folder / "map"});
    CHECK(holds(mapped.err, "atlas_large has not been run yet"));
    for (const std::string& line : lines_of(mapped.out.substr(mapped.out.find("B1: ")))) {
        INFO(line);
        CHECK((line.size() <= 80 || line.starts_with("Maps, borders")));
    }
    for (const char* file : {"atlas.html", "atlas.md", "cells.csv", "borders.csv", "statement_ratios.csv",
                             "figures/map_1.svg", "figures/regret.svg"}) {
        INFO(file);
        CHECK(std::filesystem::exists(folder / "map" / file));
    }
    // Like `reproduce --judge`, it accepts another folder, that of a reproduction, and the archive of one.
    std::filesystem::create_directories(folder / "run/atlas");
    std::filesystem::copy(folder / "map/atlas", folder / "run/atlas/atlas", std::filesystem::copy_options::recursive);
    aabblab::write_archive(folder / "run.tar.xz", "reproduction", folder / "run",
                           std::vector<std::filesystem::path>{"atlas/atlas/manifest.json", "atlas/atlas/results.csv",
                                                              "atlas/atlas/differences.csv"});
    for (const char* source : {"map", "run", "run.tar.xz"}) {
        CAPTURE(source);
        run_well({"atlas", "--judge", folder / source, "--out", folder / "of" / source});
        CHECK(bytes_of_file(folder / "of" / source / "cells.csv") == bytes_of_file(folder / "map/cells.csv"));
    }
    CHECK(run_refused({"atlas", "--judge", folder / "gone"}).err ==
          "aabblab: " + (folder / "gone").string() + " does not exist\n");
    CHECK(holds(run_program({"atlas", folder / "map"}).err, "only --judge reads existing results"));
}
