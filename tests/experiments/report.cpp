#include "csv_rows.hpp"

import aabb.registry;
import aabblab.page;
import aabblab.scenes;
import aabblab.tables;

using aabblab::row;

namespace {

row repeat_of(const std::string& sort, std::uint64_t repeat, double search_ms) {
    row r;
    r.experiment = "test";
    r.scene = {"brownian", {{"objects", "10"}}, {}, 1};
    r.objects = 10;
    r.frames = 3;
    r.name[aabb::strategy_kind::sort] = sort;
    r.name[aabb::strategy_kind::sweep] = "one_axis";
    r.repeat = repeat;
    r.build_ms = 1;
    r.first_ms = 5;
    r.update_ms = 0;
    r.search_ms = search_ms;
    r.detect_ms = 0;
    r.candidates = 1234567;
    r.digest = "0123456789abcdef";
    r.status = "exact";
    return r;
}

row with_seed(row r, std::uint64_t seed) {
    r.scene.seed = seed;
    return r;
}

row engine_row(double search_ms) {
    row r = repeat_of("", 0, search_ms);
    r.name = {};
    r.name.engine = "cgal";
    return r;
}

std::vector<std::string> column_of(const aabblab::table& t, const std::string& name) {
    const auto place = std::ranges::find(t.columns, name, &aabblab::column::name) - t.columns.begin();
    std::vector<std::string> cells;
    for (const auto& line : t.rows) cells.push_back(line.at(static_cast<std::size_t>(place)));
    return cells;
}

using texts = std::vector<std::string>;

}  // namespace

TEST_CASE("Ratios are computed within a repeat") {
    std::vector<row> rows;
    for (std::uint64_t repeat = 0; repeat < 7; ++repeat) {
        // The machine slows down; the second candidate still takes twice as long as the first.
        const double slow = 1 + static_cast<double>(repeat);
        rows.push_back(repeat_of("std", repeat, slow));
        rows.push_back(repeat_of("insertion", repeat, 2 * slow));
    }
    const aabblab::candidate_summary line = aabblab::summarise(rows)[0].candidates[1];
    CHECK(std::abs(line.ratio.value_or(0) - 2) < 1e-12);
    CHECK(std::abs(line.ratio_interval->low - 2) < 1e-12);
    CHECK(std::abs(line.ratio_interval->high - 2) < 1e-12);
    CHECK(line.repeats == 7);
    // A single repeat gives no interval.
    CHECK_FALSE(aabblab::summarise(std::span(rows).first(2))[0].candidates[1].ratio_interval.has_value());
}

TEST_CASE("Too few repeats for an interval are reported") {
    const std::string note =
        "95 %: - if repeats, seeds or processes are too few; for one seed in one process,\n4 repeats are enough\n";
    std::vector<row> rows;
    for (const auto& [repeat, slower] : {std::pair(0, 0.5), std::pair(1, 1.9), std::pair(2, 0.7), std::pair(3, 1.1)}) {
        rows.push_back(repeat_of("std", static_cast<std::uint64_t>(repeat), 1));
        rows.push_back(repeat_of("insertion", static_cast<std::uint64_t>(repeat), slower));
    }
    for (const std::size_t few : {1U, 2U, 3U}) {
        const auto scene = aabblab::summarise(std::span(rows).first(2 * few))[0];
        CHECK(scene.candidates[1].ratio.has_value());
        CHECK_FALSE(scene.candidates[1].ratio_interval.has_value());
        CHECK(holds(aabblab::heading_of(scene), note));
        CHECK(column_of(aabblab::table_of(scene), "95 %").front() == "-");
    }
    const auto scene = aabblab::summarise(rows)[0];
    CHECK(scene.candidates[1].ratio_interval.has_value());
    CHECK_FALSE(holds(aabblab::heading_of(scene), "too few"));
}

