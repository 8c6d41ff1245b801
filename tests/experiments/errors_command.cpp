#include "csv_rows.hpp"

import aabb.registry;
import aabb.triangle.exact;
import aabblab.configs;
import aabblab.errors;
import aabblab.figures;
import aabblab.scenes;
import aabblab.tables;

using aabblab::experiment_size;

namespace {

/// The rejection of a named config with this text.
std::string rejection_of(const std::string& text) {
    return refusal_in<aabb::input_error>(
        [&] { return aabblab::parse_error_study("name = \"e\"\n" + text, "e.toml", experiment_size::full); });
}

const std::string one_curve = "[[curve]]\ntriangle = \"exact\"\n";
const std::string some_pairs = "[[pairs]]\nclass = \"random\"\n";

template <class Real>
std::string digest_of(std::string_view pair_class) {
    std::vector<aabb::triangle_pair<Real>> pairs(500);
    aabblab::pair_source<Real>(pair_class, 1).next(pairs);
    aabb::digest digest;
    for (const aabb::triangle_pair<Real>& p : pairs)
        for (const aabb::triangle3<Real>* t : {&p.a, &p.b})
            for (const aabb::vec3<Real>& corner : t->corner)
                for (const Real x : corner.at) {
                    const auto bits = std::bit_cast<std::uint64_t>(static_cast<double>(x));
                    digest.add(std::array{static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32)});
                }
    return digest.text();
}

std::string text_digest(const std::string& text) {
    aabb::digest digest;
    for (const char c : text) digest.add(std::array{static_cast<std::uint32_t>(static_cast<unsigned char>(c))});
    return digest.text();
}

}  // namespace

TEST_CASE("every class of pairs has its property and, where possible, hits and misses") {
    std::set<std::string> digests;
    std::string pinned;
    for (const aabblab::pair_class_info& info : aabblab::pair_classes()) {
        INFO(info.name);
        std::vector<aabb::triangle_pair<float>> pairs(2000);
        aabblab::pair_source<float> source(info.name, 1);
        source.next(pairs);
        const auto hits =
            std::ranges::count_if(pairs, [](const auto& p) { return aabb::exact_triangle::intersects(p.a, p.b); });
        CHECK(hits > 20);
        if (info.name == "shared_vertex" || info.name == "shared_edge")
            CHECK(hits == 2000);
        else
            CHECK(hits < 1980);
        CHECK(std::ranges::all_of(pairs, [](const auto& p) {
            return std::ranges::all_of(p.a.corner, [](const auto& c) { return is_finite(c); }) &&
                   std::ranges::all_of(p.b.corner, [](const auto& c) { return is_finite(c); });
        }));
        CHECK(digests.insert(digest_of<float>(info.name)).second);
        pinned += digest_of<float>(info.name) + digest_of<double>(info.name);
        if (info.name == "shared_edge")
            CHECK(std::ranges::all_of(pairs, [](const auto& p) { return p.a[2] == p.b[0] && p.a[1] == p.b[1]; }));
        if (info.name == "coplanar")
            CHECK(std::ranges::all_of(pairs,
                                      [](const auto& p) { return p.a[0][2] == p.b[1][2] && p.a[1][2] == p.b[0][2]; }));
        if (info.name == "far") CHECK(std::ranges::all_of(pairs, [](const auto& p) { return p.a[0][0] >= 1e6F; }));
    }
    CHECK(aabblab::pair_classes().size() == 16);
    // The pairs are the same on every machine.
    CHECK(text_digest(pinned) == "4840156e752060f3");
}

