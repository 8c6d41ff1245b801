#include <regex>

#include "../experiments/program.hpp"

#include "../matches.hpp"
#include "worlds.hpp"

import aabblab.claims;
import aabblab.conditions;
import aabblab.figures;
import aabblab.reproduction;
import aabblab.statistics;
import aabblab.tables;

using aabblab::claim_result;
using aabblab::endpoint;
using aabblab::support;
using aabblab::verdict_kind;

namespace {

const claim_result& named(const aabblab::reproduction& results, const std::string& id) {
    return *std::ranges::find(results.claims, id, &claim_result::id);
}

/// The conditions of the primary endpoints of a claim, in words.
std::set<std::string> places_of(const claim_result& claim) {
    std::set<std::string> places;
    for (const endpoint& e : claim.primaries) places.insert(aabblab::text_of(e.where));
    return places;
}

/// Judges worlds together, each as the results of one machine.
aabblab::reproduction judged_worlds(const std::vector<double>& ratios, double noise,
                                    aabblab::experiment_size size = aabblab::experiment_size::quick) {
    std::vector<temporary_folder> folders(ratios.size());
    std::vector<aabblab::measurements> machines;
    for (std::size_t i = 0; i < ratios.size(); ++i) {
        worlds::write_world(folders[i].path(), ratios[i], noise, size);
        machines.emplace_back(folders[i].path());
    }
    return aabblab::judged(machines);
}

/// Compares the verdict on every claim with the one expected for its row, unless that is empty.
template <class Expected>
void check_verdicts(const aabblab::reproduction& results, const Expected& expected) {
    REQUIRE(results.claims.size() == worlds::claim_rows().size());
    for (std::size_t i = 0; i < results.claims.size(); ++i) {
        const claim_result& c = results.claims[i];
        INFO(c.sentence + "\n" + c.evidence);
        CHECK(c.id == worlds::claim_rows()[i].id);
        const std::string verdict = expected(worlds::claim_rows()[i]);
        if (!verdict.empty()) CHECK(c.id + " " + text_of(c.verdict) == c.id + " " + verdict);
    }
}
auto on_all(const std::string& verdict) {
    return [=](const worlds::claim_row&) { return verdict; };
}

/// Judges a world in which `change` sets values in the rows of one experiment; other times are equal.
/// @param disturb changes wall times only
aabblab::reproduction reproduction_where(
    const std::string& experiment, const std::function<void(const worlds::played&, aabblab::row&)>& change,
    const std::function<void(aabblab::row&)>& disturb = [](aabblab::row&) {}) {
    const temporary_folder folder;
    for (const aabblab::experiment& e : worlds::all_experiments(aabblab::experiment_size::quick))
        if (e.name == experiment) worlds::write_experiment(folder.path(), e, change, disturb);
    return judged(aabblab::measurements(folder.path()));
}

/// The text of the LaTeX report, without comments.
std::string paper_text() {
    std::string text;
    for (const auto& file : std::filesystem::recursive_directory_iterator(AABBLAB_CONFIGS "/../tex")) {
        if (file.path().extension() != ".tex") continue;
        std::ifstream in(file.path());
        for (std::string line; std::getline(in, line);)
            if (!line.starts_with("%")) text += line + "\n";
    }
    return text;
}

/// An endpoint of a series over the number of objects.
endpoint at(const std::string& objects, double ratio, aabblab::outcome direction) {
    return {.where = {{"objects", objects}},
            .ratio = ratio,
            .direction = direction,
            .subject = "on boxes",
            .along = "objects"};
}

}  // namespace

TEST_CASE("Every claim holds in a world where it is true and does not hold where it is false") {
    using aabblab::experiment_size;
    for (const experiment_size size : {experiment_size::quick, experiment_size::full})
        for (const auto& [ratio, verdict] : {std::pair{0.6, "holds"}, {1.7, "does not hold"}})
            check_verdicts(judged_worlds({ratio}, 0.01, size), on_all(verdict));
}

