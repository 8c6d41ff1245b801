#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <regex>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "../experiments/program.hpp"
#include "../experiments/temporary_folder.hpp"

#include "worlds.hpp"

import aabblab.claims;
import aabblab.conditions;
import aabblab.configs;
import aabblab.figures;
import aabblab.reproduction;
import aabblab.play;
import aabblab.statistics;

using aabblab::claim_result;
using aabblab::endpoint;
using aabblab::support;
using aabblab::verdict_kind;

namespace {

std::vector<std::string> verdicts_of(const aabblab::reproduction& all) {
    std::vector<std::string> texts;
    for (const claim_result& c : all.claims) texts.push_back(c.id + " " + text_of(c));
    return texts;
}

std::vector<std::string> each(const std::string& verdict) {
    std::vector<std::string> texts;
    for (int i = 1; i <= 12; ++i) texts.push_back("C" + std::to_string(i) + " " + verdict);
    return texts;
}

/// Written down here again, so that none is changed unseen.
aabblab::factors primary_of(const std::string& id, bool quick) {
    aabblab::factors drifting{{"scene", "brownian"}, {"objects", "10000"}, {"displacement", "0.1"}};
    const auto with = [](aabblab::factors all, const aabblab::factors& more) {
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    const auto pair_of = [](const std::string& triangles, const aabblab::factors& more) {
        aabblab::factors all{{"scene", "mesh_pair"}, {"meshes", "noise_sphere:triangles=" + triangles}};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    };
    const aabblab::factors huge{{"scene", "one_huge"},
                                {"objects", quick ? "2000" : "5000"},
                                {"huge", "10"},
                                {"span", "0.5"},
                                {"displacement", "0.1"}};
    if (id == "C2")
        return {{"scene", "line"},
                {"sort", "shell:gaps=ciura"},
                {"displacement", "0.1"},
                {"elements", quick ? "100 to 10000" : "100 to 100000"}};
    if (id == "C3") return with(drifting, {{"gaps", "ciura"}});
    if (id == "C4") return with(drifting, {{"axes", "2"}, {"segments", "8"}, {"over", "4"}});
    if (id == "C5") return {{"scene", "the worst of all"}, {"comparison", "axial_cut over the safest cell size"}};
    if (id == "C6")
        return {{"quantity", "one test"}, {"leaf_test", "triangle_box"}, {"leaf of", "B, carried into A's frame"}};
    if (id == "C7") return pair_of(quick ? "30000" : "100000", {{"quantity", "time"}, {"leaf_test", "triangle_box"}});
    if (id == "C8") return pair_of(quick ? "5000" : "20000", {{"over", "mean"}});
    if (id == "C9") return with(huge, {{"split_large", "4"}});
    if (id == "C10") return with(huge, {{"segments", "auto"}});
    if (id == "C11")
        return {
            {"scene", "mesh_swarm"}, {"objects", quick ? "40" : "60"}, {"density", "0.3"}, {"displacement", "0.05"}};
    return drifting;
}

/// A world in which `tell` changes the rows of one experiment of otherwise equal times.
aabblab::reproduction reproduction_where(const std::string& experiment,
                                         const std::function<void(const worlds::played&, aabblab::row&)>& tell) {
    const temporary_folder folder;
    for (const aabblab::experiment& e : worlds::all_experiments(aabblab::experiment_size::quick))
        if (e.name == experiment) worlds::write_experiment(folder.path(), e, tell);
    return judged(aabblab::measurements(folder.path()));
}

/// Of the LaTeX report, without its comments.
std::string paper_text() {
    std::string text;
    for (const auto& file :
         std::filesystem::recursive_directory_iterator(std::filesystem::path(AABBLAB_CONFIGS) / "../tex")) {
        if (file.path().extension() != ".tex") continue;
        std::ifstream in(file.path());
        for (std::string line; std::getline(in, line);)
            if (!line.starts_with("%")) text += line + "\n";
    }
    return text;
}

endpoint at(const std::string& scene, const std::string& objects, support found) {
    return {{{"scene", scene}, {"objects", objects}}, 1, {1, 1}, found, found};
}

}  // namespace

TEST_CASE("Every claim holds in a world where it is true, and does not where it is false") {
    struct world {
        double ratio;
        std::string verdict;
    };
    using aabblab::experiment_size;
    for (const experiment_size size : {experiment_size::quick, experiment_size::full})
        for (const world& w : {world{0.6, "holds"}, {1.7, "does not hold"}}) {
            const temporary_folder folder;
            worlds::write_world(folder.path(), w.ratio, 0.01, size);
            for (const claim_result& c : judged(aabblab::measurements(folder.path())).claims) {
                INFO(c.because);
                CHECK(c.id + " " + text_of(c) == c.id + " " + w.verdict);
                aabblab::factors where = c.primary.where;
                // Files where there are any, else shapes.
                if (c.id == "C11") std::erase_if(where, [](const auto& factor) { return factor.first == "meshes"; });
                CHECK(where == primary_of(c.id, size == experiment_size::quick));
            }
        }
}

TEST_CASE("Where nothing differs there is no difference, and what is to be not more holds") {
    const temporary_folder folder;
    worlds::write_world(folder.path(), 1, 0.003);
    for (const claim_result& c : judged(aabblab::measurements(folder.path())).claims) {
        INFO(c.because);
        const std::string verdict = text_of(c);
        if (c.id == "C2" || c.id == "C6" || c.id == "C10")
            CHECK(c.id + " " + verdict == c.id + " holds");
        else if (c.id == "C4" || c.id == "C5")
            // Some of their endpoints are to be not more.
            CHECK(c.id + " " + verdict.substr(0, 6) == c.id + " holds ");
        else
            CHECK(c.id + " " + verdict == c.id + " no difference");
    }
}

TEST_CASE("The null control finds nothing where there is nothing, and says so where it finds something") {
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
    CHECK(nothing.find(" 0 miss 1") != std::string::npos);
    const auto [half, something] = outcomes(4);
    CHECK(half.at("a difference") == half.at("no difference"));
    CHECK(something.find(" " + std::to_string(half.at("a difference")) + " are decided as a difference") !=
          std::string::npos);
}

TEST_CASE("Where noise hides everything, what is timed is undecided") {
    const temporary_folder folder;
    worlds::write_world(folder.path(), 0.97, 1);
    for (const claim_result& c : judged(aabblab::measurements(folder.path())).claims) {
        // Counts, and the times of Google Benchmark, have no noise here.
        if (c.id == "C2" || c.id == "C6" || c.id == "C12") continue;
        INFO(c.because);
        CHECK(c.id + " " + text_of(c) == c.id + " undecided");
    }
}

TEST_CASE("Without measurements every claim is undecided") {
    const temporary_folder folder;
    REQUIRE(verdicts_of(judged(aabblab::measurements(folder.path()))) == each("undecided"));
}

TEST_CASE("A claim that is true from some size on says from which") {
    const auto all = reproduction_where("figure1", [](const worlds::played& p, aabblab::row& r) {
        const bool improved = p.has("shell") && p.has("axial_cut");
        const bool many = r.objects >= 1000;
        r.search_ms = improved && !many ? 2 : improved ? 0.1 : 1;
        r.update_ms = r.search_ms;
    });
    INFO(all.claims[0].because);
    CHECK(text_of(all.claims[0]) == "holds when objects is at least 1000");
}

TEST_CASE("A composition that was wrong has no rows, and its claim no verdict") {
    const auto all = reproduction_where("c3", [](const worlds::played& p, aabblab::row& r) {
        if (p.has("shell")) r.status = "inexact";
    });
    CHECK(text_of(all.claims[2]) == "undecided");
    CHECK(all.claims[2].because == "There are no measurements that decide it.");
}

TEST_CASE("Every cell size and every number of segments of the configs is judged") {
    const temporary_folder folder;
    worlds::write_world(folder.path(), 0.6, 0.01);
    const aabblab::reproduction all = judged(aabblab::measurements(folder.path()));
    for (const aabblab::experiment& e : worlds::all_experiments(aabblab::experiment_size::quick)) {
        if (e.name != "c4" && e.name != "c5") continue;
        for (const aabblab::contender& who : aabblab::contenders_for(e, e.scenes.front())) {
            const std::string number = who.name[aabb::strategy_kind::partition].substr(
                who.name[aabb::strategy_kind::partition].rfind('=') + 1);
            if (number.find_first_not_of("0123456789") != std::string::npos) continue;
            CAPTURE(who.name[aabb::strategy_kind::partition]);
            const claim_result& claim = all.claims[e.name == "c4" ? 3 : 4];
            CHECK(std::ranges::any_of(claim.figures.front().lines.front().points,
                                      [&](const aabblab::figure_point& p) { return p.x == std::stod(number); }));
        }
    }
}

TEST_CASE("A composition that was wrong everywhere leaves what compares it with others open") {
    const auto all = reproduction_where("c5", [](const worlds::played& p, aabblab::row& r) {
        if (p.who[aabb::strategy_kind::partition].ends_with("cell_size=8")) r.status = "inexact";
    });
    CHECK(text_of(all.claims[4]) == "undecided");
}

TEST_CASE("Where nothing is split, splitting is not judged") {
    const auto all = reproduction_where("c9", [](const worlds::played& p, aabblab::row& r) {
        if (p.value_of("span") == "0.1") worlds::count_in(r, "pieces") = 0;
    });
    CHECK(all.claims[8].has_primary);
    CHECK(std::ranges::none_of(all.claims[8].secondary,
                               [](const endpoint& e) { return aabblab::value_of(e.where, "span") == "0.1"; }));
    CHECK(std::ranges::any_of(all.claims[8].secondary,
                              [](const endpoint& e) { return aabblab::value_of(e.where, "span") == "0.5"; }));
}

TEST_CASE("The whole algorithm is judged where global search counts, too") {
    const auto all = reproduction_where("c11", [](const worlds::played& p, aabblab::row& r) {
        const bool far_apart = p.value_of("density") == "0.005";
        r.update_ms = r.search_ms = 1;
        r.detect_ms = far_apart ? 1 : 98;
        if (p.has("axial_cut") && far_apart) r.search_ms = 0.1;
        if (p.has("compressed")) r.detect_ms = 1.2 * *r.detect_ms;
    });
    const claim_result& c11 = all.claims[10];
    CHECK(text_of(c11) == "holds when density is at most 0.005");
    CHECK(c11.tables.back().content.rows.front().back() == "2.00");
    CHECK(c11.tables.back().content.rows.back().back() == "66.7");
    CHECK(c11.figures.front().lines.front().points.size() > 1);
}

TEST_CASE("An alternative counts only where the others beside it leave it standing") {
    std::mt19937 random(1);
    std::normal_distribution<double> normal;
    const auto all = reproduction_where("c11", [&](const worlds::played& p, aabblab::row& r) {
        const bool better = p.value_of("objects") == "20000" && p.has("axial_cut");
        r.detect_ms = std::exp((better ? -0.1 : 0.0) + 0.02 * normal(random));
        r.update_ms = r.search_ms = 0;
    });
    const auto c11 = std::ranges::find(all.choices, "C11", &aabblab::open_choice::claim);
    REQUIRE(c11 != all.choices.end());
    const auto same = std::ranges::find_if(
        all.claims[10].secondary, [](const endpoint& e) { return aabblab::value_of(e.where, "objects") == "20000"; });
    REQUIRE(same != all.claims[10].secondary.end());
    const auto choice = std::ranges::find_if(
        c11->alternatives, [](const aabblab::open_choice::alternative& a) { return a.label.starts_with("20000 "); });
    REQUIRE(choice != c11->alternatives.end());
    CHECK(choice->measured.alone == support::favours);
    CHECK(choice->measured.found == support::undecided);
    CHECK(same->found == support::undecided);
}

TEST_CASE("What was wrong in a run is said by every later judgement") {
    const temporary_folder folder;
    worlds::write_world(folder.path(), 0.6, 0.05);
    const program_result fine = run_program({"reproduce", "--judge", "--out", folder.path().string()});
    CHECK(fine.status == 0);
    std::ofstream(folder / "failures.txt") << "shell is wrong on brownian, frame 3: the pair 1 2 is missing\n";
    const program_result wrong = run_program({"reproduce", "--judge", "--out", folder.path().string()});
    CHECK(wrong.status == 1);
    CHECK(wrong.out.find("shell is wrong on brownian, frame 3: the pair 1 2 is missing") != std::string::npos);
    CHECK(bytes_of_file(folder / "report.md").find("**Wrong:** shell is wrong on brownian") != std::string::npos);
    CHECK(run_program({"reproduce", "--judge", "--out", (folder / "none").string()}).status == 2);
}

TEST_CASE("The simplest condition tells endpoints apart") {
    const std::vector<endpoint> by_size{
        at("brownian", "100", support::contradicts), at("brownian", "1000", support::undecided),
        at("brownian", "10000", support::favours), at("still", "100000", support::favours)};
    CHECK(aabblab::simplest_condition(by_size) == "objects is at least 10000");
    // Open only because there are many: the condition must not speak for it.
    std::vector<endpoint> with_contrary = by_size;
    with_contrary.push_back(at("clustered", "10000", support::undecided));
    with_contrary.back().alone = support::no_difference;
    CHECK(aabblab::simplest_condition(with_contrary) == "scene is not clustered and objects is at least 10000");
    with_contrary.back().alone = support::favours;
    CHECK(aabblab::simplest_condition(with_contrary) == "objects is at least 10000");
    const std::vector<endpoint> by_scene{at("brownian", "100", support::favours),
                                         at("still", "100", support::contradicts),
                                         at("line", "100", support::contradicts)};
    CHECK(aabblab::simplest_condition(by_scene) == "scene is brownian");
    const std::vector<endpoint> by_both{
        at("brownian", "100", support::contradicts), at("brownian", "1000", support::favours),
        at("brownian", "10000", support::favours), at("still", "1000", support::contradicts)};
    CHECK(aabblab::simplest_condition(by_both) == "scene is brownian and objects is at least 1000");
    // Too few to choose two factors by.
    CHECK(aabblab::simplest_condition(std::span(by_both).subspan(0, 2)) == "objects is at least 1000");
    CHECK(aabblab::simplest_condition(std::vector{by_both[0], by_both[1], by_both[3]}).empty());
    std::vector<endpoint> with_exception{at("line", "10000", support::contradicts)};
    for (const char* objects : {"10000", "20000", "30000", "40000", "50000"})
        with_exception.push_back(at("brownian", objects, support::favours));
    for (const char* objects : {"100", "200", "300", "400", "500"})
        with_exception.push_back(at("brownian", objects, support::contradicts));
    with_exception.push_back(at("still", "100", support::favours));
    CHECK(aabblab::simplest_condition(with_exception).empty());
    CHECK(aabblab::nearest_condition(with_exception) ==
          "objects is at least 10000 (right in 10 of the 12 that speak for or against it)");
    // A second factor for the sake of one exception is none.
    CHECK(aabblab::simplest_condition(std::span(with_exception).first(with_exception.size() - 1)).empty());
    // That no endpoint meets it would be right of nearly all.
    std::vector<endpoint> rare(20, at("brownian", "100", support::contradicts));
    rare.push_back(at("brownian", "100", support::favours));
    CHECK(aabblab::nearest_condition(rare).empty());
    const std::vector<endpoint> two_exceptions{
        at("brownian", "100", support::favours), at("still", "100", support::favours),
        at("line", "100", support::contradicts), at("flat", "100", support::contradicts)};
    CHECK(aabblab::simplest_condition(two_exceptions) == "scene is brownian or scene is still");
    const std::vector<endpoint> in_none{at("brownian", "100", support::contradicts),
                                        at("brownian", "100", support::favours)};
    CHECK(aabblab::simplest_condition(in_none).empty());
}

TEST_CASE(
    "A reproduction is one page without addresses, every table and figure, and every number that the paper names") {
    const temporary_folder folder;
    worlds::write_world(folder.path(), 0.6, 0.05);
    const aabblab::reproduction all = judged(aabblab::measurements(folder.path()));
    const aabblab::report_section section{"errors",
                                          "Error against run time",
                                          {"A statement with its number."},
                                          {{"a_plot",
                                            "A plot.",
                                            {"x", true, {}},
                                            {"y", true, {}},
                                            {{"", aabblab::series_style::line, {{1, 2, 2, 2}}}},
                                            {}}},
                                          {{"a_table", "A table.", {{{"triangle", false}}, {{"exact"}}}}}};
    write_reproduction(folder.path(), all, {&section, 1}, {"shell is wrong on brownian, frame 3"});

    const std::string page = bytes_of_file(folder / "report.html");
    CHECK(page.find("shell is wrong on brownian, frame 3") != std::string::npos);
    CHECK(page.find("<script") == std::string::npos);
    CHECK(page.find("<style>\n:root{") != std::string::npos);
    // Figures are long addresses, and std::regex takes stack for each character.
    const std::regex address(R"((src|href)="([^"]{0,5}))");
    for (std::sregex_iterator i(page.begin(), page.end(), address), end; i != end; ++i) {
        const std::string to = (*i)[2];
        CHECK((to.starts_with("data:") || to.starts_with("#")));
    }

    const std::string macros = bytes_of_file(folder / "macros.tex");
    std::set<std::string> keys;
    const std::regex set(R"(\\aabbset\{([^}]*)\})");
    for (std::sregex_iterator i(macros.begin(), macros.end(), set), end; i != end; ++i) keys.insert((*i)[1]);
    const std::string paper = paper_text();
    const std::regex named(R"(\\result\{([^}#]*)\})");
    std::size_t count = 0;
    for (std::sregex_iterator i(paper.begin(), paper.end(), named), end; i != end; ++i, ++count) {
        CAPTURE((*i)[1].str());
        CHECK(keys.contains((*i)[1]));
    }
    CHECK(count > 20);
    for (const char* kind : {"claim", "measured", "setup", "condition", "favourable", "ratio", "low", "high", "verdict",
                             "because", "endpoints", "for", "against", "same", "undecided"})
        for (const claim_result& c : all.claims) CHECK(keys.contains(c.id + "." + kind));

    const std::regex tabled(R"(\\aabb(?:long)?table(?:\[[^\]]*\])?\{([^}#]*)\})");
    for (std::sregex_iterator i(paper.begin(), paper.end(), tabled), end; i != end; ++i) {
        CAPTURE((*i)[1].str());
        CHECK(std::filesystem::exists(folder / ("tables/" + (*i)[1].str() + ".tex")));
    }
    for (const char* file : {"figures/a_plot.svg", "tables/a_table.md"}) CHECK(std::filesystem::exists(folder / file));
    for (const char* report : {"report.html", "report.md"}) {
        const std::string text = bytes_of_file(folder / report);
        CHECK(text.find(all.null_control.caption) != std::string::npos);
        for (const char* part : {"Error against run time", "A statement with its number.", "A plot.", "A table."}) {
            INFO(part);
            CHECK(text.find(part) != std::string::npos);
        }
        CHECK(text.find("Each claim has one primary endpoint") != std::string::npos);
        // Where the file that the program was built with breaks a line, and where it ends.
        CHECK(text.find("the ratio of two compositions, or builds") != std::string::npos);
        CHECK(text.find("never between runs or machines.") != std::string::npos);
    }
    CHECK(macros.find("\\aabbset{C5.setup}{scene brownian") != std::string::npos);

    const std::regex drawn(R"(\\aabbfigure\{([^}#]*)\})");
    for (std::sregex_iterator i(paper.begin(), paper.end(), drawn), end; i != end; ++i)
        for (const char* ending : {".svg", ".pdf", ".gp", ".csv"}) {
            CAPTURE((*i)[1].str(), ending);
            CHECK(std::filesystem::exists(folder / ("figures/" + (*i)[1].str() + ending)));
        }
    for (const claim_result& c : all.claims)
        for (const aabblab::named_table& t : c.tables)
            for (const char* ending : {".csv", ".md", ".tex"})
                CHECK(std::filesystem::exists(folder / ("tables/" + t.name + ending)));
}

TEST_CASE("A ratio near the edge of the band is not rounded to the edge") {
    CHECK(ratio_text(endpoint{.where = {}, .ratio = 1.075, .range = {1.0479, 1.1027}}) == "1.075 (1.048 to 1.103)");
    CHECK(ratio_text(endpoint{.where = {}, .ratio = 0.0182, .range = {0.0099, 12.34}}) == "0.0182 (0.00990 to 12.3)");
}
