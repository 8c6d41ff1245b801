// Runs the micro-benchmark program.

#include "../experiments/program_json.hpp"

import aabb.registry;
import aabb.strategies;

namespace {

template <class... Partitions>
std::vector<std::string> cutting_partitions(aabb::type_list<Partitions...>) {
    std::vector<std::string> names;
    ((aabb::CuttingPartition<Partitions> ? names.emplace_back(Partitions::name) : names.emplace_back()), ...);
    std::erase(names, "");
    return names;
}

/// The strategy in the name of a benchmark, between its stage and its case.
aabb::strategy_choice strategy_of(const std::string& benchmark) {
    const std::size_t begin = benchmark.find('/') + 1;
    return aabb::parse_strategy(benchmark.substr(begin, benchmark.find('/', begin) - begin));
}

/// The JSON reports of the benchmarks that match the filter.
nlohmann::json reported(const std::string& filter) {
    return json_of(
        {"--benchmark_filter=" + filter, "--benchmark_min_time=0.001", "--benchmark_format=json"})["benchmarks"];
}

}  // namespace

TEST_CASE("Every sort, partition and sweep has a benchmark with its name on the command line") {
    std::vector<std::string> listed = lines_of(run_well({"--benchmark_list_tests"}).out);
    for (const aabb::strategy_kind kind :
         {aabb::strategy_kind::sort, aabb::strategy_kind::partition, aabb::strategy_kind::sweep}) {
        const std::string stage = std::string(name_of(kind)) + "/";
        std::vector<std::string> measured;
        for (const std::string& benchmark : listed) {
            if (!benchmark.starts_with(stage)) continue;
            INFO(benchmark);
            REQUIRE_NOTHROW(require_known(kind, strategy_of(benchmark)));
            measured.push_back(strategy_of(benchmark).name);
        }
        const bool cuts = kind == aabb::strategy_kind::partition;
        for (const std::string& name : cuts ? cutting_partitions(aabb::partitions{}) : strategy_names(kind)) {
            INFO(stage << name);
            REQUIRE(std::ranges::find(measured, name) != measured.end());
        }
    }
    for (const char* benchmark :
         {"sort/shell:gaps=ciura/n:10000/displacement:0.1/manual_time", "partition/axial_cut:axes=3,limit=off/n:1000",
          "sweep/incremental/n:1000/displacement:0.01"})
        REQUIRE(std::ranges::find(listed, benchmark) != listed.end());
    std::ranges::sort(listed);
    REQUIRE(std::ranges::adjacent_find(listed) == listed.end());
}

TEST_CASE("Every test of local detection has a benchmark, with and without the transform into A's frame") {
    const auto listed = lines_of(run_well({"--benchmark_list_tests", "--benchmark_filter=^test/"}).out);
    const std::string triangle = "test/triangle/";
    const auto triangle_test_of = [](const std::string& benchmark) {
        return strategy_of(benchmark.substr(std::string("test/").size()));
    };
    std::vector<std::string> expected = {"test/box",
                                         "test/rotated_box_6",
                                         "test/rotated_box_15",
                                         "test/triangle_box",
                                         "test/triangle_box_moller",
                                         "test/triangle_aabb",
                                         triangle + "moller:epsilon=scaled,division=yes"};
    for (const std::string& name : strategy_names(aabb::strategy_kind::triangle)) {
        const auto is_of_test = [&](const std::string& benchmark) {
            return benchmark.starts_with(triangle) && triangle_test_of(benchmark).name == name;
        };
        const auto first = std::ranges::find_if(listed, is_of_test);
        INFO(name);
        REQUIRE(first != listed.end());
        expected.push_back(*first);
    }
    for (const std::string& name : expected)
        for (const char* frame : {"", "/frame:a"}) {
            INFO(name << frame);
            REQUIRE(std::ranges::count(listed, name + frame) == 1);
        }
    for (const std::string& benchmark : listed)
        if (benchmark.starts_with(triangle)) {
            INFO(benchmark);
            REQUIRE_NOTHROW(require_known(aabb::strategy_kind::triangle, triangle_test_of(benchmark)));
        }
}

TEST_CASE("Tests of local detection report a time and a reproducible share of hits") {
    const auto benchmarks = reported("^test/");
    const auto again = reported("^test/");
    REQUIRE(benchmarks.size() >= 20);
    REQUIRE(again.size() == benchmarks.size());
    const auto hits = [&](const std::string& name) {
        for (const auto& benchmark : benchmarks)
            if (benchmark["name"] == name) return benchmark["hits"].get<double>();
        return -1.0;
    };
    for (std::size_t i = 0; i < benchmarks.size(); ++i) {
        INFO(benchmarks[i].dump());
        CHECK(benchmarks[i].value("real_time", 0.0) > 0);
        CHECK(benchmarks[i].value("cpu_time", 0.0) > 0);
        CHECK(benchmarks[i].value("time_unit", "") == "ns");
        CHECK(benchmarks[i].value("hits", 0.0) > 0);
        CHECK(benchmarks[i].value("hits", 1.0) < 1);
        CHECK(benchmarks[i]["hits"] == again[i]["hits"]);
        // Möller's original reports the share of hits that it keeps; all other tests must not lose any.
        const bool may_lose = benchmarks[i].value("name", "").starts_with("test/triangle_box_moller");
        CHECK((benchmarks[i].value("kept", -1.0) >= 0) == may_lose);
    }
    // The box of a triangle contains it, and the rotated box of a leaf contains that of the rotated triangle.
    for (const std::string frame : {"", "/frame:a"}) {
        INFO(frame);
        CHECK(hits("test/triangle_box" + frame) < hits("test/triangle_aabb" + frame));
        CHECK(hits("test/triangle_aabb" + frame) <= hits("test/box" + frame));
        // Each further axis separates some boxes, but none whose triangles intersect.
        CHECK(hits("test/rotated_box_6" + frame) < hits("test/box" + frame));
        CHECK(hits("test/rotated_box_15" + frame) < hits("test/rotated_box_6" + frame));
        CHECK(hits("test/triangle_box_moller" + frame) <= hits("test/triangle_box" + frame));
    }
    // A rotated box contains its triangle; the box of B's node in A's frame is larger than the rotated one.
    CHECK(hits("test/triangle_box") < hits("test/rotated_box_15"));
    // Without rotation the two boxes are the same.
    CHECK(hits("test/triangle_aabb/frame:a") == hits("test/box/frame:a"));
    CHECK(hits("test/triangle/exact/frame:a") == hits("test/triangle/exact"));
}