TEST_CASE("Quick and full runs measure every primary ratio that was stated before") {
    const aabblab::reproduction quick = judged_worlds({0.6}, 0.01);
    const aabblab::reproduction full = judged_worlds({0.6}, 0.01, aabblab::experiment_size::full);
    const std::vector<aabblab::stated_claim>& stated = aabblab::stated().claims;
    REQUIRE(stated.size() == quick.claims.size());
    for (std::size_t i = 0; i < stated.size(); ++i) {
        CAPTURE(stated[i].id);
        for (const aabblab::reproduction* run : {&quick, &full}) {
            const claim_result& claim = run->claims[i];
            CHECK(claim.id == stated[i].id);
            CHECK(claim.missing == std::vector<std::string>());
            CHECK(claim.primaries.size() == stated[i].primary.size());
            const auto is_earlier = [](const endpoint& e) { return e.is_earlier; };
            CHECK(std::ranges::count_if(claim.secondaries, is_earlier) ==
                  static_cast<std::ptrdiff_t>(stated[i].earlier.size()));
        }
        const std::set<std::string> places = places_of(full.claims[i]);
        CHECK(places_of(quick.claims[i]) == places);
        // They are listed twice, so that none changes unnoticed.
        if (const auto& expected = worlds::claim_rows()[i].primaries; !expected.empty()) CHECK(places == expected);
    }
    // SMB's claim is judged, but not counted among the paper's.
    const std::string count = std::to_string(stated.size() - 1);
    CHECK(quick.headline == "Of the paper's " + count + " claims, " + count + " hold.");
    CHECK(brief_table(quick).rows.size() == stated.size() - 1);
    CHECK(quick.claims.back().of == "SMB");
}

TEST_CASE("What is stated before the measurements is what the program judges by") {
    const aabblab::stated_analysis& stated = aabblab::stated();
    CHECK(stated.margin == aabblab::equivalence_band);
    CHECK(stated.level == aabblab::one_sided);
    for (const aabblab::stated_claim& claim : stated.claims) {
        CAPTURE(claim.id);
        CHECK((claim.of == "paper" || claim.of == "SMB"));
        CHECK_FALSE(claim.primary.empty());
        for (const std::string& text : {claim.claim, claim.quote, claim.regime, claim.measured})
            CHECK_FALSE(text.empty());
        CHECK(claim.left_open.empty() == (claim.rule == aabblab::verdict_rule::every));
        for (const auto& ratios : {claim.primary, claim.earlier})
            for (const aabblab::stated_ratio& ratio : ratios)
                CHECK(ratio.source.find_first_of("{}") == std::string::npos);
    }
    const auto c3 = std::ranges::find(stated.claims, "C3", &aabblab::stated_claim::id);
    CHECK(c3->primary.front().source == "c3: update_cpu_ms of sort=shell:gaps=ciura over sort=insertion");
    CHECK(aabblab::value_of(c3->primary.back().where, "gaps") == "shell");
    // Scenes have seeds that earlier archives did not have.
    const std::set<std::uint64_t> earlier(stated.earlier_seeds.begin(), stated.earlier_seeds.end());
    for (const auto size : {aabblab::experiment_size::quick, aabblab::experiment_size::full})
        for (const aabblab::experiment& e : worlds::all_experiments(size)) {
            CAPTURE(e.name);
            std::set<std::uint64_t> seeds;
            for (const aabblab::scene_choice& scene : e.scenes) seeds.insert(scene.seed.value());
            CHECK(std::ranges::equal(seeds, std::span(stated.seeds).first(seeds.size())));
            CHECK(std::ranges::none_of(seeds, [&](std::uint64_t seed) { return earlier.contains(seed); }));
        }
}

TEST_CASE("A primary ratio that was not measured is named, and leaves a claim open that the others favour") {
    const auto with_lines = [](const std::string& status) {
        return reproduction_where("c3", [&](const worlds::played& p, aabblab::row& r) {
            r.update_ms = p.has("shell") ? 0.5 : 1;
            if (p.scene.kind == "line" && p.has("four_one")) r.status = status;
        });
    };
    CHECK(text_of(named(with_lines("exact"), "C3").verdict) == "holds");
    const aabblab::reproduction results = with_lines("inexact");
    const claim_result& c3 = named(results, "C3");
    CHECK(text_of(c3.verdict) == "undecided");
    CHECK(c3.missing.size() == 1);
    CHECK(holds(c3.evidence, "Not measured, and so undecided: "));
    CHECK(holds(c3.evidence, "line, "));
    CHECK(holds(c3.evidence, "gaps four_one."));
}