TEST_CASE_METHOD(in_folder, "errors counts the wrong results of each method reproducibly and plots them") {
    const std::string config = folder.write(
        "e.toml",
        "name = \"e\"\n[[pairs]]\nclass = [\"random\", \"lattice\", \"small\"]\nprecision = [\"float\", \"double\"]\n"
        "count = 5000\n[[scene]]\nkind = \"mesh_pair\"\nmeshes = \"icosphere:triangles=320\"\nframes = 2\n"
        "[[curve]]\ntriangle = [\"exact\", \"epick\"]\n[[curve]]\nlabel = \"classic\"\n"
        "triangle = { name = \"moller\", epsilon = [\"absolute\", \"none\"] }\n");
    std::map<std::string, std::string> counts[2];
    for (auto& run : counts) {
        const std::string out = run_well({"errors", config, "--out", folder / "out"}).out;
        CHECK(holds(out, "moller:epsilon=none"));
        // Of the tests that take doubles, none errs.
        std::string words = out;
        std::erase_if(words, [](char c) { return c == ' ' || c == '\n'; });
        CHECK(holds(words, "Nomethoderrsinrandom,lattice,small,sothatnofigureshowsit."));
        for (const auto& r : csv_rows(folder / "out/errors.csv"))
            run[r.at("pairs") + " " + r.at("precision") + " " + r.at("triangle")] =
                r.at("count") + " " + r.at("intersecting") + " " + r.at("false_negatives") + " " +
                r.at("false_positives");
    }
    CHECK(counts[0] == counts[1]);
    // moller does not accept doubles.
    CHECK(counts[0].size() == 3 * 4 + 3 * 2 + 4);
    for (const auto& [name, numbers] : counts[0]) {
        INFO(name << ": " << numbers);
        if (name.find("moller") == std::string::npos) CHECK(numbers.ends_with(" 0 0"));
    }
    // Heights of a thousandth of a unit count as zero.
    CHECK_FALSE(counts[0].at("small float moller:epsilon=absolute").ends_with(" 0"));
    CHECK_FALSE(std::filesystem::exists(folder / "out/figures/errors_double.svg"));
    for (const char* name : {"errors_float", "errors_float_small"})
        for (const char* ending : {".svg", ".csv", ".pdf"}) {
            INFO(name << ending);
            CHECK(std::filesystem::exists(folder / "out/figures" / (std::string(name) + ending)));
        }
}

TEST_CASE_METHOD(in_folder, "errors compares the geometry of hits with CGAL's exact construction") {
    const std::string config =
        folder.write("h.toml",
                     "name = \"h\"\n[[hits]]\nclass = [\"random\", \"coplanar\", \"zero_area\"]\n"
                     "precision = [\"float\", \"double\"]\ncount = 1500\n");
    const program_result ran = run_well({"errors", config, "--out", folder / "out"});
    CHECK(holds(ran.out, "Intersections of triangles of doubles"));
    CHECK(holds(ran.out, "error/bound"));
    CHECK_FALSE(std::filesystem::exists(folder / "out/errors.csv"));
    CHECK(std::filesystem::exists(folder / "out/config.toml"));
    const auto rows = csv_rows(folder / "out/intersections.csv");
    CHECK(rows.size() == 3 * 2 * 2);
    for (const auto& r : rows) {
        INFO(r.at("pairs") << " " << r.at("precision") << " " << r.at("triangle"));
        CHECK((r.at("triangle") == "exact" || r.at("triangle") == "epeck"));
        // Tests of libraries run on one batch in sixteen.
        const std::size_t expected = r.at("triangle") == "exact" ? 1500 : 1024;
        CHECK(std::stoul(r.at("hits")) == expected);
        CHECK(std::stoul(r.at("tried")) > 1500);
        std::size_t hits = 0;
        for (const char* kind : {"point", "segment", "transversal", "overlap"}) hits += std::stoul(r.at(kind));
        CHECK(hits == expected);
        if (r.at("pairs") == "random") CHECK(std::stoul(r.at("transversal")) == expected);
        CHECK(r.at("different") == "0");
        CHECK(r.at("outside") == "0");
        CHECK(std::stod(r.at("of_bound")) > 0);
        CHECK(std::stod(r.at("of_bound")) <= 1);
        CHECK(std::stod(r.at("error")) <= std::stod(r.at("bound")));
        CHECK(std::stod(r.at("ns")) > 0);
    }
}