TEST_CASE("A scene is pooled over its seeds, with the geometric mean of their ratios") {
    std::vector<row> rows;
    for (std::uint64_t repeat = 0; repeat < 3; ++repeat)
        for (const auto& [seed, slower] : {std::pair(1, 2.0), std::pair(20, 8.0)}) {
            rows.push_back(with_seed(repeat_of("std", repeat, 1), seed));
            rows.push_back(with_seed(repeat_of("insertion", repeat, slower), seed));
            rows.back().contacts = 5;
        }
    rows.back().status = "inexact";
    rows.back().false_negatives = 2;
    rows.back().false_positives = 0;
    const auto scenes = aabblab::summarise(rows);
    REQUIRE(scenes.size() == 1);
    CHECK(scenes[0].scene == without_seed(rows[0].scene));
    CHECK(scenes[0].seeds == std::vector<std::uint64_t>{1, 20});
    CHECK(scenes[0].digest.empty());
    const aabblab::candidate_summary& line = scenes[0].candidates[1];
    CHECK(std::abs(line.ratio.value_or(0) - 4) < 1e-12);
    // Two seeds are too few for an interval.
    CHECK_FALSE(line.ratio_interval.has_value());
    CHECK(line.pairs == 2 * 1234567);
    CHECK(line.contacts == 10);
    CHECK(line.repeats == 6);
    CHECK(line.ms_per_frame->median == 2.5);
}

TEST_CASE("One inexact seed makes a line inexact, with the false negatives and positives of all seeds") {
    row first = with_seed(repeat_of("std", 0, 1), 1);
    row second = with_seed(repeat_of("std", 0, 1), 2);
    for (row* r : {&first, &second}) {
        r->status = "inexact";
        r->false_negatives = 2;
        r->false_positives = 1;
    }
    second.status = "exact";
    second.false_negatives = second.false_positives = 0;
    for (const auto& rows : {std::vector<row>{first, second}, std::vector<row>{second, first}}) {
        const auto scene = aabblab::summarise(rows)[0];
        CHECK(scene.candidates[0].status == "inexact");
        CHECK(column_of(aabblab::table_of(scene), "result") == texts{"-2 +1"});
    }
}

TEST_CASE("The table of counts has counts per frame and copies per object") {
    row counted = repeat_of("std", 0, 1);
    counted.counts[static_cast<std::size_t>(aabb::work::comparisons)] = 300;
    counted.counts[static_cast<std::size_t>(aabb::work::subset_copies)] = 45;
    counted.bytes[0] = 2048;
    row again = with_seed(counted, 2);
    again.counts[static_cast<std::size_t>(aabb::work::comparisons)] = 100;
    again.bytes[0] = 4096;
    const row engine = engine_row(1);
    const auto scene = aabblab::summarise(std::vector<row>{counted, engine, again})[0];
    REQUIRE(aabblab::to_csv(aabblab::counts_table_of(scene)) ==
            "#,composition,comparisons,subset copies,copies per object,KiB projections\n"
            "1,std + one_axis,100,22.5,2.250,4.0\n");
    REQUIRE(aabblab::counts_table_of(aabblab::summarise(std::vector<row>{engine})[0]).columns.empty());
}

TEST_CASE("A single composition is named in the table, or above it if its name is long") {
    const row engine = engine_row(1);
    for (const auto& [sort, shown] : {std::pair("std", "std + one_axis"),
                                      std::pair("shell:gaps=ciura,and=what_more_there_is", "this composition")}) {
        const auto scene = aabblab::summarise(std::vector<row>{repeat_of(sort, 0, 2), engine})[0];
        CHECK(column_of(aabblab::table_of(scene), "composition") == texts{"cgal", shown});
        const std::string heading = aabblab::heading_of(scene);
        INFO(heading);
        CHECK(holds(heading, "\nthis composition: sort " + std::string(sort) + ", sweep one_axis\n"));
        CHECK(holds(heading, "\nbaseline: " + std::string(shown) + "\n"));
    }
}

TEST_CASE("A table ranks exact lines by time, then inexact ones, then those without times") {
    std::vector<row> rows;
    for (const auto& [sort, ms] :
         {std::pair("slow", 10.0), std::pair("wrong", 1.0), std::pair("untimed", 3.0), std::pair("fast", 2.0)})
        rows.push_back(repeat_of(sort, 0, ms));
    rows[1].status = "inexact";
    rows[1].false_negatives = 3;
    rows[1].false_positives = 5;
    rows[2].first_ms = rows[2].update_ms = rows[2].search_ms = rows[2].detect_ms = std::nullopt;
    const auto scene = aabblab::summarise(rows)[0];
    const auto t = aabblab::table_of(scene);
    CHECK(column_of(t, "sort") == texts{"fast", "slow", "wrong", "untimed"});
    CHECK(column_of(t, "ratio") == texts{"0.20", "1.00", "0.10", "-"});
    CHECK(column_of(t, "result") == texts{"exact", "exact", "-3 +5", "exact"});
    CHECK(holds(aabblab::heading_of(scene),
                "in ascending order of ratio, exact results before inexact ones\nratio: ms/frame relative to"));
    CHECK(holds(aabblab::heading_of(scene), " confidence interval\nbaseline: slow\n"));
    CHECK(holds(aabblab::heading_of(scene), "all candidates, over all frames: 1,234,567 pairs of boxes\n"));
    CHECK(holds(aabblab::heading_of(scene), "a result -3 +5 has 3 false negatives and 5 false positives\n"));
    rows[1].false_negatives = 12;
    rows[1].false_positives = 0;
    CHECK(holds(aabblab::heading_of(aabblab::summarise(rows)[0]),
                "a result -12 +0 has 12 false negatives and 0 false positives\n"));
    CHECK(std::ranges::find(t.columns, "pairs", &aabblab::column::name) == t.columns.end());
}

