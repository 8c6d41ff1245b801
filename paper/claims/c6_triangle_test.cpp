module aabblab.claims;

import aabb.base;
import aabblab.files;
import aabblab.json;
import aabblab.numbers;

namespace aabblab {

namespace {

/// Nanoseconds of each elementary test, by name, process and repetition.
using test_times = std::map<std::string, std::vector<std::vector<double>>>;

/// Reads the results of one process of Google Benchmark into `times`, in ns by test, process and repetition. Its
/// aggregates (mean, median and so on) are skipped.
void read_process(const std::filesystem::path& file, std::size_t process, test_times& times) {
    const std::string otherwise = "is not a result of Google Benchmark (remove it to measure again)";
    const json_value results(file.string(), text_of_file(file), otherwise);
    if (!results.has("benchmarks")) throw aabb::input_error(file.string() + " " + otherwise);
    for (const json_value& run : results.objects("benchmarks")) {
        if (run.text("run_type") != "iteration") continue;
        const std::string unit = run.text("time_unit").value_or("ns");
        const json_value time = run.needed("cpu_time");
        const double ns = time.number() * (unit == "us" ? 1e3 : unit == "ms" ? 1e6 : 1);
        // Its logarithm is taken for ratios.
        if (!(ns > 0)) time.fail("must be more than 0");
        // "run_name" lacks the suffix of repetitions.
        auto& processes = times[run.needed(run.has("run_name") ? "run_name" : "name").text()];
        processes.resize(std::max(processes.size(), process + 1));
        processes[process].push_back(ns);
    }
}

/// Reads the times of all processes: FOLDER/c6/process-0.json, process-1.json, … up to the first that is missing.
test_times read_tests(const std::filesystem::path& folder) {
    test_times times;
    for (std::size_t process = 0;; ++process) {
        const std::filesystem::path file = folder / "c6" / ("process-" + std::to_string(process) + ".json");
        if (!std::filesystem::exists(file)) return times;
        read_process(file, process, times);
    }
}

/// Logarithms of the time of one test over that of another, by process and repetition; empty if either was not
/// measured. The tests run without a seed, so each process has one cell.
cells ratios_of(const test_times& times, const std::string& test, const std::string& other_test) {
    const auto a = times.find(test);
    const auto b = times.find(other_test);
    if (a == times.end() || b == times.end()) return {0, 0};
    const std::size_t processes = std::min(a->second.size(), b->second.size());
    cells log_ratios(processes, /*seeds=*/1);
    for (std::size_t process = 0; process < processes; ++process)
        for (std::size_t i = 0; i < std::min(a->second[process].size(), b->second[process].size()); ++i)
            log_ratios.add(process, /*seed=*/0, std::log(a->second[process][i] / b->second[process][i]));
    return log_ratios;
}

quartiles spread_of(const std::vector<std::vector<double>>& processes) {
    std::vector<double> times;
    for (const std::vector<double>& process : processes) times.insert(times.end(), process.begin(), process.end());
    return quartiles_of(times);
}

/// The suffix of tests of a leaf of A, which needs no transformation, unlike a leaf of B.
constexpr std::string_view frame_a_suffix = "/frame:a";
/// The factor's value for leaves of B.
constexpr const char* b_in_frame_of_a = "B, carried into A's frame";

/// The times of all elementary tests, with their ratios to a box test in the same frame of reference.
table table_of(const test_times& times) {
    table t = empty_table({"test"}, {"ns", "quartiles", "over a box test"});
    for (const auto& [name, processes] : times) {
        const quartiles q = spread_of(processes);
        const std::string frame = name.ends_with(frame_a_suffix) ? std::string(frame_a_suffix) : "";
        const cells ratios = ratios_of(times, name, "test/box" + frame);
        t.rows.push_back({name, three_digits(q.median), three_digits(q.low) + " to " + three_digits(q.high),
                          ratios.empty() ? "-" : ratio_cell({.where = {}, .log_ratios = {bootstrap(ratios)}})});
    }
    return t;
}

/// Median times of all tests. A leaf of one tree is tested against a node of the other, in A's frame of reference: a
/// leaf of B is transformed into it first, a leaf of A (`frame_a_suffix`) need not be.
figure figure_of(const test_times& times) {
    figure f{"c6",
             "Time of one elementary test, on the pairs that a traversal of two trees visits; medians and quartiles.",
             {"time per test (ns)"},
             {"test"}};
    series transformed{"with the transformation from B's frame to A's", series_style::points};
    series untransformed{"without a transformation", series_style::points};
    for (const auto& [name, processes] : times) {
        if (name.ends_with(frame_a_suffix)) continue;
        const auto y = -static_cast<double>(f.y.names.size());  // downwards, as in the table
        f.y.names.emplace_back(y, name.substr(name.find('/') + 1));
        const auto add = [&](series& line, const std::string& test) {
            const auto entry = times.find(test);
            if (entry == times.end()) return;
            const quartiles q = spread_of(entry->second);
            line.points.push_back({.x = q.median, .y = y, .x_low = q.low, .x_high = q.high});
        };
        add(transformed, name);
        add(untransformed, name + std::string(frame_a_suffix));
    }
    f.lines = {transformed, untransformed};
    return f;
}

}  // namespace

/// Drafts C6: the time of a triangle-box test over that of a box test, and of whole queries of trees that test the
/// triangles of leaves over those of trees that store and test their boxes.
draft c6_claim(const measurements& m) {
    draft c6{.claim = {
                 .lead = "Testing a leaf's triangle against a box, with its transformation into the other mesh's frame",
                 .experiments = {"figure2"}}};
    const test_times times = read_tests(m.folder());
    const auto add_test = [&](const std::string& test, const std::string& over, const std::string& subject,
                              const std::string& frame = "") {
        const cells ratios = ratios_of(times, "test/" + test + frame, "test/" + over + frame);
        if (ratios.empty()) return;
        c6.add({.where = {{"quantity", "one test"},
                          {"leaf_test", test},
                          {"over", over},
                          {"leaf of", frame.empty() ? b_in_frame_of_a : "A"}},
                .log_ratios = {bootstrap(ratios)},
                .subject = subject,
                .source = "c6: test/" + test + frame + " over test/" + over + frame});
    };
    add_test("triangle_box", "box", "compared with the AABB of its transformed box");
    add_test("triangle_box", "rotated_box_6", "compared with an oriented box on six axes");
    add_test("triangle_box", "rotated_box_15", "compared with an oriented box on all fifteen axes");
    add_test("triangle_box_moller", "box",
             "with M\u00f6ller's original triangle-box test, compared with the AABB of the transformed box");
    add_test("triangle_box_moller", "rotated_box_15",
             "with M\u00f6ller's original triangle-box test, compared with an oriented box on fifteen axes");
    add_test("triangle_aabb", "box",
             "testing the AABB of the transformed triangle, compared with that of the transformed box");
    add_test("triangle_box", "box", "testing the triangle without a transformation, compared with its stored box",
             std::string(frame_a_suffix));
    add_test("triangle_aabb", "box",
             "testing the AABB of the triangle without a transformation, compared with its stored box",
             std::string(frame_a_suffix));
    const std::pair<std::string, const char*> queries[] = {
        {"triangle_box",
         "whole queries that test a leaf's triangle against boxes, compared with those that test its stored box"},
        {"triangle_aabb",
         "whole queries that compute and test a leaf's box, compared with those that test a stored box"},
        {"none", "whole queries that test only the box of a leaf's parent, compared with those that test the leaf's"}};
    for (const condition& c : m.conditions_of("figure2"))
        for (const auto& [test, subject] : queries) {
            endpoint ratio = endpoint_of(c, {{kind::tree, "leafless:leaf_test=" + test}}, {{kind::tree, "canonical"}},
                                         "detect_cpu_ms");
            ratio.where = {{"quantity", "a query"}, {"leaf_test", test}, {"meshes", mesh_of(c)}};
            c6.add(std::move(ratio), subject);
        }
    c6.claim.tables.push_back({"tests",
                               "Time of one elementary test, and its ratio to that of a box test, in either frame.",
                               table_of(times)});
    c6.claim.figures.push_back(figure_of(times));
    return c6;
}

}  // namespace aabblab