TEST_CASE("measure_hits counts wrong constructions and limits the search for rare hits") {
    const std::vector<aabblab::pair_set> sets = {{"huge", false, 3, 1}, {"shared_edge", true, 2000, 1}};
    const std::vector<aabblab::hit_point> points = aabblab::measure_hits(sets);
    REQUIRE(points.size() == 4);
    CHECK(points[0].count == 3);
    CHECK(points[0].tried <= 3000);
    CHECK(points[2].count == 2000);
    CHECK(points[2].tried == 2000);
    CHECK(points[2].kinds[static_cast<std::size_t>(aabb::intersection_kind::segment)] > 1900);
    CHECK(std::ranges::all_of(points, &aabblab::hit_point::is_right));
    aabblab::hit_point wrong = points[0];
    wrong.outside = 1;
    CHECK_FALSE(wrong.is_right());
    CHECK(aabblab::hit_summary(points, true).rows.size() == 2);
    CHECK(std::ranges::count(csv_of(points), '\n') == 1 + 4);
}

TEST_CASE("errors rejects a wrong config with its line and the nearest name") {
    CHECK(rejection_of(some_pairs + one_curve) == "accepted");
    CHECK(rejection_of(some_pairs) ==
          "e.toml:1: this config has no curve; expected at least one [[curve]], or [[hits]]");
    CHECK(rejection_of(one_curve) ==
          "e.toml:1: this config has no pairs of triangles; expected [[pairs]], or a [[scene]] of meshes");
    CHECK(rejection_of("[[pairs]]\nclass = \"randon\"\n" + one_curve) ==
          "e.toml:3: unknown class of pairs 'randon'; did you mean 'random'?");
    CHECK(rejection_of("[[pairs]]\nprecision = \"flaot\"\n" + one_curve) ==
          "e.toml:3: unknown precision 'flaot'; did you mean 'float'?");
    CHECK(rejection_of(some_pairs + "[[curve]]\ntriangle = \"exat\"\n") ==
          "e.toml:5: unknown triangle 'exat'; did you mean 'exact'?");
    CHECK(rejection_of(some_pairs + "[[curve]]\ntriangle = { name = \"moller\", epsilon = \"non\" }\n")
              .starts_with("e.toml:5: moller: epsilon must be one of absolute, none, scaled"));
    CHECK(rejection_of(some_pairs + some_pairs + one_curve) ==
          "e.toml:5: these pairs are listed twice: random in float");
    CHECK(rejection_of("[[scene]]\nkind = \"brownian\"\n" + one_curve) ==
          "e.toml:3: brownian is a scene of boxes, which has no triangles");
    CHECK(rejection_of("[[pairs]]\nprecision = \"double\"\n[[curve]]\ntriangle = \"moller\"\n") ==
          "e.toml:2: no curve has a test for triangles of doubles");
    CHECK(rejection_of(some_pairs + one_curve + one_curve) == "e.toml:6: two curves have the label 'exact'");
    CHECK(rejection_of(some_pairs + one_curve + "[[curve]]\nlabel = \"x\"\ntriangle = \"exact\"\n") ==
          "e.toml:6: 'exact' is a point of two curves");
    CHECK(rejection_of("quick = 5\n" + some_pairs + one_curve).starts_with("e.toml:2: quick is a number"));
    CHECK(rejection_of("[[pairs]]\ncount = 0\n" + one_curve) ==
          "e.toml:3: count must be a whole number, at least 1, not 0");
    const std::string some_hits = "[[hits]]\nclass = \"random\"\n";
    CHECK(rejection_of(some_hits) == "accepted");
    CHECK(rejection_of(some_hits + some_pairs + one_curve) == "accepted");
    CHECK(rejection_of(some_hits + one_curve) ==
          "e.toml:1: this config has no pairs of triangles; expected [[pairs]], or a [[scene]] of meshes");
    CHECK(rejection_of(some_hits + some_pairs) == "e.toml:4: [[pairs]] is for curves, and this config has none");
    CHECK(rejection_of(some_hits + some_hits) == "e.toml:5: these hits are listed twice: random in float");
    CHECK(rejection_of("[[hits]]\nclas = \"random\"\n").starts_with("e.toml:3: unknown key of [[hits]] 'clas'"));
    CHECK(rejection_of("[[hits]]\ncount = 0\n") == "e.toml:3: count must be a whole number, at least 1, not 0");
    CHECK(rejection_of("[hits]\ncount = 5\n") == "e.toml:2: hits must be in double brackets: [[hits]]");
    run_refused({"errors", "nowhere.toml"});
}