TEST_CASE("The table over all scenes has the geometric mean and range of ratios, wins and regret") {
    std::vector<row> rows;
    for (const auto& [scene, ms] : {std::pair("a", 0.5), std::pair("b", 8.0)})
        for (const auto& [sort, time] : {std::pair("std", 1.0), std::pair("insertion", ms)}) {
            rows.push_back(repeat_of(sort, 0, time));
            rows.back().scene.kind = scene;
        }
    rows.push_back(engine_row(4));
    rows.back().scene.kind = "a";
    const auto scenes = aabblab::summarise(rows);
    CHECK(aabblab::to_csv(aabblab::overall_table_of(scenes)) ==
          "#,sort,ratio,least,greatest,scenes,fastest in,regret,worst\n"
          "1,std,1.00,1.00,1.00,2,1,1.50,2.00\n"
          "2,insertion,2.00,0.50,8.00,2,1,4.50,8.00\n"
          "3,cgal,4.00,4.00,4.00,1,0,8.00,8.00\n");
}

TEST_CASE("Tables are escaped for TeX and HTML") {
    REQUIRE(holds(aabblab::to_tex({{{"a_b", false}}, {{"50%"}}}), "a\\_b \\\\\n\\midrule\n50\\% \\\\"));
    REQUIRE(holds(aabblab::to_html({{{"a", false}}, {{"<x>"}}}), "<td>&lt;x&gt;</td>"));
}

TEST_CASE("The contents of a page link to its sections, and later sections back to them") {
    aabblab::page out("A page");
    out.heading("Before", "before");
    out.contents();
    out.heading("A & B", "after");
    out.heading("Unlisted");
    const std::string html = out.html();
    CHECK(
        holds(html,
              "<h2 id=\"before\">Before</h2>\n<nav id=\"contents\"><h2>Contents</h2>\n"
              "<ul>\n<li><a href=\"#before\">Before</a></li>\n<li><a href=\"#after\">A &amp; B</a></li>\n</ul></nav>\n"
              "<h2 id=\"after\">A &amp; B <a class=\"up\" href=\"#contents\">Contents</a></h2>\n"));
    CHECK(out.markdown() ==
          "<a id=\"before\"></a>\n\n## Before\n\n<a id=\"contents\"></a>\n\n## Contents\n\n- [Before](#before)\n"
          "- [A & B](#after)\n\n<a id=\"after\"></a>\n\n## A & B\n\n## Unlisted\n\n");
    aabblab::page plain("A page");
    plain.heading("Only", "only");
    CHECK_FALSE(holds(plain.html(), "contents"));
    CHECK(plain.markdown() == "<a id=\"only\"></a>\n\n## Only\n\n");
}