TEST_CASE("A claim about what is left open holds in part, and one about all is refuted by one") {
    // Shell sort is faster with two gaps only.
    const auto sorts = reproduction_where("c3", [](const worlds::played& p, aabblab::row& r) {
        r.update_ms = p.has("four_one") ? 0.5 : p.has("shell") ? 2 : 1;
    });
    CHECK(text_of(named(sorts, "C3").verdict) == "holds in part");
    CHECK(holds(named(sorts, "C3").sentence,
                "with the gaps 4 and 1, at up to 0.1 edges per frame: 0.500 times the time"));
    // Segments pay up to 16 and cost from there on.
    const auto segments = reproduction_where("c4", [](const worlds::played& p, aabblab::row& r) {
        const std::string& partition = p.tested[aabb::strategy_kind::partition];
        const std::size_t at = partition.rfind('=');
        const double number = at == std::string::npos       ? 1
                              : partition.ends_with("auto") ? 16
                                                            : std::stod(partition.substr(at + 1));
        r.search_ms = r.update_ms = std::abs(std::log2(number / 16)) + 1;
        r.detect_ms = 0;
    });
    CHECK(text_of(named(segments, "C4a").verdict) == "does not hold");
    CHECK(text_of(named(segments, "C4b").verdict) == "holds");
}

TEST_CASE("In a world without differences claims of less show none, and claims of not more hold") {
    check_verdicts(judged_worlds({1}, 0.003), [](const worlds::claim_row& row) { return row.where_equal; });
}

TEST_CASE("Machines that agree give their common verdict, and those that disagree leave it undecided") {
    const aabblab::reproduction agreed = judged_worlds({0.6, 0.5}, 0.01);
    check_verdicts(agreed, on_all("holds"));
    // The ratio is the geometric mean of both.
    CHECK(std::abs(named(agreed, "C1a").primaries.front().ratio - std::sqrt(0.6 * 0.5)) < 0.02);
    check_verdicts(judged_worlds({0.6, 1.7}, 0.01), on_all("undecided"));
}

TEST_CASE("Timed claims are undecided under strong noise") {
    check_verdicts(judged_worlds({0.97}, 1), [](const auto& row) { return row.is_timed ? "undecided" : ""; });
}

TEST_CASE_METHOD(in_folder, "Without measurements every claim is undecided") {
    check_verdicts(judged(aabblab::measurements(folder.path())), on_all("undecided"));
}

TEST_CASE("A sentence states direction, ratio and conditions of endpoints") {
    using enum aabblab::outcome;
    using aabblab::quantity;
    const auto text = [](std::vector<endpoint> endpoints, quantity compared = quantity::time) {
        for (endpoint& e : endpoints) e.compared = compared;
        return aabblab::sentence_of(endpoints);
    };
    CHECK(text({at("100", 0.5, less)}) == "On boxes: 0.500 times the time.");
    CHECK(text({at("100", 0.9, less)}) == "On boxes: 0.900 times the time.");
    CHECK(text({at("100", 3, more)}) == "On boxes: 3.00 times the time.");
    CHECK(text({at("100", 1.004, same)}) == "On boxes: no difference.");
    CHECK(text({at("100", 1.004, undecided)}) == "On boxes: undecided.");
    CHECK(text({at("100", 0.36, less)}, quantity::bytes) == "On boxes: 0.360 times the memory.");
    // Numbers are ordered by value, not as words or as in the file.
    CHECK(text({at("1000", 0.8, less), at("100", 1.3, more), at("10000", 0.25, less)}) ==
          "On boxes: 1.30 times the time with 100 objects, 0.250 to 0.800 times the time with 1,000 or more objects.");
    CHECK(text({at("100", 1.6, more), at("1000", 1.2, more), at("10000", 1, same), at("20000", 0.5, less)}) ==
          "On boxes: 1.20 to 1.60 times the time with up to 1,000 objects, no difference with 10,000 objects, 0.500 "
          "times "
          "the time with 20,000 objects.");
    std::vector<endpoint> scenes{at("1", 0.4, less), at("2", 1.3, more), at("3", 0.5, less)};
    for (endpoint& e : scenes) e.along.clear();
    CHECK(text(scenes) == "On boxes: 0.400 to 1.30 times the time.");
    scenes[0].direction = undecided;
    CHECK(text(scenes) == "On boxes: 0.500 to 1.30 times the time in 2 of 3 conditions, 1 undecided.");
    scenes[1].subject.reset();
    CHECK(text(scenes) == "On boxes: 0.500 times the time in 1 of 2 conditions, 1 undecided.");
    CHECK(aabblab::sentence_of({}) == "There are no measurements that decide it.");
    CHECK(aabblab::sentence_of(std::vector{at("1", 2, more)}, "Per element") ==
          "Per element, on boxes: 2.00 times the time.");
    // If only the claim's margin is decided, the sentence says no more.
    endpoint undecided_region = at("100", 0.97, undecided);
    undecided_region.corrected = support::favours;
    CHECK(text({undecided_region}) == "On boxes: not slower.");
    undecided_region.corrected = support::contradicts;
    CHECK(text({undecided_region}) == "On boxes: not faster.");
    CHECK(text({undecided_region}, quantity::bytes) == "On boxes: no less memory.");
    // Quantities of one subject share its label.
    std::vector<endpoint> quantities{at("1", 1.2, more), at("1", 0.36, less), at("1", 0.009, less)};
    quantities[1].compared = quantity::bytes;
    quantities[2].compared = quantity::slowdown;
    CHECK(aabblab::sentence_of(quantities) ==
          "On boxes: 1.20 times the time, 0.360 times the memory, 0.00900 times the slowdown.");
}