TEST_CASE_METHOD(in_folder, "errors runs whole compositions and plots the metrics of the config") {
    const std::string config = folder.write(
        "e.toml",
        "name = \"e\"\n[[scene]]\nkind = \"brownian\"\nobjects = 300\nframes = 9\n[measure]\nrepeats = 2\n"
        "[[curve]]\nprepare = { name = \"neighbour_list\", margin = [0.1, 0.5] }\n"
        "[[curve]]\nlabel = \"stale\"\nprepare = { name = \"neighbour_list\", margin = 0, every = [4, 8] }\n"
        "[[plot]]\nx = \"frame_ms\"\ny = \"wrong_share\"\n[[plot]]\nx = \"all_bytes\"\ny = \"box_tests\"\n");
    // Long lines are wrapped, even within names of compositions.
    std::string words = run_well({"errors", config, "--out", folder / "out"}).out;
    std::erase_if(words, [](char c) { return c == ' ' || c == '\n'; });
    CHECK(holds(words, "hasthebestwrong_share,0,withaframe_msof"));
    std::map<std::string, std::set<std::string>> results;
    for (const aabblab::row& r : aabblab::read_rows(folder / "out/results.csv"))
        results[r.name[aabb::strategy_kind::prepare]].insert(r.status + (*r.false_negatives > 0 ? " FN" : "") +
                                                             (*r.false_positives > 0 ? " FP" : ""));
    const std::set<std::string> exact{"exact"};
    const std::set<std::string> stale{"inexact FN"};
    CHECK(results == std::map<std::string, std::set<std::string>>{{"neighbour_list:margin=0.1", exact},
                                                                  {"neighbour_list:margin=0.5", exact},
                                                                  {"neighbour_list:margin=0,every=4", stale},
                                                                  {"neighbour_list:margin=0,every=8", stale}});
    for (const std::string plot : {"wrong_share_over_frame_ms", "box_tests_over_all_bytes"}) {
        const auto points = bytes_of_file(folder / "out/figures" / (plot + "_brownian-objects-300-frames-9.csv"));
        INFO(points);
        CHECK(std::ranges::count(points, '\n') > 4);
    }
}

TEST_CASE_METHOD(in_folder, "A plot without errors has no figure, but a sentence, and absent points are named") {
    const std::string config =
        folder.write("e.toml",
                     "name = \"e\"\n[[scene]]\nkind = \"mesh_pair\"\nmeshes = \"icosphere:triangles=320\"\nframes = 3\n"
                     "[measure]\nrepeats = 5\n[[curve]]\ntree = \"canonical\"\n"
                     "[[curve]]\nlabel = \"over bits\"\ntree = { name = \"quantized\", bits = [4, 12] }\n"
                     "[[plot]]\nx = \"detect_cpu_ms\"\ny = \"wrong_share\"\n"
                     "[[plot]]\nx = \"detect_cpu_ms\"\ny = \"box_inflation\"\n");
    std::string words = run_well({"errors", config, "--out", folder / "out"}).out;
    std::erase_if(words, [](char c) { return c == ' ' || c == '\n'; });
    CHECK(holds(words, "wrong_shareis0forall3compositions,soithasnofigure"));
    std::vector<aabblab::row> rows = aabblab::read_rows(folder / "out/results.csv");
    const aabblab::study_record record = aabblab::read_record(folder / "out");
    require_rows(record, rows, folder / "out");
    std::vector<aabblab::figure> figures = metric_figures(record, rows);
    REQUIRE(figures.size() == 1);
    CHECK(figures[0].name.starts_with("box_inflation_over_detect_cpu_ms"));
    const auto curve = std::ranges::find(figures[0].lines, "over bits", &aabblab::series::label);
    REQUIRE(curve != figures[0].lines.end());
    REQUIRE(curve->points.size() == 2);
    CHECK(curve->points[0].label == "4");
    CHECK(curve->points[1].label == "12");
    CHECK(curve->points[0].x_low < curve->points[0].x);
    CHECK(curve->points[0].x < curve->points[0].x_high);
    // canonical's boxes are not larger, which a logarithmic axis shows below the others.
    const auto canonical = std::ranges::find(figures[0].lines, "canonical", &aabblab::series::label);
    REQUIRE(canonical != figures[0].lines.end());
    CHECK(canonical->points.at(0).y == curve->points[1].y / 3);
    CHECK(figures[0].lines.back().label == "zero");

    // A scene without one of the compositions.
    const std::vector<aabblab::row> complete = rows;
    for (aabblab::row& r : rows) r.scene.settings.push_back({"distance", "2"});
    std::erase_if(rows, [](const aabblab::row& r) { return holds(r.name[aabb::strategy_kind::tree], "bits=12"); });
    rows.insert(rows.begin(), complete.begin(), complete.end());
    figures = metric_figures(record, rows);
    REQUIRE(figures.size() == 2);
    CHECK_FALSE(holds(figures[0].caption, "Without a row"));
    CHECK(holds(figures[1].caption, "Without a row or value here: over bits ("));
    CHECK(holds(figures[1].caption, "quantized:bits=12"));
    // The record says in how many scenes each ran.
    CHECK(holds(refusal_in<aabb::input_error>([&] { require_rows(record, rows, "x"); }),
                " in 2 scenes; curves.csv says that there are 1"));
}

