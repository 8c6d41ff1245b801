#include <random>

#include "program.hpp"

import aabb.registry;
import aabblab.archive;
import aabblab.atlas;
import aabblab.configs;
import aabblab.measures;
import aabblab.metrics;
import aabblab.results;
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
    return *std::ranges::find_if(statements, [&](const auto& s) { return s.text.id == id; });
}

const aabblab::border_kind& lists() {
    return aabblab::border_kinds()[0];
}

/// Scenes at the displacements 0.05, 0.1, 0.2, … in which a list takes these multiples of the time without one.
std::vector<atlas_scene> row_of(const std::vector<double>& ratios, bool is_held_out = false) {
    std::vector<atlas_scene> scenes;
    double displacement = 0.05;
    for (const double ratio : ratios) {
        scenes.push_back(cloud(
            std::to_string(displacement),
            {timed("neighbour_list:margin=0.1 + bucket + columns + simd", ratio), timed("bucket + columns + simd", 1)},
            is_held_out));
        displacement *= 2;
    }
    return scenes;
}

/// A kind of border whose law is a straight line.
const aabblab::border_kind& straight() {
    static const aabblab::border_kind kind{
        "lines", "a", "b", "objects", atlas_time::per_frame, {{"x", [](const auto&) { return 0.0; }}}};
    return kind;
}

aabblab::border border_at(double x, double log_position, bool is_unseen = false) {
    return {"", is_unseen, std::exp(log_position), {1e-6, 1e6}, {1, x}};
}