TEST_CASE("A verdict depends on the band only if its ratio is close to it") {
    const aabblab::table bands = judged_worlds({0.93}, 0.003).bands.content;
    REQUIRE(bands.columns.size() == 6);
    const auto row_of = [&](const std::string& id) {
        return *std::ranges::find(bands.rows, id, [](const auto& cells) { return cells[0]; });
    };
    CHECK(row_of("C7b")[2] == "holds");
    CHECK(row_of("C7b")[4] == "holds");
    CHECK(row_of("C7b")[5] == "no difference");
    CHECK(row_of("C2")[5] == "holds");
}

TEST_CASE("A run that waited for a processor or whose repeats differ reports it") {
    const auto disturbance_with = [](double waiting, double difference) {
        return reproduction_where(
                   "three_lists",
                   [&](const worlds::played&, aabblab::row& r) {
                       r.update_ms = r.repeat % 2 == 0 ? 1 : 1 + difference;
                   },
                   [&](aabblab::row& r) { r.update_ms = *r.update_ms + waiting; })
            .disturbance;
    };
    CHECK(disturbance_with(0, 0).empty());
    CHECK(disturbance_with(0, 0.1).empty());
    CHECK(disturbance_with(1, 0) ==
          "The machine was not quiet. The program waited for a processor during 25.0 % of the time of all frames; on a "
          "quiet machine it is less than 2 %. The errors of ratios may exceed their intervals.");
    CHECK(disturbance_with(0, 0.6).starts_with(
        "The machine was not quiet. The median difference between successive repeats is 18.2 %"));
}

TEST_CASE("Waiting for a processor changes no ratio") {
    const auto ratios = [](const std::function<void(aabblab::row&)>& disturb) {
        const temporary_folder folder;
        worlds::write_world(folder.path(), 0.8, 0.05, aabblab::experiment_size::quick, disturb);
        std::vector<std::string> texts;
        for (const claim_result& c : judged(aabblab::measurements(folder.path())).claims)
            for (const auto& endpoints : {c.primaries, c.secondaries})
                for (const endpoint& e : endpoints) texts.push_back(c.id + " " + ratio_text(e));
        return texts;
    };
    // Every composition waits for a different share.
    const auto wait = [](aabblab::row& r) {
        const double times = 1 + static_cast<double>(text_of(r.name).size() % 7);
        for (auto* ms : {&r.first_ms, &r.update_ms, &r.search_ms, &r.detect_ms}) *ms = times * **ms;
    };
    CHECK(ratios(wait) == ratios([](aabblab::row&) {}));
}