TEST_CASE("a config of errors cannot mix triangle tests and compositions") {
    const std::string lists = "[[curve]]\nlabel = \"lists\"\nprepare = \"neighbour_list\"\n";
    const std::string scene = "[[scene]]\nkind = \"brownian\"\nobjects = 20\nframes = 3\n";
    CHECK(rejection_of(scene + lists) == "accepted");
    CHECK(rejection_of(lists + scene + one_curve) ==
          "e.toml:9: 'exact' and 'lists' cannot be in one config: triangle tests alone run on pairs of triangles, "
          "other compositions on scenes; put them into two configs");
    CHECK(rejection_of(lists + some_pairs) ==
          "e.toml:5: [[pairs]] is for curves of triangle tests alone; these run whole scenes");
    CHECK(rejection_of(some_pairs + one_curve + "[[plot]]\nx = \"frame_ms\"\n") ==
          "e.toml:6: [[plot]] is for compositions; triangle tests alone are plotted against their time");
    CHECK(rejection_of(scene + lists + "[[plot]]\nx = \"frame_ms\"\ny = \"wrong\"\n")
              .starts_with("e.toml:11: unknown metric 'wrong'"));
    CHECK(rejection_of(scene + lists + "[[plot]]\nx = \"frame_ms\"\n") ==
          "e.toml:9: this plot has no y; expected the name of a metric");
    CHECK(rejection_of("seed = [1, 2]\n" + scene + lists) == "accepted");
    CHECK(rejection_of(scene + "[compose]\n") == "e.toml:6: [compose] belongs to a config of run; use ./aabblab run");
    CHECK(refusal_in<aabb::input_error>([&] {
              return aabblab::parse_experiment("name = \"e\"\n" + scene + lists, "e.toml", experiment_size::full);
          }) == "e.toml:6: [[curve]] belongs to a config of errors; use ./aabblab errors");
    CHECK(rejection_of(some_pairs + one_curve + "[measure]\nrepeats = 2\n")
              .starts_with("e.toml:6: [measure] is for compositions"));
    CHECK(rejection_of(scene + lists + "[measure]\nprocesses = 2\n") ==
          "e.toml:10: errors has no processes, which is for run");
    CHECK(rejection_of(scene + lists + "[[curve]]\nprepare = \"neighbour_lists\"\n") ==
          "e.toml:10: unknown prepare 'neighbour_lists'; did you mean 'neighbour_list'?");
    CHECK(rejection_of(scene + lists + "[[curve]]\nlabel = \"x\"\n")
              .starts_with("e.toml:9: this curve has no method; expected triangle = "));
}