/// The strategies of a composition other than `none`, without parameters, as labels name them.
std::string family_in(const aabb::composition& c) {
    std::string family;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (info_of(kind).stage == aabb::stage::global_search && c[kind].name != "none")
            family += (family.empty() ? "" : " + ") + c[kind].name;
    return family;
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

TEST_CASE("A border is where two candidates take the same time as one parameter grows") {
    // The whole time doubles along with the displacement, and crosses 1 between 0.1 and 0.2.
    std::vector<atlas_scene> scenes = row_of({1.0 / 8, 1.0 / 2, 2, 8});
    const auto find = [&] { return borders_of(lists(), scenes); };
    REQUIRE(find().size() == 1);
    CHECK(std::abs(find()[0].position - std::sqrt(0.02)) < 1e-6);
    CHECK(find()[0].settings == "objects=1000");
    CHECK(find()[0].played.low == 0.05);
    CHECK(find()[0].played.high == 0.4);
    // Terms of the law: a constant, ln(1 + p) and ln r.
    scenes.back().measures.pairs_per_object = 2;
    scenes.back().measures.boxes.size_ratio = 10;
    REQUIRE(find()[0].terms.size() == 3);
    CHECK(find()[0].terms[0] == 1);
    CHECK(std::abs(find()[0].terms[1] - std::log(3)) < 1e-12);
    CHECK(std::abs(find()[0].terms[2] - std::log(10)) < 1e-12);
    // The order in which scenes were run does not matter, nor do times of frames after the first.
    std::ranges::reverse(scenes);
    for (atlas_scene& scene : scenes)
        for (atlas_candidate& candidate : scene.candidates) candidate.frame_ms = {1};
    CHECK(std::abs(find()[0].position - std::sqrt(0.02)) < 1e-6);
    // A scene without one of the candidates has no place in the row.
    scenes[1].candidates.pop_back();
    CHECK(std::abs(find()[0].position - 0.1 * std::pow(4, 0.25)) < 1e-6);
}

TEST_CASE("Noise moves a border by little, and one beyond the scenes is above or below them") {
    const auto position = [](const std::vector<double>& ratios) {
        return borders_of(lists(), row_of(ratios)).at(0).position;
    };
    // A ratio slightly above 1 far from the border does not count; the border is where most are on their side.
    CHECK(std::abs(position({0.5, 1.05, 0.5, 0.5, 2, 2}) - 0.4 * std::sqrt(2)) < 1e-6);
    CHECK(std::abs(position({0.5, 0.5, 2, 0.95, 2, 2}) - 0.1 * std::sqrt(2)) < 1e-6);
    CHECK(std::abs(position({0.5, 1, 2}) - 0.1) < 1e-9);
    CHECK(position({2, 2, 2}) == 0);
    CHECK(position({0.5, 0.5, 0.5}) == std::numeric_limits<double>::infinity());
}

TEST_CASE("Rows of scenes differ in one parameter, and lists of several margins count as their fastest") {
    std::vector<atlas_scene> scenes = row_of({0.5, 2});
    std::vector<atlas_scene> unseen = row_of({0.25, 2}, /*is_held_out=*/true);
    std::vector<atlas_scene> more = row_of({0.5, 4});
    for (atlas_scene& scene : more) scene.scene.settings[0].value = "2000";
    for (auto* row : {&unseen, &more}) std::ranges::move(*row, std::back_inserter(scenes));
    std::vector<aabblab::border> borders = borders_of(lists(), scenes);
    REQUIRE(borders.size() == 3);
    CHECK(std::ranges::count(borders, true, &aabblab::border::is_unseen) == 1);
    CHECK(std::ranges::count(borders, "objects=2000", &aabblab::border::settings) == 1);
    // A list with a wider skin is faster in the second scene, which moves the border beyond it.
    scenes = row_of({0.5, 2});
    scenes[1].candidates.push_back(timed("neighbour_list:margin=0.3 + bucket + columns + simd", 0.5));
    CHECK(std::isinf(borders_of(lists(), scenes).at(0).position));
}

TEST_CASE("The border of sorts follows from inversions and from times of frames after the first") {
    const aabblab::border_kind& sorts = aabblab::border_kinds()[1];
    std::vector<atlas_scene> scenes;
    for (const char* objects : {"100", "1000"}) {
        const double ratio = scenes.empty() ? 0.1 : 10;
        scenes.push_back({{"cloud", {{"objects", objects}}, {}, 1},
                          false,
                          {},
                          {{sorts.before, false, {ratio}, {1}}, {sorts.after, false, {1}, {1}}}});
        scenes.back().measures.objects = scenes.size() == 1 ? 100 : 1000;
    }
    // Without inversions, the law has no terms.
    CHECK(borders_of(sorts, scenes).empty());
    scenes.back().measures.motion = aabblab::motion_measures{.inversions = 5};
    const std::vector<aabblab::border> borders = borders_of(sorts, scenes);
    REQUIRE(borders.size() == 1);
    CHECK(std::abs(borders[0].position - std::sqrt(100 * 1000)) < 1e-6);
    const double log = std::log(5 / std::pow(1000, 2.0 / 3));
    CHECK(std::abs(borders[0].terms.at(1) - log) < 1e-9);
    CHECK(std::abs(borders[0].terms.at(2) - log * log) < 1e-9);
}

TEST_CASE("A law is a least-squares fit, and predicts with Student's t") {
    // By hand: the line through these points is 0.05 + 0.99 x, with s² = 0.107 / 3. At 6, the prediction's standard
    // error is s √(1 + 1/5 + 9/10), and t of 3 degrees of freedom is 3.182446 at 97.5 %.
    const std::vector<double> y{1.1, 1.9, 3.2, 3.8, 5.1};
    std::vector<aabblab::border> borders;
    for (std::size_t i = 0; i < y.size(); ++i) borders.push_back(border_at(static_cast<double>(i + 1), y[i]));
    borders.push_back(border_at(4, 9, /*is_unseen=*/true));  // not fitted
    borders.push_back(border_at(2, 0));
    borders.back().position = 0;  // below its scenes: not fitted
    const std::optional<aabblab::border_law> law = law_of(straight(), borders);
    REQUIRE(law);
    CHECK(std::abs(law->coefficients[0].value - 0.05) < 1e-12);
    CHECK(std::abs(law->coefficients[1].value - 0.99) < 1e-12);
    CHECK(std::abs(law->deviation - std::sqrt(0.107 / 3)) < 1e-12);
    CHECK(law->degrees == 3);
    const aabblab::estimate at_six = law->predicted(std::vector{1.0, 6.0});
    CHECK(std::abs(at_six.value - 5.99) < 1e-12);
    const double radius = 3.182446 * std::sqrt(0.107 / 3 * 2.1);
    CHECK(std::abs(at_six.range().low - (5.99 - radius)) < 1e-6);
    CHECK(std::abs(at_six.range().high - (5.99 + radius)) < 1e-6);
    // The slope's standard error is s / √10.
    CHECK(std::abs(law->coefficients[1].error - std::sqrt(0.107 / 30)) < 1e-12);
    CHECK(law->contains(border_at(6, 5.99 + 0.99 * radius)));
    CHECK_FALSE(law->contains(border_at(6, 5.99 + 1.01 * radius)));
    CHECK_FALSE(law->contains(border_at(6, 5.99 - 1.01 * radius)));
    // A border beyond its scenes is contained if the interval reaches there.
    aabblab::border beyond = border_at(6, 0);
    beyond.position = std::numeric_limits<double>::infinity();
    beyond.played = {1, std::exp(6)};
    CHECK(law->contains(beyond));
    beyond.played.high = std::exp(5.99 + 1.01 * radius);
    CHECK_FALSE(law->contains(beyond));
    beyond.position = 0;
    beyond.played = {std::exp(5.99 - 0.99 * radius), std::exp(9)};
    CHECK(law->contains(beyond));
    beyond.played.low = std::exp(5.99 - 1.01 * radius);
    CHECK_FALSE(law->contains(beyond));
    const aabblab::table table = aabblab::laws_table({*law});
    REQUIRE(table.rows.size() == 1);
    CHECK(table.rows[0][2] == "ln objects = 0.0500 + 0.990 x");
    CHECK(table.rows[0][3] == "5");
    CHECK(holds(sentence_of(*law), "up to ln objects = 0.0500 + 0.990 x, within"));
    CHECK(holds(sentence_of(*law), "0 of 1 unseen borders"));
    CHECK(std::vector(table.rows[0].begin() + 5, table.rows[0].end()) == std::vector<std::string>{"1", "0", "0"});
    const aabblab::table rows = aabblab::borders_table({*law});
    REQUIRE(rows.rows.size() == borders.size());
    CHECK(rows.rows[1] == std::vector<std::string>{"lines", "fitted", "objects", "6.68589", "7.61409", "3.83714",
                                                   "15.1087", "yes", "2", ""});
    CHECK(rows.rows[5][1] == "unseen");
    CHECK(rows.rows[6][1] == "left out");
    CHECK(rows.rows[6][3] == "below 1e-06");
    CHECK(aabblab::coefficients_table({*law}).rows.size() == 2);
    // No law without degrees of freedom, or from terms that depend on each other.
    CHECK_FALSE(law_of(straight(), {border_at(1, 1), border_at(2, 2)}));
    CHECK_FALSE(law_of(straight(), {border_at(1, 1), border_at(1, 2), border_at(1, 3)}));
}

TEST_CASE("The prediction interval of a law contains 95 % of new borders") {
    std::mt19937_64 random(1);
    std::normal_distribution<double> noise(0, 0.3);
    std::uniform_real_distribution<double> place(-1, 1);
    constexpr int laws = 400;
    constexpr int unseen = 10;
    int inside = 0;
    const auto draw = [&] {
        const double x = place(random);
        return border_at(x, 2 - 0.5 * x + noise(random));
    };
    for (int i = 0; i < laws; ++i) {
        std::vector<aabblab::border> borders;
        for (int k = 0; k < 8; ++k) borders.push_back(draw());
        const std::optional<aabblab::border_law> law = law_of(straight(), borders);
        REQUIRE(law);
        for (int k = 0; k < unseen; ++k) inside += law->contains(draw());
    }
    // Without 1 in 1 + x' (X'X)^-1 x it would be 0.6, with the normal distribution instead of Student's 0.90.
    CHECK_BETWEEN(0.935, static_cast<double>(inside) / (laws * unseen), 0.965);
}

TEST_CASE("Laws of borders are fitted to scenes drawn with one seed and tested on 50 drawn with another") {
    for (const aabblab::border_kind& kind : aabblab::border_kinds()) {
        CAPTURE(kind.name);
        std::map<std::string, std::set<std::string>> drawn;  // by config: the settings of each row
        std::map<std::string, std::set<std::optional<std::uint64_t>>> seeds;
        for (const std::string& name : {kind.name, kind.name + "_unseen"}) {
            const auto e =
                aabblab::read_experiment(AABBLAB_CONFIGS "/atlas/" + name + ".toml", aabblab::experiment_size::full);
            CHECK(e.name == name);
            std::set<std::string> labels;
            for (const aabb::composition& c : e.compositions) labels.insert(family_in(c));
            CHECK(labels == std::set{kind.before, kind.after});
            for (aabblab::scene_choice scene : e.scenes) {
                seeds[name].insert(scene.seed);
                std::erase_if(scene.settings, [&](const aabb::setting& s) { return s.name == kind.parameter; });
                drawn[name].insert(settings_text(scene));
            }
        }
        CHECK(drawn[kind.name].size() == 60);
        CHECK(drawn[kind.name + "_unseen"].size() == 50);
        for (const std::string& scene : drawn[kind.name + "_unseen"]) CHECK_FALSE(drawn[kind.name].contains(scene));
        CHECK(seeds[kind.name] != seeds[kind.name + "_unseen"]);
    }
}

TEST_CASE("Each statement has a source, a quote of at most a line, and what is played") {
    const std::vector<aabblab::judged_statement> statements = aabblab::judged_statements({});
    CHECK(statements.size() == 17);
    std::set<std::string> ids;
    for (const aabblab::judged_statement& s : statements) {
        CAPTURE(s.text.id);
        CHECK(ids.insert(s.text.id).second);
        CHECK(!s.text.source.empty());
        CHECK((s.text.link.empty() || s.text.link.starts_with("http")));
        CHECK_BETWEEN(std::size_t{20}, s.text.quote.size(), std::size_t{100});
        CHECK(!s.text.says.empty());
        CHECK(!s.text.played.empty());
        CHECK(verdict_text(s) == (s.text.is_proxy ? "undecided (proxy)" : "undecided"));
    }
    const aabblab::table table = aabblab::statements_table(statements);
    REQUIRE(table.rows.size() == 17);
    CHECK(table.rows[0].size() == table.columns.size());
    CHECK(table.rows[0][6] == "undecided (proxy)");
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
    // Ratios that were not measured do not decide: those for 1,000 boxes alone favour it.
    std::erase_if(atlas, [](const atlas_scene& scene) { return scene.number("objects") == 10000; });
    CHECK(judged(atlas, "B9").ratios.size() == 3);
    CHECK(verdict("B9") == aabblab::verdict_kind::undecided);
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

TEST_CASE_METHOD(in_folder, "An atlas takes the measures of its scenes from measures.csv, or makes the scenes again") {
    // The last scene has a single frame and no seed.
    std::string rows;
    for (int i = 0; i < 300; ++i) rows += std::to_string(i % 20) + ",0," + std::to_string(i / 20) + ",30,1,30\n";
    const std::string boxes = folder.write("boxes.csv", rows);
    folder.write("small.toml",
                 "name = \"atlas\"\n[[scene]]\nkind = \"cloud\"\nobjects = 500\ndisplacement = [0.1, 1]\nframes = 3\n"
                 "[[scene]]\nkind = \"recording\"\nfile = \"" +
                     boxes + "\"\n[[compose]]\nsort = \"std\"\n");
    const std::string results = folder / "map/atlas";
    run_well({"run", folder / "small.toml", "--out", results});
    const auto read = [&] { return aabblab::read_atlas(results, /*is_held_out=*/false); };
    const std::vector<atlas_scene> of_scenes = read();
    REQUIRE(of_scenes.size() == 3);
    std::vector<aabblab::scene_choice> scenes;
    for (const atlas_scene& scene : of_scenes) scenes.push_back(scene.scene);
    aabblab::write_measures(results, scenes);
    const std::vector<atlas_scene> of_file = read();
    CHECK(cells_table(of_file).rows == cells_table(of_scenes).rows);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const aabblab::scene_measures& m = of_file[i].measures;
        const aabblab::scene_measures& expected = of_scenes[i].measures;
        CHECK(m.objects == expected.objects);
        CHECK(m.pairs_per_object == expected.pairs_per_object);
        CHECK(m.clustering == expected.clustering);
        CHECK(m.boxes.size_ratio == expected.boxes.size_ratio);
        CHECK(m.motion.has_value() == (i < 2));
        CHECK(m.motion.has_value() == expected.motion.has_value());
        if (m.motion) {
            CHECK(m.motion->inversions == expected.motion->inversions);
            CHECK(m.motion->at_rest == expected.motion->at_rest);
        }
    }
    const std::string table = bytes_of_file(folder / "map/atlas/measures.csv");
    std::vector<std::string> lines = lines_of(table);
    lines[1] = lines[1].substr(0, lines[1].rfind(',')) + ",7";
    folder.write("map/atlas/measures.csv", lines[0] + "\n" + lines[1] + "\n" + lines[2] + "\n" + lines[3] + "\n");
    CHECK(read()[0].measures.motion->inversions == 7);
    folder.write("map/atlas/measures.csv", lines[0] + "\n" + lines[1] + "\n" + lines[3] + "\n");
    CHECK(holds(run_refused({"atlas", "--judge", "--out", folder / "map"}).err,
                "map/atlas/measures.csv has no row for cloud objects=500"));
    folder.write("map/atlas/measures.csv", "scene\n");
    CHECK(holds(run_refused({"atlas", "--judge", "--out", folder / "map"}).err,
                "measures.csv:1: these are not the columns"));
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
    // A list is faster at rest, and slower if every frame has to make a new one.
    folder.write("borders.toml",
                 "name = \"list_borders\"\n[[scene]]\nkind = \"cloud\"\nobjects = 500\ndisplacement = [0.001, 10]\n"
                 "density = [0.03, 0.1, 0.3]\nratio = [1, 100]\nframes = 60\n[[compose]]\n"
                 "prepare = [\"none\", { name = \"neighbour_list\", margin = 0.1 }]\n[measure]\nrepeats = 2\n");
    run_well({"run", folder / "borders.toml", "--out", folder / "map/list_borders"});
    run_well({"run", folder / "borders.toml", "--out", folder / "map/list_borders_unseen"});
    const program_result mapped = run_well({"atlas", "--judge", "--out", folder / "map"});
    CHECK(holds(mapped.err, "atlas_large has not been run yet"));
    CHECK(holds(mapped.err, "sort_borders_unseen has not been run yet"));
    const std::string borders = bytes_of_file(folder / "map/borders.csv");
    CHECK(lines_of(borders).size() == 1 + 6 + 6);
    CHECK(lines_of(borders.substr(borders.find(",unseen,"))).size() == 6);  // they follow the fitted ones
    CHECK(lines_of(bytes_of_file(folder / "map/border_laws.csv")).size() == 1 + 1);
    std::string one_line = mapped.out;
    std::ranges::replace(one_line, '\n', ' ');
    CHECK(holds(one_line, "simd up to ln displacement ="));
    CHECK(holds(one_line, " of 6 unseen borders"));
    // Times are processor times of the thread.
    double in_rows = 0, in_atlas = 0;
    for (const aabblab::row& r : aabblab::verified_rows(folder / "map/atlas"))
        for (const char* metric : {"frame_cpu_ms", "whole_cpu_ms"}) in_rows += aabblab::measured(metric)(r).value();
    for (const atlas_scene& scene : aabblab::read_atlas(folder / "map/atlas", /*is_held_out=*/false))
        for (const atlas_candidate& candidate : scene.candidates)
            for (const auto time : {atlas_time::per_frame, atlas_time::whole_run})
                for (const double ms : candidate.times(time)) in_atlas += ms;
    CHECK(std::abs(in_atlas / in_rows - 1) < 1e-9);
    // times.csv has those of every part.
    const std::vector<std::string> times = lines_of(bytes_of_file(folder / "map/times.csv"));
    CHECK(times[0] == "experiment,scene,scene_parameters,seed,frames,candidate,repeat,first_cpu_ms,later_cpu_ms");
    double in_times = 0;
    for (const std::string& line : times) {
        if (!line.starts_with("atlas,")) continue;
        const std::size_t later = line.rfind(','), first = line.rfind(',', later - 1);
        in_times += std::stod(line.substr(first + 1)) + std::stod(line.substr(later + 1)) * (1 + 1.0 / 3);
    }
    CHECK(std::abs(in_times / in_rows - 1) < 1e-9);
    const auto of_borders =
        std::ranges::count_if(times, [](const std::string& line) { return line.starts_with("list_borders,"); });
    std::size_t rows = 0;  // of two parts that have the same name in their config
    for (const char* part : {"map/list_borders", "map/list_borders_unseen"})
        rows += aabblab::verified_rows(folder / part).size();
    CHECK(static_cast<std::size_t>(of_borders) == rows);
    for (const std::string& line :
         lines_of(mapped.out.substr(mapped.out.find("neighbour_list + bucket + columns + simd is")))) {
        INFO(line);
        CHECK((line.size() <= 80 || line.starts_with("Maps, borders")));
    }
    for (const char* file : {"atlas.html", "atlas.md", "cells.csv", "borders.csv", "statement_ratios.csv",
                             "figures/map_1.svg", "figures/regret.svg", "figures/list_borders.svg"}) {
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