TEST_CASE("The null control reports a difference only if there is one") {
    const auto outcomes = [](double of_second_name) {
        const auto slower = [&](const worlds::played& p, aabblab::row& r) {
            if (p.has("gaps=ciura")) r.search_ms = of_second_name;
        };
        const aabblab::named_table control = reproduction_where("null_control", slower).null_control;
        std::map<std::string, int> counts;
        for (const std::vector<std::string>& cells : control.content.rows) ++counts[cells.back()];
        return std::pair(counts, control.caption);
    };
    const auto [same, nothing] = outcomes(1);
    REQUIRE(same.size() == 1);
    CHECK(same.at("no difference") > 4);
    CHECK(
        holds(nothing, "None of the " + std::to_string(same.at("no difference")) + " intervals excludes a ratio of 1"));
    CHECK(nothing.ends_with("Without correction, " + std::to_string(same.at("no difference")) +
                            " are decided as no difference."));
    const auto [half, something] = outcomes(4);
    CHECK(half.at("a difference") == half.at("no difference"));
    CHECK(holds(something, " " + std::to_string(half.at("a difference")) + " are decided as a difference"));
}

TEST_CASE("A claim that holds from some size on states this size") {
    const auto results = reproduction_where("figure1", [](const worlds::played& p, aabblab::row& r) {
        const bool improved = p.has("shell") && p.has("axial_cut");
        const bool many = r.objects >= 1000;
        r.search_ms = improved && !many ? 2 : improved ? 0.1 : 1;
        r.update_ms = r.search_ms;
        r.detect_ms = 0;
    });
    const claim_result& c1 = named(results, "C1a");
    INFO(c1.sentence);
    CHECK(text_of(c1.verdict) == "undecided");  // the experiment with three lists has not run
    REQUIRE(c1.missing.size() == 1);
    CHECK(c1.missing.front().starts_with("three_lists: frame_cpu_ms of sort=shell "));
    CHECK(c1.missing.front().ends_with("sweep=all_axes, on brownian, objects 10,000, displacement 0.1"));
    CHECK(
        c1.sentence.starts_with("On cubes that drift by up to 0.1 edges per frame: 2.00 times the time with 100 "
                                "objects, 0.100 times the time with "
                                "1,000 or more objects"));
}

TEST_CASE("A claim that compares a wrong composition is undecided") {
    for (const auto& [experiment, part, id] : {std::tuple("c3", "shell", "C3"), {"c5", "axial_cut", "C5b"}}) {
        const auto results = reproduction_where(experiment, [part](const worlds::played& p, aabblab::row& r) {
            if (p.has(part)) r.status = "inexact";
        });
        CHECK(named(results, id).primaries.empty());
        CHECK(text_of(named(results, id).verdict) == "undecided");
    }
}

TEST_CASE("Every cell size and number of segments of the configs is plotted") {
    const aabblab::reproduction results = judged_worlds({0.6}, 0.01);
    for (const aabblab::experiment& e : worlds::all_experiments(aabblab::experiment_size::quick)) {
        if (e.name != "c4" && e.name != "c5") continue;
        for (const aabblab::candidate& tested : aabblab::candidates_for(e, e.scenes.front())) {
            const std::string& partition = tested.name[aabb::strategy_kind::partition];
            const std::vector<aabb::setting> settings = aabb::parse_strategy(partition).settings;
            const auto parameter =
                std::ranges::find(settings, e.name == "c4" ? "segments" : "cell_size", &aabb::setting::name);
            if (parameter == settings.end() || parameter->value == "auto") continue;
            CAPTURE(partition);
            const aabblab::figure& f = named(results, e.name == "c4" ? "C4a" : "C5a").figures.front();
            const aabblab::series& line = f.panels.empty() ? f.lines.front() : f.panels.front().lines.front();
            CHECK(std::ranges::any_of(line.points, [&](const auto& p) { return p.x == std::stod(parameter->value); }));
        }
    }
}