TEST_CASE_METHOD(in_folder, "errors in a minority of seeds show in the plot") {
    const std::string config =
        folder.write("e.toml",
                     "name = \"e\"\nseed = [1, 2, 3, 4, 5]\n[[scene]]\nkind = \"brownian\"\nobjects = 12\nframes = "
                     "9\n[measure]\nrepeats = 1\n"
                     "[[curve]]\nlabel = \"stale\"\nprepare = { name = \"neighbour_list\", every = 4 }\n"
                     "[[curve]]\nlabel = \"none\"\nprepare = \"none\"\n");
    run_well({"errors", config, "--out", folder / "out"});
    std::uint64_t wrong_seeds = 0, false_negatives = 0, exact = 0;
    for (const aabblab::row& r : aabblab::read_rows(folder / "out/results.csv")) {
        if (r.name[aabb::strategy_kind::prepare] == "none") continue;
        false_negatives += *r.false_negatives;
        wrong_seeds += *r.false_negatives > 0;
        exact += r.candidates + *r.false_negatives;
    }
    // Fewer than half of the seeds have errors, so a median would be zero.
    CHECK_BETWEEN(0, wrong_seeds, 3);
    const std::vector<aabblab::row> rows = aabblab::read_rows(folder / "out/results.csv");
    const auto figures =
        metric_figures(record_of(aabblab::read_error_study(config, experiment_size::full), rows), rows);
    const auto stale = std::ranges::find(figures.at(0).lines, "stale", &aabblab::series::label);
    REQUIRE(stale != figures[0].lines.end());
    CHECK(stale->points.at(0).y > 0.5 / static_cast<double>(exact) * static_cast<double>(false_negatives));
    CHECK(figures[0].y.logarithmic);
}

TEST_CASE("The error of a method is that in its worst class, with 95 % intervals") {
    const auto point = [](const char* pairs, const char* triangle, std::uint64_t wrong, double ns) {
        aabblab::error_point p{.pairs = pairs, .curve = "moller", .triangle = aabb::parse_strategy(triangle)};
        p.count = 100;
        p.intersecting = 50;
        p.false_negatives = wrong;
        p.ns_per_pair = {ns, ns, ns};
        p.cpu_ns = ns;
        p.cpu_ns_low = 0.9 * ns;
        p.cpu_ns_high = 1.2 * ns;
        return p;
    };
    std::vector<aabblab::error_point> points{
        point("random", "moller:epsilon=none", 0, 10), point("sliver", "moller:epsilon=none", 10, 20),
        point("random", "moller:epsilon=scaled", 2, 30), point("sliver", "moller:epsilon=scaled", 1, 40)};
    const auto f = group_figure(points, aabblab::pair_group::of_floats);
    REQUIRE(f.has_value());
    CHECK(holds(f->x.label, "processor"));
    const auto curve = std::ranges::find(f->lines, "moller", &aabblab::series::label);
    REQUIRE(curve != f->lines.end());
    REQUIRE(curve->points.size() == 2);
    const aabblab::figure_point& none = curve->points[0];
    const auto is_near = [](double value, double expected) { return std::abs(value - expected) < 1e-4; };
    CHECK(is_near(none.x, 15));
    CHECK(is_near(none.y, 0.1));
    // Wilson's interval of 10 in 100, and limits from those of two independent times: 1 and 2 below, 2 and 4 above.
    CHECK(is_near(none.low, 0.0552));
    CHECK(is_near(none.high, 0.1744));
    CHECK(is_near(none.x_low, 15 - std::sqrt(1. + 4) / 2));
    CHECK(is_near(none.x_high, 15 + std::sqrt(4. + 16) / 2));
    CHECK(none.label == "epsilon=none");
    CHECK(is_near(curve->points[1].y, 0.02));
    CHECK(curve->points[1].label == "epsilon=scaled");
    CHECK(holds(group_statement(points, aabblab::pair_group::of_floats),
                "errs in up to 10 % of the pairs of a set (sliver)"));
    const aabblab::table summary = error_summary(points, aabblab::pair_group::of_floats);
    CHECK(summary.rows[0] == std::vector<std::string>{"moller:epsilon=scaled", "35.0", "0.02", "0.04", "0", "random"});
    CHECK(summary.rows[1] == std::vector<std::string>{"moller:epsilon=none", "15.0", "0.1", "0.2", "0", "sliver"});

    // Scenes have a panel each, and no interval of the error: all their pairs are tested.
    for (aabblab::error_point& p : points) p.pairs += " frames=2";
    points[0].false_negatives = points[2].false_negatives = 0;
    const auto meshes = group_figure(points, aabblab::pair_group::of_meshes);
    REQUIRE(meshes.has_value());
    REQUIRE(meshes->panels.size() == 1);
    CHECK(meshes->panels[0].title == "scene 2");
    CHECK(holds(meshes->caption, "scene 2: sliver frames=2."));
    CHECK(meshes->panels[0].lines[1].points[0].low == meshes->panels[0].lines[1].points[0].y);
    // A set in which no method errs has no figure, and the sentence says so.
    CHECK(holds(group_statement(points, aabblab::pair_group::of_meshes), "No method errs in random frames=2"));
    std::erase_if(points, [](const aabblab::error_point& p) { return p.false_negatives > 0; });
    CHECK_FALSE(group_figure(points, aabblab::pair_group::of_meshes).has_value());
    CHECK(error_figures(points).empty());
}

