#include <catch2/catch_test_macros.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

import aabb;
import aabblab.report;
import aabblab.results;

using aabblab::row;

namespace {

row repeat_of(const std::string& sort, std::uint64_t repeat, double search_ms) {
    row r;
    r.experiment = "test";
    r.scene = "brownian";
    r.scene_parameters = "objects=10, \"quoted\"";
    r.objects = 10;
    r.frames = 3;
    r.name.sort = sort;
    r.name.sweep = "one_axis";
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

}  // namespace

TEST_CASE("Ratios are taken within a repeat") {
    std::vector<row> rows;
    for (std::uint64_t repeat = 0; repeat < 7; ++repeat) {
        // The machine slows down; the second stays twice as slow as the first.
        const double slow = 1 + static_cast<double>(repeat);
        rows.push_back(repeat_of("std", repeat, slow));
        rows.push_back(repeat_of("insertion", repeat, 2 * slow));
    }
    const aabblab::summary_line line = aabblab::summarise(rows)[0].lines[1];
    REQUIRE(line.ratio.value_or(0) == 2);
    REQUIRE(line.ratio_interval->low == 2);
    REQUIRE(line.ratio_interval->high == 2);
}

TEST_CASE("The table of counts has what was counted, a frame, and copies an object") {
    row counted = repeat_of("std", 0, 1);
    counted.counts[static_cast<std::size_t>(aabb::work::comparisons)] = 300;
    counted.counts[static_cast<std::size_t>(aabb::work::subset_copies)] = 45;
    counted.bytes[0] = 2048;
    row engine = repeat_of("", 0, 1);
    engine.name = {};
    engine.name.engine = "cgal";
    const auto scene = aabblab::summarise(std::vector<row>{counted, engine})[0];
    REQUIRE(aabblab::to_csv(aabblab::counts_table_of(scene, aabblab::number_style::plain)) ==
            "composition,comparisons,subset copies,copies an object,bytes projections\n"
            "this composition,150.000,22.500,2.250,2048\n");
    REQUIRE(aabblab::counts_table_of(aabblab::summarise(std::vector<row>{engine})[0], aabblab::number_style::plain)
                .columns.empty());
}


TEST_CASE("A summary has medians per frame after frame 0, ratios to the first line, and names what differs") {
    const std::vector<row> rows{repeat_of("std", 0, 2), repeat_of("insertion", 0, 8), repeat_of("std", 1, 4),
                                repeat_of("insertion", 1, 16)};
    const auto scenes = aabblab::summarise(rows);
    REQUIRE(scenes.size() == 1);
    REQUIRE(scenes[0].common == "sweep one_axis");
    REQUIRE(scenes[0].lines.size() == 2);
    REQUIRE(scenes[0].lines[0].label == "std");
    REQUIRE(scenes[0].lines[0].ms_a_frame->median == 1.5);
    REQUIRE(scenes[0].lines[1].ratio.value_or(0) == 4.0);
    const auto shown = aabblab::table_of(scenes[0], aabblab::number_style::grouped);
    REQUIRE(aabblab::to_text(shown).find("1,234,567") != std::string::npos);
    REQUIRE(aabblab::to_csv(aabblab::table_of(scenes[0], aabblab::number_style::plain)).find("1234567") !=
            std::string::npos);
    REQUIRE(aabblab::to_tex({{{"a_b", false}}, {{"50%"}}}).find("a\\_b \\\\\n\\hline\n50\\% \\\\") !=
            std::string::npos);
    REQUIRE(aabblab::to_html({{{"a", false}}, {{"<x>"}}}).find("<td>&lt;x&gt;</td>") != std::string::npos);
}

TEST_CASE("Tables fit a terminal of 120 columns and line up") {
    std::vector<row> rows;
    for (const char* sort : {"insertion", "std"}) {
        row r = repeat_of(sort, 0, 12345);
        r.name.partition = sort == std::string("std") ? "none" : "uniform_grid";
        r.name.tree = sort == std::string("std") ? "canonical" : "leafless";
        r.contacts = 123456;
        r.bytes[0] = 12345678;
        rows.push_back(r);
    }
    const std::string text =
        aabblab::to_text(aabblab::table_of(aabblab::summarise(rows)[0], aabblab::number_style::grouped));
    for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) REQUIRE(text.find('\n', at) - at <= 120);
}