TEST_CASE("A grid of one cell does not count as a grid") {
    const auto results = reproduction_where("c5", [](const worlds::played& p, aabblab::row& r) {
        const bool is_one_cell = p.tested[aabb::strategy_kind::partition].ends_with("cell_size=64");
        if (is_one_cell) worlds::count_in(r, "subsets") = 1;
        r.search_ms = r.update_ms = is_one_cell ? 0.01 : 1;
    });
    const std::vector<endpoint>& others = named(results, "C5b").secondaries;
    const auto regret = std::ranges::find(others, "c5: regret", &endpoint::source);
    REQUIRE(regret != others.end());
    CHECK(std::abs(regret->ratio - 1) < 0.01);
    CHECK_FALSE(holds(named(results, "C5b").sentence, "takes less time than the cut"));
    CHECK(holds(named(results, "C5a").sentence,
                " and 10,000 objects, cells of 64 edges are a single one, which is no grid."));
    CHECK_FALSE(holds(named(results, "C5a").sentence, "cells of 32 edges are a single one"));
    for (const aabblab::figure_panel& panel : named(results, "C5a").figures.front().panels)
        for (const aabblab::series& s : panel.lines)
            CHECK(std::ranges::none_of(s.points, [](const aabblab::figure_point& p) { return p.x == 64; }));
}

TEST_CASE("Splitting is not judged in scenes where nothing is split") {
    const auto results = reproduction_where("c9", [](const worlds::played& p, aabblab::row& r) {
        if (p.value_of("span") == "0.1") worlds::count_in(r, "pieces") = 0;
    });
    CHECK_FALSE(named(results, "C9").primaries.empty());
    CHECK(std::ranges::none_of(named(results, "C9").secondaries,
                               [](const endpoint& e) { return aabblab::value_of(e.where, "span") == "0.1"; }));
    CHECK(std::ranges::any_of(named(results, "C9").secondaries,
                              [](const endpoint& e) { return aabblab::value_of(e.where, "span") == "0.5"; }));
}

TEST_CASE("The whole algorithm is also judged where global search matters") {
    const auto results = reproduction_where("c11", [](const worlds::played& p, aabblab::row& r) {
        const bool far_apart = p.value_of("density") == "0.001";
        r.update_ms = r.search_ms = 1;
        r.detect_ms = far_apart ? 1 : 98;
        if (p.has("axial_cut") && far_apart) r.search_ms = 0.1;
        if (p.has("compressed")) r.detect_ms = 1.2 * *r.detect_ms;
    });
    const claim_result& c11 = named(results, "C11");
    CHECK(text_of(c11.verdict) == "holds in part");
    CHECK(holds(c11.sentence, "where detailed models touch: 1.20 times the time"));
    CHECK(holds(c11.sentence, "with simple models far apart: 0.767 times the time"));
    CHECK(c11.sentence.ends_with("% with 100,000 simple ones far apart."));
    CHECK(c11.tables.back().content.rows.front().back() == "2.00");
    CHECK(c11.tables.back().content.rows.back().back() == "66.7");
    CHECK(c11.figures.front().lines.front().points.size() > 1);
}

TEST_CASE("A cell size that gives one cell in a scene is excluded only there") {
    const auto results = reproduction_where("c5", [](const worlds::played& p, aabblab::row& r) {
        const bool brownian = p.scene.kind == "brownian";
        const bool largest = p.has("cell_size=64");
        if (brownian && largest) worlds::count_in(r, "subsets") = 1;
        const bool best = p.has("axial_cut") || p.has(brownian ? "cell_size=4" : "cell_size=64");
        r.update_ms = r.search_ms = best ? 1 : 2;
        r.detect_ms = 0;
    });
    const std::vector<endpoint>& others = named(results, "C5b").secondaries;
    const auto regret = std::ranges::find(others, "c5: regret", &endpoint::source);
    REQUIRE(regret != others.end());
    CHECK(regret->corrected == support::favours);
    CHECK(std::abs(regret->ratio - 0.5) < 1e-9);
}

TEST_CASE("The claim on grids counts the scenes in which one beats the cut") {
    const auto results = reproduction_where("c5", [](const worlds::played& p, aabblab::row& r) {
        const bool faster = p.has("cell_size=16") || (p.has("cell_size=32") && p.scene.kind == "clustered");
        r.update_ms = r.search_ms = p.scene.kind == "one_huge" || !faster ? 1 : p.has("cell_size=16") ? 0.8 : 0.7;
        r.detect_ms = 0;
    });
    const claim_result& c5b = named(results, "C5b");
    // Of four kinds of scenes with two numbers of boxes.
    CHECK(holds(c5b.sentence,
                "In 6 of 8 scenes a grid of some fixed cell size takes less time than the cut, 0.70 to "
                "0.80 of it; of all sizes, cells of 16 are the fastest in 6."));
}