TEST_CASE("Fewer iterations of GJK and MPR take less time and make errors") {
    const auto study = aabblab::parse_error_study(
        "name = \"e\"\n[[pairs]]\nclass = \"random\"\ncount = 20000\n"
        "[[curve]]\ntriangle = { name = \"gjk\", iterations = [1, 3, 8] }\n"
        "[[curve]]\ntriangle = { name = \"mpr\", tolerance = 1e-12, iterations = [3, 5, 16] }\n",
        "e.toml", experiment_size::full);
    const std::vector<aabblab::error_point> points = measure_errors(study);
    REQUIRE(points.size() == 6);
    for (const std::size_t first : {0, 3}) {
        CHECK(points[first].wrong() > points[first + 1].wrong());
        CHECK(points[first + 1].wrong() > points[first + 2].wrong());
        CHECK(points[first + 2].wrong() == 0);
        CHECK(points[first].count == 20000);
        CHECK(points[first].cpu_ns_low < points[first].cpu_ns);
        CHECK(points[first].cpu_ns < points[first].cpu_ns_high);
    }
}

TEST_CASE_METHOD(in_folder, "Pairs of a scene are timed several times, and counted once") {
    const std::string scene =
        "name = \"e\"\n[[scene]]\nkind = \"mesh_pair\"\nmeshes = \"icosphere:triangles=320\"\nframes = 2\n";
    const auto study =
        aabblab::parse_error_study(scene + "[[curve]]\ntriangle = \"exact\"\n", "e.toml", experiment_size::full);
    const std::vector<aabblab::error_point> points = measure_errors(study);
    REQUIRE(points.size() == 1);
    CHECK(points[0].cpu_ns_low.has_value());
    CHECK(points[0].intersecting < points[0].count);
    // The number that the narrow phase finds, up to the rounding of images to float.
    run_well({"run", folder.write("run.toml", scene + "[measure]\nrepeats = 1\nmetrics = \"error\"\n"), "--out",
              folder / "out"});
    const auto contacts = static_cast<double>(aabblab::read_rows(folder / "out/results.csv").at(0).contacts.value());
    CHECK(contacts > 0);
    CHECK_BETWEEN(0.9 * contacts, static_cast<double>(points[0].intersecting), 1.1 * contacts);
}