TEST_CASE("A table fits the given width: it drops spare columns, replaces long names or splits into blocks") {
    const aabblab::table t{{{"sort", false}, {"tree", false}, {"ms"}, {"spare", true, 1}, {"first", true, 2}},
                           {{"insertion", "canonical", "1", "2", "3"}, {"std", "compressed:build=sah", "4", "5", "6"}}};
    CHECK(aabblab::to_text(t, 80) == aabblab::to_text(t));
    CHECK(aabblab::to_text(t, 45) ==
          "sort       tree                  ms  spare\n"
          "insertion  canonical              1      2\n"
          "std        compressed:build=sah   4      5\n"
          "left out to fit the width: first\n");
    // If that is not enough, numbers replace long names.
    CHECK(aabblab::to_text(t, 30) ==
          "#  ms  spare  first\n"
          "1   1      2      3\n"
          "2   4      5      6\n"
          "\n"
          "#  sort + tree\n"
          "1  insertion + canonical\n"
          "2  std +\n"
          "   compressed:build=sah\n");
    CHECK(aabblab::to_text(t, 13).starts_with("#  ms  spare\n"));
    CHECK(aabblab::to_text(t, 13).ends_with("left out to fit the width: first\n"));
    CHECK(aabblab::to_text(t, 10).ends_with("left out to fit the width: first, spare\n"));
    // Existing row numbers are kept.
    aabblab::table ranked{{{aabblab::row_number}, {"sort", false}, {"ms"}}, {{"3", "a sort of many words", "1"}}};
    CHECK(aabblab::to_text(ranked, 20) == "#  ms\n3   1\n\n3  a sort of many words\n");
    // A table that has only names is not narrowed.
    const aabblab::table names{{{"sort", false}, {"tree", false}}, {{"insertion", "canonical"}}};
    CHECK(aabblab::to_text(names, 10) == aabblab::to_text(names));
    // Short names are kept, and spare columns dropped.
    aabblab::table short_names = t;
    for (auto& cells : short_names.rows) cells[1] = "t";
    CHECK(aabblab::to_text(short_names, 30) ==
          "sort       tree  ms  spare\n"
          "insertion  t      1      2\n"
          "std        t      4      5\n"
          "left out to fit the width: first\n");
    aabblab::table wide{{{"sort", false}}, {{"insertion"}, {"std"}}};
    for (int k = 0; k < 5; ++k) {
        wide.columns.push_back({"column " + std::to_string(k)});
        for (auto& cells : wide.rows) cells.push_back(std::to_string(k));
    }
    CHECK(aabblab::to_text(wide, 40) ==
          "sort       column 0  column 1  column 2\n"
          "insertion         0         1         2\n"
          "std               0         1         2\n"
          "\n"
          "sort       column 3  column 4\n"
          "insertion         3         4\n"
          "std               3         4\n");
}

TEST_CASE_METHOD(in_folder, "run prints narrow tables, prints counts on request, and writes all lines to summary.csv") {
    const std::string config = folder.write("a.toml",
                                            "name = \"a\"\nseed = [1, 2]\nengines = [\"cgal\"]\n[[scene]]\n"
                                            "kind = [\"brownian\", \"still\"]\nobjects = 50\nframes = 2\n[compose]\n"
                                            "sort = [\"insertion\", \"shell:gaps=ciura\"]\n"
                                            "partition = [\"none\", \"axial_cut:axes=3,segments=30,limit=off\"]\n"
                                            "[measure]\nrepeats = 2\n");
    const program_result narrow = run_well({"run", config, "--out", folder / "a"});
    const std::string tables = narrow.out.substr(0, narrow.out.find("Every repeat"));
    check_narrow(tables);
    CHECK_FALSE(holds(tables, "box tests"));
    CHECK(holds(tables, "pooled over 2 seeds"));
    CHECK(holds(tables, "2 scenes with the baseline insertion + none + one_axis,\n"));

    const program_result counted = run_well({"run", config, "--counts", "--out", folder / "b"});
    CHECK(holds(counted.out, "box tests"));
    check_narrow(counted.out.substr(0, counted.out.find("Every repeat")));

    const auto summary = csv_rows(folder / "a/summary.csv");
    REQUIRE(summary.size() == 2 * (4 + 1));
    double slowest = 0;
    for (std::size_t i = 0; i < summary.size(); ++i) {
        const std::map<std::string, std::string>& line = summary[i];
        CHECK(line.at("rank") == std::to_string(i % 5 + 1));
        CHECK(line.at("seeds") == "1 2");
        CHECK(line.at("scene") == (i < 5 ? "brownian" : "still"));
        CHECK(line.at("repeats") == "4");
        CHECK(line.at("status") == "exact");
        if (i % 5 == 0) slowest = 0;
        CHECK(std::stod(line.at("ratio")) >= slowest);
        slowest = std::stod(line.at("ratio"));
    }
    // A rejected run keeps the summary, and a resumed one writes it again.
    REQUIRE(run_program({"run", config, "--out", folder / "a"}).status == 2);
    const std::string before = bytes_of_file(folder / "a/summary.csv");
    run_well({"run", config, "--resume", "--out", folder / "a"});
    CHECK(bytes_of_file(folder / "a/summary.csv") == before);
}