TEST_CASE("A size with more ordered input is excluded from the growth") {
    const auto results = reproduction_where("c2", [](const worlds::played&, aabblab::row& r) {
        if (r.objects != 1'000'000) return;
        for (const char* work : {"comparisons", "moves"}) worlds::count_in(r, work) = 9000 * r.objects;
        worlds::count_in(r, "inversions") = 0;
    });
    CHECK(text_of(named(results, "C2").verdict) == "holds");
    CHECK(named(results, "C2").primaries.front().ratio == 1);
    CHECK(aabblab::value_of(named(results, "C2").primaries.front().where, "elements") == "10000 to 100000");
}

TEST_CASE("An alternative counts only after the correction for multiple tests") {
    bool any_corrected = false;
    for (int percent = 10; percent < 30; ++percent) {
        CAPTURE(percent);
        const double effect = percent / 100.0;
        std::mt19937 random(1);
        std::normal_distribution<double> normal;
        const auto results = reproduction_where("c11", [&](const worlds::played& p, aabblab::row& r) {
            const bool better = p.value_of("objects") == "100" && p.has("axial_cut");
            r.detect_ms = std::exp((better ? -effect : 0.0) + 0.15 * normal(random));
            r.update_ms = r.search_ms = 0;
        });
        const auto c11 = std::ranges::find(results.choices, "C11", &aabblab::open_choice::claim);
        REQUIRE(c11 != results.choices.end());
        const std::vector<endpoint>& primaries = named(results, "C11").primaries;
        const auto same = std::ranges::find_if(
            primaries, [](const endpoint& e) { return aabblab::value_of(e.where, "objects") == "100"; });
        REQUIRE(same != primaries.end());
        const auto choice = std::ranges::find_if(
            c11->alternatives, [](const aabblab::open_choice::alternative& a) { return a.label.starts_with("100 "); });
        REQUIRE(choice != c11->alternatives.end());
        CHECK(choice->measured.uncorrected == same->uncorrected);
        // The alternatives are one family, the primary endpoints another; a correction never decides more.
        for (const support corrected : {choice->measured.corrected, same->corrected}) {
            CHECK((corrected == choice->measured.uncorrected || corrected == support::undecided));
            if (corrected != same->uncorrected) any_corrected = true;
        }
    }
    CHECK(any_corrected);
}

TEST_CASE_METHOD(in_folder, "A report says whether what decides the claims has changed since the run") {
    const auto report_with = [&](std::string_view endpoints) {
        std::ofstream(folder / "endpoints.toml") << endpoints;
        run_well({"reproduce", "--judge", "--out", folder.path()});
        return bytes_of_file(folder / "report.md");
    };
    worlds::write_world(folder.path(), 0.6, 0.05);
    CHECK_FALSE(holds(report_with(aabblab::stated_text()), "endpoints.toml differs"));
    CHECK(holds(report_with("[rule]\nmargin = 0.1\n"), "endpoints.toml differs"));
}

TEST_CASE_METHOD(in_folder, "Every later judgement reports what was wrong in a run") {
    worlds::write_world(folder.path(), 0.6, 0.05);
    run_well({"reproduce", "--judge", "--out", folder.path()});
    std::ofstream(folder / "failures.txt") << "shell is wrong on brownian, frame 3: the pair 1 2 is missing\n";
    const program_result wrong = run_program({"reproduce", "--judge", "--out", folder.path()});
    CHECK(wrong.status == 1);
    CHECK(holds(wrong.out, "shell is wrong on brownian, frame 3: the pair 1 2 is missing"));
    CHECK(holds(bytes_of_file(folder / "report.md"), "**Wrong:** shell is wrong on brownian"));
    CHECK(run_program({"reproduce", "--judge", "--out", folder / "none"}).status == 2);
}