TEST_CASE_METHOD(in_folder, "errors.csv round-trips, and a malformed one is rejected with its line") {
    const auto study = aabblab::parse_error_study(
        "name = \"e\"\n[[pairs]]\nclass = [\"random\", \"far\"]\ncount = 100\nprecision = [\"float\", \"double\"]\n"
        "[[curve]]\ntriangle = { name = \"devillers_guigue\", precision = [\"double\", \"float\"] }\n",
        "e.toml", experiment_size::full);
    const std::string text = csv_of(measure_errors(study));
    CHECK(csv_of(aabblab::read_error_rows(folder.write("errors.csv", text))) == text);
    // Earlier versions measured only wall time.
    const std::string head_without = text.substr(0, text.find(",cpu_ns"));
    const auto earlier = aabblab::read_error_rows(
        folder.write("earlier.csv", head_without + "\nrandom,float,c,moller,100,9,1,0,5,4,6\n"));
    CHECK(earlier.at(0).ns() == 5);
    CHECK(holds(group_figure(earlier, aabblab::pair_group::of_floats)->x.label, "wall time"));
    const auto rejected = [&](const std::string& changed) {
        const std::string file = folder.write("changed.csv", changed);
        return refusal_in<aabb::input_error>([&] { return aabblab::read_error_rows(file); }).substr(file.size());
    };
    CHECK(rejected("pairs\n") ==
          ":1: these are not the columns of this version; column 2 is missing; expected 'precision'");
    const std::string head = text.substr(0, text.find('\n') + 1);
    CHECK(rejected(head + "random,flat,c,exact,1,1,0,0,1,1,1\n") ==
          ":2: precision must be float or double, not 'flat'");
    CHECK(rejected(head + "random,float,c,exact,1,1,0,0,1,1\n") == ":2: the column ns_high is missing");
}

TEST_CASE("every config of errors is valid") {
    const std::filesystem::path configs(AABBLAB_CONFIGS);
    for (const auto& file : std::filesystem::directory_iterator(configs / "errors")) {
        if (file.path().extension() != ".toml") continue;
        INFO(file.path());
        CHECK_NOTHROW(aabblab::read_error_study(file.path(), experiment_size::full));
    }
    // Arms of a comparison of lists differ in the list only, and their whole time is compared.
    const auto lists = aabblab::read_error_study(configs / "errors/neighbour_lists.toml", experiment_size::full);
    CHECK(std::ranges::all_of(lists.plots, [](const aabblab::metric_plot& p) { return p.x == "whole_cpu_ms"; }));
    std::vector<aabb::composition> without_list;
    for (const aabblab::error_curve& curve : lists.curves)
        for (const aabb::composition& c : curve.compositions)
            if (c[aabb::strategy_kind::prepare].name == "none") without_list.push_back(c);
    for (const aabblab::error_curve& curve : lists.curves)
        for (aabb::composition c : curve.compositions) {
            c[aabb::strategy_kind::prepare] = {"none", {}};
            CHECK(std::ranges::count(without_list, c) == 1);
        }
    // The large one has the same methods, on more than a hundred million pairs.
    const auto some = aabblab::read_error_study(configs / "errors/triangle_tests.toml", experiment_size::full);
    const auto many = aabblab::read_error_study(configs / "errors_large.toml", experiment_size::full);
    CHECK(std::ranges::equal(some.curves, many.curves, {}, &aabblab::error_curve::triangles,
                             &aabblab::error_curve::triangles));
    std::uint64_t pairs = 0;
    for (const aabblab::pair_set& set : many.pairs) pairs += set.count;
    CHECK(pairs > 100'000'000);
}

TEST_CASE("the default configs of errors are valid, and classify accepts library tests") {
    const auto study = aabblab::read_error_study(std::filesystem::path(AABBLAB_CONFIGS) / "errors/triangle_tests.toml",
                                                 experiment_size::quick);
    CHECK(study.pairs.size() == 2 * aabblab::pair_classes().size());
    CHECK(study.curves.size() >= 8);
    const auto hits = aabblab::read_error_study(std::filesystem::path(AABBLAB_CONFIGS) / "errors/intersections.toml",
                                                experiment_size::full);
    REQUIRE(hits.hits.size() == 2 * aabblab::pair_classes().size());
    CHECK(hits.hits[0].count == 1'000'000);
    CHECK(hits.curves.empty());
    const std::string crossing = "0 0 0 4 0 0 0 4 0  1 1 -1 1 1 1 5 5 1\n";
    CHECK(run_program({"classify", "-", "--triangle", "epeck"}, crossing).out == "1\n");
    CHECK(run_well({"classify", "-", "--triangle", "interval_arithmetic:fallback=intersects"}, crossing).out == "1\n");
    CHECK(holds(run_program({"classify", "-", "--triangle", "epek"}, crossing).err, "did you mean 'epeck'?"));
}