TEST_CASE("Benchmarks report their counters") {
    const auto benchmarks = reported(
        "/(insertion|axial_cut:axes=2,limit=on|incremental|one_axis:axis=x)"
        "/n:1000(/displacement:0.1)?(/manual_time)?$");
    REQUIRE(benchmarks.size() == 4);
    const auto counters = [&](std::size_t i, const std::vector<const char*>& names) {
        INFO(benchmarks[i].dump());
        for (const char* name : names) CHECK(benchmarks[i].value(name, 0.0) > 0);
    };
    counters(0, {"real_time", "inversions/n", "comparisons/n", "moves/n"});
    counters(1, {"real_time", "copies/n", "subsets", "segments_wanted", "segments_got", "bytes"});
    counters(2, {"real_time", "box_tests/n", "pairs/n"});
    counters(3, {"real_time", "box_tests/n", "pairs/n"});
}

TEST_CASE("Every stage that decides triangles at poses has a benchmark of each case, and exact ones decide all") {
    std::map<std::string, double> decided;
    for (const auto& run : reported("^posed/")) {
        CHECK(run["pairs"] > 500);
        decided[run["name"]] = run["decided"];
    }
    CHECK(decided.size() == 12);
    for (const std::string of : {"crossing", "apart:1e-9", "flush", "gears"}) {
        CHECK(decided.at("posed/exact/" + of) == 1);
        CHECK(decided.at("posed/integers/" + of) == 1);
    }
    CHECK(decided.at("posed/filter_in_double/crossing") > 0.9);
    CHECK(decided.at("posed/filter_in_double/flush") == 0);
}

TEST_CASE("Distances are timed in turn with those of other libraries, and compared") {
    std::vector<std::string> measured;
    for (const auto& run : reported("^(distance|within)/.*/spheres")) {
        INFO(run.dump());
        const std::string name = run["name"];
        measured.push_back(name.substr(0, name.find("/spheres")));
        CHECK(run["real_time"] > 0);
        CHECK(run["ours_ms"] > 0);
        CHECK(run["ratio"] > 0);
        if (name.starts_with("within/")) {
            CHECK(run["pairs"] > 100);
        } else {
            CHECK_BETWEEN(-1e-9, run["wrong"].get<double>(), 1 + 1e-9);
            // Where two edges are nearest, the vertices of CGAL and Embree are about as far as triangles are long.
            CHECK(run["worst"] < 0.05);
        }
    }
    // CGAL is needed to build, others may be absent.
    for (const char* name : {"distance/cgal", "within/cgal"}) CHECK(std::ranges::count(measured, name) == 1);
}

TEST_CASE("Every build has a benchmark that reports the speedup by two threads and its upper bound") {
    std::vector<std::string> measured;
    for (const auto& benchmark : reported("^build/.*/noise_sphere")) {
        INFO(benchmark.dump());
        measured.push_back(strategy_of(benchmark["name"]).name);
        CHECK(benchmark.value("real_time", 0.0) > 0);
        CHECK(benchmark.value("two_threads", 0.0) > 0);
        CHECK(benchmark.value("two_builds", 0.0) > 0);
    }
    CHECK(sorted(measured) == sorted(strategy_names(aabb::strategy_kind::build)));
}

TEST_CASE("Whether points lie inside a surface is timed beside CGAL, with the same result") {
    std::map<std::string, double> inside;
    for (const auto& run : reported("^side/.*/query/noise_sphere")) inside[run["name"]] = run.value("inside", 0.0);
    CHECK(inside.size() == 2);
    const double share = inside["side/cgal/query/noise_sphere:triangles=20000"];
    CHECK(inside["side/enclosure/query/noise_sphere:triangles=20000"] == share);
    CHECK_BETWEEN(0.2, share, 0.8);
    CHECK(reported("^side/.*/build/noise_sphere").size() == 2);
}

TEST_CASE("Invalid arguments of benchmarks are rejected with status 2") {
    for (const char* argument : {"--benchmark_filter=sotr/", "--benchmrk", "--benchmark_format=xml"}) {
        const program_result result = run_program({argument});
        INFO(argument << ": " << result.err);
        CHECK(result.status == 2);
        CHECK(result.out.empty());
        CHECK(lines_of(result.err).size() == 1);
    }
    run_well({"--help"});
}