TEST_CASE("A reproduction writes a self-contained page, every table and figure, and every number of the paper") {
    const temporary_folder folder;
    worlds::write_world(folder.path(), 0.6, 0.05);
    const aabblab::measurements results(folder.path());
    const aabblab::reproduction judgement = judged(results);
    const aabblab::figure plot{
        "a_plot", "A plot.", {"x", true}, {"y", true}, {{"", aabblab::series_style::line, {{1, 2, 2, 2}}}}};
    const aabblab::report_section section{"errors",
                                          "Error against run time",
                                          {"A statement with its number."},
                                          {plot},
                                          {{"a_table", "A table.", {{{"triangle", false}}, {{"exact"}}}}}};
    write_reproduction(folder.path(), {&results, 1}, judgement, {&section, 1}, {"shell is wrong on brownian, frame 3"});

    const std::string page = bytes_of_file(folder / "report.html");
    CHECK(holds(page, "shell is wrong on brownian, frame 3"));
    CHECK(holds(page, "<style>\n:root{"));
    // The page loads nothing from the network and runs no scripts.
    for (const char* part : {"<script", "<link rel=\"stylesheet", "@import", "url(", "<iframe", "onload"})
        CHECK_FALSE(holds(page, part));
    // Figures are long data URLs, and std::regex uses stack for each character.
    for (const std::string& to : found_in(page, R"((?:src|href)="([^"]{0,5}))"))
        CHECK((to.starts_with("data:") || to.starts_with("#")));

    const std::string macros = bytes_of_file(folder / "macros.tex");
    const std::vector<std::string> set = found_in(macros, R"(\\aabbset\{([^}]*)\})");
    const std::set<std::string> keys(set.begin(), set.end());
    const std::string paper = paper_text();
    const std::vector<std::string> asked = found_in(paper, R"(\\result\{([^}#]*)\})");
    for (const std::string& key : asked) {
        CAPTURE(key);
        CHECK(keys.contains(key));
    }
    CHECK(asked.size() > 20);
    for (const char* kind : {"claim", "measured", "setup", "condition", "favourable", "ratio", "low", "high", "verdict",
                             "because", "endpoints", "for", "against", "same", "undecided"})
        for (const claim_result& c : judgement.claims) CHECK(keys.contains(c.id + "." + kind));

    for (const std::string& name : found_in(paper, R"(\\aabb(?:long)?table(?:\[[^\]]*\])?\{([^}#]*)\})")) {
        CAPTURE(name);
        CHECK(std::filesystem::exists(folder / ("tables/" + name + ".tex")));
    }
    for (const char* file : {"figures/a_plot.svg", "tables/a_table.md"}) CHECK(std::filesystem::exists(folder / file));
    for (const char* report : {"report.html", "report.md"}) {
        const std::string text = bytes_of_file(folder / report);
        CHECK(holds(text, judgement.null_control.caption));
        // The last two are at a line break and at the end of the file that is built into the program.
        for (const char* part : {"Error against run time", "A statement with its number.", "A plot.", "A table.",
                                 "Each claim has primary ratios", "that a small ratio favours the claim",
                                 "was not measured is undecided", "never times."})
            CHECK_THAT(text, Catch::Matchers::ContainsSubstring(part));
    }
    CHECK(holds(macros, "\\aabbset{C5c.setup}{scene brownian"));

    for (const std::string& name : found_in(paper, R"(\\aabbfigure\{([^}#]*)\})"))
        for (const char* ending : {".svg", ".pdf", ".csv"}) {
            CAPTURE(name, ending);
            CHECK(std::filesystem::exists(folder / ("figures/" + name + ending)));
        }
    for (const claim_result& c : judgement.claims)
        for (const aabblab::named_table& t : c.tables)
            for (const char* ending : {".csv", ".md", ".tex"})
                CHECK(std::filesystem::exists(folder / ("tables/" + t.name + ending)));
}

TEST_CASE("A ratio near a bound of the band is not rounded to it") {
    CHECK(ratio_text(endpoint{.ratio = 1.075, .range = {1.0479, 1.1027}}) == "1.075 (1.048 to 1.103)");
    CHECK(aabblab::text_of(aabblab::factors{{"scene", "line"}, {"elements", "1000 to 1000000"}}) ==
          "line, elements 1,000 to 1,000,000");
    CHECK(ratio_text(endpoint{.ratio = 0.0182, .range = {0.0099, 12.34}}) == "0.0182 (0.00990 to 12.3)");
}
