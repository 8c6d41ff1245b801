module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

module aabblab.claims;

import aabb.base;
import aabb.registry;
import aabblab.conditions;
import aabblab.figures;
import aabblab.files;
import aabblab.json;
import aabblab.metrics;
import aabblab.numbers;
import aabblab.statistics;
import aabblab.tables;

namespace aabblab {

namespace {

/// Nanoseconds of each elementary test, by name, process and repetition.
using test_times = std::map<std::string, std::vector<std::vector<double>>>;

void read_process(const std::filesystem::path& file, std::size_t process, test_times& times) {
    const std::string otherwise = "is not a result of Google Benchmark (remove it to measure again)";
    const json_value results(file.string(), text_of_file(file), otherwise);
    if (!results.has("benchmarks")) throw aabb::input_error(file.string() + " " + otherwise);
    for (const json_value& one : results.objects("benchmarks")) {
        if (one.text("run_type") != "iteration") continue;
        const std::string unit = one.text("time_unit").value_or("ns");
        const json_value time = one.needed("cpu_time");
        const double ns = time.number() * (unit == "us" ? 1e3 : unit == "ms" ? 1e6 : 1);
        // Ratios are formed of it.
        if (!(ns > 0)) time.fail("must be more than 0");
        // The names of repetitions end alike; "run_name" has none of that.
        auto& processes = times[one.needed(one.has("run_name") ? "run_name" : "name").text()];
        processes.resize(std::max(processes.size(), process + 1));
        processes[process].push_back(ns);
    }
}

/// FOLDER/c6/process-0.json, …
test_times read_tests(const std::filesystem::path& folder) {
    test_times times;
    for (std::size_t process = 0;; ++process) {
        const std::filesystem::path file = folder / "c6" / ("process-" + std::to_string(process) + ".json");
        if (!std::filesystem::exists(file)) return times;
        read_process(file, process, times);
    }
}

cells ratios_of(const test_times& times, const std::string& arm, const std::string& base) {
    const auto a = times.find(arm);
    const auto b = times.find(base);
    if (a == times.end() || b == times.end()) return {0, 0};
    const std::size_t processes = std::min(a->second.size(), b->second.size());
    cells all(processes, 1);
    for (std::size_t process = 0; process < processes; ++process)
        for (std::size_t i = 0; i < std::min(a->second[process].size(), b->second[process].size()); ++i)
            all.add(process, 0, std::log(a->second[process][i] / b->second[process][i]));
    return all;
}

quartiles spread_of(const std::vector<std::vector<double>>& processes) {
    std::vector<double> all;
    for (const std::vector<double>& one : processes) all.insert(all.end(), one.begin(), one.end());
    return quartiles_of(all);
}

/// The leaf of A that is tested as it is, in place of one of B that is carried into A's frame.
constexpr std::string_view in_place = "/frame:a";

table table_of(const test_times& times) {
    table t{{{"test", false}, {"ns"}, {"quartiles"}, {"over a box test"}}, {}};
    for (const auto& [name, processes] : times) {
        const quartiles q = spread_of(processes);
        const std::string frame = name.ends_with(in_place) ? std::string(in_place) : "";
        const cells ratios = ratios_of(times, name, "test/box" + frame);
        t.rows.push_back(
            {name, three_digits(q.median), three_digits(q.low) + " to " + three_digits(q.high),
             ratios.empty() ? "-" : ratio_text(endpoint_of({{}, {bootstrap(ratios)}}, expectation::not_more))});
    }
    return t;
}

figure figure_of(const test_times& times) {
    figure f{"c6",
             "Nanoseconds of one elementary test, on the pairs that a walk through two trees meets; medians and "
             "quartiles.",
             {"test", false, {}},
             {"time a test (ns)", false, {}},
             {},
             {}};
    series carried{"what is tested of B is carried into A's frame", series_style::points, {}};
    series of_a{"nothing is carried", series_style::points, {}};
    for (const auto& [name, processes] : times) {
        if (name.ends_with(in_place)) continue;
        const auto place = static_cast<double>(f.x.names.size());
        f.x.names.emplace_back(place, name.substr(name.find('/') + 1));
        const auto add = [&](series& to, const std::string& test) {
            const auto found = times.find(test);
            if (found == times.end()) return;
            const quartiles q = spread_of(found->second);
            to.points.push_back({place, q.median, q.low, q.high});
        };
        add(carried, name);
        add(of_a, name + std::string(in_place));
    }
    f.lines = {carried, of_a};
    return f;
}

}  // namespace

draft triangle_for_box(const measurements& m) {
    draft made;
    claim_result& claim = made.claim;
    claim.id = "C6";
    claim.claim = "Testing the triangle of a leaf costs what testing its box costs";
    claim.measured =
        "time of a triangle-box test over that of a box test: of a box that is carried into the other frame and boxed "
        "anew, and of one that stays rotated, by six axes or all fifteen; in whole queries, of leafless over canonical";
    claim.expected = expectation::not_more;
    claim.experiments = {"figure2"};
    const test_times times = read_tests(m.folder());
    const auto add_test = [&](const std::string& test, const std::string& over, const std::string& frame,
                              const std::string& subject, bool primary) {
        const cells ratios = ratios_of(times, "test/" + test + frame, "test/" + over + frame);
        if (ratios.empty()) return;
        candidate c;
        c.where = {{"quantity", "one test"},
                   {"leaf_test", test},
                   {"over", over},
                   {"leaf of", frame.empty() ? "B, carried into A's frame" : "A"}};
        c.log_ratios = {bootstrap(ratios)};
        c.primary = primary;
        c.source = "c6: test/" + test + frame + " over test/" + over + frame;
        made.candidates.push_back(told(std::move(c), subject));
    };
    add_test("triangle_box", "box", "", "for a leaf's triangle against its box, made anew after the motion", true);
    add_test("triangle_box", "rotated_box_6", "", "against a box that stays rotated, by six axes", true);
    add_test("triangle_box", "rotated_box_15", "", "against that, by all fifteen", true);
    add_test("triangle_box_moller", "box", "", "by M\u00f6ller's original against a box made anew", false);
    add_test("triangle_box_moller", "rotated_box_15", "", "by M\u00f6ller's original against fifteen axes", false);
    add_test("triangle_aabb", "box", "", "for a box made of the triangle on the fly", false);
    for (const char* test : {"triangle_box", "triangle_aabb"})
        add_test(test, "box", std::string(in_place), "where nothing is carried", false);
    for (const condition& c : m.of("figure2"))
        for (const char* test : {"triangle_box", "triangle_aabb", "none"}) {
            candidate one = candidate_of(c, {{kind::tree, std::string("leafless:leaf_test=") + test}},
                                         {{kind::tree, "canonical"}}, "detect_cpu_ms");
            one.where = {{"quantity", "a query"}, {"leaf_test", test}, {"meshes", mesh_of(c)}};
            made.candidates.push_back(told(std::move(one), std::string(test) == "triangle_box" ? "in whole queries"
                                                           : std::string(test) == "triangle_aabb"
                                                               ? "in whole queries with boxes made on the fly"
                                                               : "in whole queries without a test at leaves"));
        }
    claim.tables.push_back({"tests",
                            "Time of one elementary test, and its ratio to that of a box test, in either frame.",
                            table_of(times)});
    claim.figures.push_back(figure_of(times));
    return made;
}

}  // namespace aabblab
