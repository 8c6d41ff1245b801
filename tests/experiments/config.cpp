#include <catch2/generators/catch_generators.hpp>

#include "configs.hpp"

import aabb.registry;
import aabblab.metrics;

using aabblab::experiment;
using aabblab::experiment_size;

namespace {

/// The smallest valid config.
const std::string minimal = "name = \"test\"\n[[scene]]\nkind = \"brownian\"\nobjects = 10\n";
const std::string compose = minimal + "[compose]\n";
const std::string measure = minimal + "[measure]\n";

experiment parsed(const std::string& text, experiment_size size = experiment_size::full) {
    return aabblab::parse_experiment(text, "test.toml", size);
}

}  // namespace

TEST_CASE("A minimal config has the default composition, nine repeats and all metrics") {
    const experiment e = parsed(minimal);
    REQUIRE(e.name == "test");
    REQUIRE(e.repeats == 9);
    REQUIRE(e.compositions == std::vector<aabb::composition>(1));
    REQUIRE(e.engines.empty());
    REQUIRE(e.scenes.size() == 1);
    REQUIRE(e.scenes[0].seed == 1);
    REQUIRE(e.recorded.size() == aabblab::metric_groups.size());
    REQUIRE(e.shown.empty());
}

TEST_CASE("others_but adds the unnamed strategies that can be combined") {
    const auto compositions = [](const std::string& strategies) { return parsed(compose + strategies).compositions; };
    const std::string rest = "partition = \"none\"\nsweep = [\"one_axis\", \"incremental\"]\n";
    // incremental can only be combined with insertion.
    std::vector<std::string> sorts;
    for (const aabb::composition& c : compositions("sort = [\"insertion\", { others_but = [\"shell\"] }]\n" + rest))
        sorts.push_back(to_text(c, aabb::stage::global_search));
    REQUIRE(sorts.front() == "insertion + none + one_axis");
    REQUIRE(std::set(sorts.begin(), sorts.end()).size() == aabb::strategies(aabb::strategy_kind::sort).size());
    REQUIRE(std::ranges::count(sorts, "insertion + none + incremental") == 1);
    REQUIRE(std::ranges::count(sorts, "shell + none + one_axis") == 0);
    REQUIRE(rejection_of(compose + "sort = [\"std\", { others_but = [\"shall\"] }]\n") ==
            "test.toml:6: unknown sort 'shall'; did you mean 'shell'?");
}

TEST_CASE("others_but adds the unnamed scenes without meshes or files") {
    const auto config_with = [](const std::string& kinds) {
        return "name = \"test\"\n[[scene]]\nframes = 1\nkind = " + kinds + "\n[compose]\nsort = \"std\"\n";
    };
    std::set<std::string> expected;
    for (const aabblab::scene_info& info : aabblab::scene_kinds())
        if (!info.has_meshes && !info.reads_file && info.name != "pile") expected.insert(info.name);
    std::vector<std::string> listed;
    for (const auto& scene : parsed(config_with("[\"still\", { others_but = [\"pile\"] }]")).scenes)
        listed.push_back(scene.kind);
    CHECK(listed.front() == "still");
    CHECK(std::set(listed.begin(), listed.end()) == expected);
    CHECK(listed.size() == expected.size());
    CHECK(rejection_of(config_with("[{ others_but = [\"pill\"] }]")).starts_with("test.toml:4: unknown scene 'pill'"));
}

TEST_CASE("Lists in a config multiply") {
    const experiment e = parsed(R"(
name = "test"
seed = [1, 2]
[[scene]]
kind = "brownian"
objects = [10, 20]
frames = 3
[compose]
sort = ["insertion", "std"]
partition = ["none", { name = "uniform_grid", cell_size = [1, 2.5] }]
tree = [{ name = "leafless", leaf_test = ["none", "triangle_aabb"] }]
[measure]
metrics = ["time", "bytes"]
)");
    REQUIRE(e.scenes.size() == 4);
    REQUIRE(aabblab::parameters_text(e.scenes[0]) == "objects=10 frames=3 seed=1");
    REQUIRE(aabblab::parameters_text(e.scenes[1]) == "objects=10 frames=3 seed=2");
    REQUIRE(aabblab::parameters_text(e.scenes[3]) == "objects=20 frames=3 seed=2");
    REQUIRE(e.compositions.size() == 2 * 3 * 2);
    REQUIRE(to_text(e.compositions[5], aabb::stage::global_search) ==
            "insertion + uniform_grid:cell_size=2.5 + one_axis");
    REQUIRE(to_text(e.compositions[5], aabb::stage::local_detection) == "leafless:leaf_test=triangle_aabb + exact");
    REQUIRE(e.recorded == std::set{aabblab::metric_group::time, aabblab::metric_group::bytes});
}

TEST_CASE("Several compose tables multiply separately") {
    const experiment e = parsed(minimal + R"(
[[compose]]
sort = ["insertion", "shell"]
partition = "axial_cut"
prepare = ["none", { name = "split_large", size = [4, 2.5] }]
[[compose]]
sort = "insertion"
sweep = "incremental"
)");
    REQUIRE(e.compositions.size() == 2 * 3 + 1);
    // The last kind varies fastest.
    REQUIRE(to_text(e.compositions[4], aabb::stage::global_search) ==
            "split_large:size=2.5 + insertion + axial_cut + one_axis");
    REQUIRE(to_text(e.compositions[6], aabb::stage::global_search) == "insertion + none + incremental");
}

TEST_CASE("split_mesh is rejected for scenes of boxes and accepted for scenes of meshes") {
    const std::string splits = "[compose]\nprepare = [\"none\", \"split_mesh\"]\n";
    REQUIRE(rejection_of(minimal + splits)
                .ends_with("split_mesh divides meshes, but the scene has only boxes; split_large divides boxes"));
    // The message has the line of the strategy.
    REQUIRE(holds(rejection_of(minimal + splits), ":6: brownian: split_mesh divides"));
    REQUIRE(
        holds(rejection_of(minimal + "[[compose]]\nsort = \"std\"\n[[compose]]\nprepare = { name = \"split_mesh\" }\n"),
              ":8: brownian: split_mesh divides"));
    const experiment e = parsed("name = \"x\"\n[[scene]]\nkind = \"mesh_swarm\"\nmeshes = [\"icosphere\"]\n" + splits);
    REQUIRE(e.compositions.size() == 2);
}

TEST_CASE("A named metric is recorded and shown, a group only recorded") {
    const experiment e = parsed(measure + "metrics = [\"time\", \"box_tests\", \"tree_bytes\"]\n");
    REQUIRE(e.recorded ==
            std::set{aabblab::metric_group::time, aabblab::metric_group::counts, aabblab::metric_group::bytes});
    REQUIRE(e.shown == std::vector<std::string>{"box_tests", "tree_bytes"});
}

TEST_CASE("Former keys and parameters are rejected with the new spelling") {
    REQUIRE(rejection_of(compose + "split_large = 4\n")
                .ends_with("'split_large' is a strategy, not a kind; write prepare = \"split_large\", or { name = "
                           "\"split_large\", … } with its parameters"));
    REQUIRE(
        rejection_of(compose + "tree = { name = \"leafless\", build = \"sah\" }\n")
            .ends_with(
                "leafless has no parameter build, which is a kind of its own: write build = \"sah\" or --build sah"));
}

TEST_CASE("A config accepts the command-line syntax of strategies and checks values under quick") {
    const experiment e = parsed(compose + "partition = \"axial_cut:axes=3\"\n");
    REQUIRE(to_text(e.compositions[0], aabb::stage::global_search) == "std + axial_cut:axes=3 + one_axis");
    REQUIRE_THROWS(parsed(minimal + "quick = { objects = -1 }\n"));
}

TEST_CASE("The option --quick applies the values under quick") {
    const std::string text = minimal + "frames = 7\nquick = { objects = 5 }\n[measure]\nrepeats = 20\n";
    REQUIRE(parsed(text).repeats == 20);
    REQUIRE(aabblab::parameters_text(parsed(text).scenes[0]) == "objects=10 frames=7 seed=1");
    const experiment quick = parsed(text, experiment_size::quick);
    REQUIRE(quick.repeats == 3);
    REQUIRE(aabblab::parameters_text(quick.scenes[0]) == "objects=5 frames=7 seed=1");
    REQUIRE(aabblab::hash_of(quick) != aabblab::hash_of(parsed(text)));
    REQUIRE(parsed(text + "quick = { repeats = 2 }\n", experiment_size::quick).repeats == 2);
    REQUIRE(
        parsed(text + "processes = 5\nquick = { repeats = 6, processes = 3 }\n", experiment_size::quick).processes ==
        3);
    const std::string second = minimal + "[[scene]]\nkind = \"lattice\"\nquick = false\n";
    REQUIRE(parsed(second).scenes.size() == 2);
    REQUIRE(parsed(second, experiment_size::quick).scenes.size() == 1);
    REQUIRE(parsed(second, experiment_size::quick).scenes[0].kind == "brownian");
}

TEST_CASE("The hash of a config ignores formatting and covers every value") {
    const auto text = minimal + "frames = 7\n[compose]\nsort = [\"insertion\", \"std\"]\n[measure]\nrepeats = 9\n";
    const auto changed = [&](const std::string& from, const std::string& to) {
        return aabblab::hash_of(parsed(replaced(text, from, to)));
    };
    const std::string hash = aabblab::hash_of(parsed(text));
    REQUIRE(aabblab::hash_of(parsed("# a comment\n" + text)) == hash);
    REQUIRE(changed("frames = 7", "frames   =   7  # few") == hash);
    REQUIRE(changed("frames = 7", "frames = 8") != hash);
    REQUIRE(changed("\"insertion\", \"std\"", "\"std\", \"insertion\"") != hash);
    REQUIRE(changed("repeats = 9", "repeats = 8") != hash);
    REQUIRE(changed("repeats = 9", "repeats = 9\nmetrics = [\"time\"]") != hash);
    REQUIRE(aabblab::hash_of(parsed("engines = [\"cgal\"]\n" + text)) != hash);
}

TEST_CASE("The keys ask and caches are checked and part of the hash") {
    const std::string meshes =
        "name = \"m\"\n[[scene]]\nkind = \"mesh_pair\"\nmeshes = [\"icosphere:triangles=80\"]\nframes = 2\n";
    REQUIRE(parsed(meshes).query == aabblab::query_settings{});
    const experiment first = parsed(meshes + "[measure]\nask = \"first\"\ncaches = \"cold\"\n");
    REQUIRE(first.query == aabblab::query_settings{aabblab::query_kind::first, true});
    REQUIRE(first.notes.size() == 2);
    const std::string plain = aabblab::hash_of(parsed(meshes));
    REQUIRE(aabblab::hash_of(parsed(meshes + "[measure]\nask = \"pairs\"\ncaches = \"warm\"\n")) == plain);
    REQUIRE(aabblab::hash_of(parsed(meshes + "[measure]\nask = \"count\"\n")) != plain);
    REQUIRE(aabblab::hash_of(parsed(meshes + "[measure]\ncaches = \"cold\"\n")) != plain);
    REQUIRE(rejection_of(meshes + "[measure]\nask = \"frist\"\n")
                .ends_with(":7: unknown ask 'frist'; did you mean 'first'?"));
    for (const std::string line : {"caches = \"cold\"", "ask = \"first\""})
        REQUIRE(
            rejection_of(measure + line + "\n").ends_with(line + " is for scenes of meshes, and brownian has none"));
}

TEST_CASE("The key motion is checked and part of the hash") {
    REQUIRE(parsed(measure + "motion = \"given\"\n").query == aabblab::query_settings{.says_moved = true});
    REQUIRE(parsed(measure + "motion = \"given\"\n").notes.size() == 1);
    const std::string plain = aabblab::hash_of(parsed(measure));
    REQUIRE(aabblab::hash_of(parsed(measure + "motion = \"compared\"\n")) == plain);
    REQUIRE(aabblab::hash_of(parsed(measure + "motion = \"given\"\n")) != plain);
    REQUIRE(rejection_of(measure + "motion = \"gvien\"\n").ends_with("unknown motion 'gvien'; did you mean 'given'?"));
    REQUIRE(rejection_of("name = \"m\"\n[[scene]]\nkind = \"mesh_pair\"\nmeshes = [\"icosphere:triangles=80\"]\n"
                         "[measure]\nmotion = \"given\"\n")
                .ends_with(":6: motion = \"given\" is for scenes of boxes, and mesh_pair has meshes"));
}

TEST_CASE_METHOD(in_folder, "A changed mesh file changes the hash") {
    const auto hash_with = [&](const std::string& vertex) {
        const std::string file = folder.write("one.off", "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n" + vertex + "\n3 0 1 3\n");
        return aabblab::hash_of(parsed("name = \"test\"\n[[scene]]\nkind = \"mesh_pair\"\nmeshes = [\"" + file +
                                       "\", \"icosphere:triangles=20\"]\n"));
    };
    const std::string before = hash_with("0 2 0");
    REQUIRE(hash_with("0 3 0") != before);
    REQUIRE(hash_with("0 2 0") == before);
}

TEST_CASE("Missing meshes are replaced by those of without_data, with a note") {
    const std::string scene =
        "name = \"test\"\n[[scene]]\nkind = \"mesh_pair\"\nmeshes = [\"no_such.off\", \"icosphere:triangles=20\"]\n";
    const experiment e = parsed(scene + "without_data = [\"icosphere:triangles=20\", \"torus_knot:triangles=96\"]\n");
    REQUIRE(e.scenes[0].meshes == std::vector<std::string>{"icosphere:triangles=20", "torus_knot:triangles=96"});
    REQUIRE(e.notes.size() == 1);
    REQUIRE(e.notes[0].starts_with("no_such.off does not exist"));
    REQUIRE(e.notes[0].ends_with(" in line 2 uses icosphere:triangles=20, torus_knot:triangles=96 instead"));
    REQUIRE(rejection_of(scene).find("test.toml:2: ") == 0);
    REQUIRE(holds(rejection_of(scene), "no_such.off"));
}

TEST_CASE("Errors in a config are reported in one sentence with their line") {
    const auto [text, place, message] = GENERATE_COPY(table<std::string, std::string, std::string>({
        {"name = \"x\nseed = 1\n", ":1:10: ", "this is not TOML"},
        {"name = \"x\"\nseed = = 1\n", ":2:8: ", "this is not TOML"},
        {compose + "sort = \"std\"\nsort = \"std\"\n", ":7:", "this is not TOML"},
        {"seed = 1\n", ":1: ", "has no name"},
        {"name = \"a/b\"\n", ":1: ", "'a/b' must consist of letters, digits, - and _"},
        {"name = 3\n", ":1: ", "name is a number; expected a name"},
        {"name = \"x\"\n", ":1: ", "has no scene"},
        {"name = \"x\"\n[scene]\nkind = \"brownian\"\n", ":2: ", "[[scene]]"},
        {"name = \"x\"\nscenes = 1\n", ":2: ", "unknown key 'scenes'; did you mean 'scene'?"},
        {"name = \"x\"\n[[scene]]\nobjects = 3\n", ":2: ", "this scene has no kind"},
        {"name = \"x\"\n[[scene]]\nkind = \"brownain\"\n",
         ":3: ", "unknown scene 'brownain'; did you mean 'brownian'?"},
        {minimal + "object = 3\n", ":5: ", "unknown key of scene brownian 'object'; did you mean 'objects'?"},
        {minimal + "quick = { object = 3 }\n", ":5: ", "did you mean 'objects'?"},
        {minimal + "quick = false\n", ":2: ", "every scene of this config is left out by quick = false"},
        {minimal + "quick = true\n", ":5: ", "expected a table"},
        {"name = \"x\"\n[[scene]]\nkind = \"mesh_swarm\"\nmeshes = []\n",
         ":4: ", "meshes is an empty list; expected at least one mesh"},
        {measure + "metrics = []\n", ":6: ", "metrics is an empty list; expected at least one metric"},
        {measure + "repeats = 99999999999\n", ":6: ", "repeats must be at most 1000000"},
        {minimal + "meshes = [\"icosphere\"]\n", ":5: ", "unknown key of scene brownian 'meshes'"},
        {minimal + "frames = \"many\"\n", ":2: ", "frames must be"},
        {minimal + "frames = []\n", ":5: ", "frames is an empty list"},
        {minimal + "frames = [1, 1]\n", ":5: ", "frames lists '1' twice"},
        {minimal + "frames = { a = 1 }\n", ":5: ", "frames is a table; expected a value or a list of values"},
        {minimal + "frames = 1979-05-27\n", ":5: ", "frames is a date or time"},
        {minimal + "seed = [1,\n2, 1]\n", ":6: ", "seed lists '1' twice"},
        {minimal + "seed = -1\n", ":5: ", "seed must be a whole number, at least 0, not -1"},
        {minimal + minimal.substr(14), ":5: ", "this scene is listed twice: brownian objects=10 seed=1"},
        {"engines = [\"cgall\"]\n" + minimal, ":1: ", "unknown engine 'cgall'; did you mean 'cgal'?"},
        {"engines = 3\n" + minimal, ":1: ", "engines is a number; expected a list or a name"},
        {"engines = [\"cgal\", \"cgal\"]\n" + minimal, ":1: ", "engines lists 'cgal' twice"},
        {compose + "sortt = \"std\"\n", ":6: ", "unknown key of [compose] 'sortt'; did you mean 'sort'?"},
        {compose + "sort = [\"std\",\n\"insert\"]\n", ":7: ", "unknown sort 'insert'; did you mean 'insertion'?"},
        {compose + "sort = []\n", ":6: ", "sort is an empty list"},
        {compose + "sort = 3\n", ":6: ", "sort is a number; expected a name"},
        {compose + "sort = { gaps = \"ciura\" }\n", ":6: ", "sort has no name"},
        {compose + "sort = [\"std\", \"std\"]\n", ":6: ", "sort lists 'std' twice"},
        {compose + "partition = { name = \"uniform_grid\", cellsize = 2 }\n", ":6: ", "did you mean 'cell_size'?"},
        {compose + "partition = { name = \"uniform_grid\", cell_size = -2 }\n",
         ":6: ", "cell_size must be a number above 0 or auto, not '-2'"},
        {measure + "repeats = 0\n", ":6: ", "repeats must be a whole number, at least 1, not 0"},
        {measure + "repeats = \"3\"\n", ":6: ", "repeats must be a whole number, at least 1, not the text \"3\""},
        {measure + "repeats = 2.5\n", ":6: ", "repeats must be a whole number, at least 1, not 2.5"},
        {measure + "metrics = [\"times\"]\n", ":6: ", "unknown metric 'times'; did you mean 'time'?"},
        {measure + "metrics = [\"box_test\"]\n", ":6: ", "did you mean 'box_tests'?"},
        {measure + "metrics = [\"xyzzyq\"]\n", ":6: ", "unknown metric 'xyzzyq'; see aabblab list metrics"},
        {measure + "metric = []\n", ":6: ", "did you mean 'metrics'?"},
    }));
    const std::string sentence = rejection_of(text);
    INFO(text << "\n" << sentence);
    REQUIRE(sentence.starts_with("test.toml" + place));
    REQUIRE(holds(sentence, message));
    REQUIRE(sentence.find('\n') == std::string::npos);
}

TEST_CASE_METHOD(in_folder, "A config that does not exist is rejected by name") {
    REQUIRE_THROWS_WITH(
        aabblab::read_experiment(folder / "first.toml", experiment_size::full),
        Catch::Matchers::EndsWith("first.toml does not exist; did you mean " AABBLAB_CONFIGS "/first.toml?"));
    REQUIRE(aabblab::read_experiment(folder.write("yes.toml", minimal), experiment_size::full).text == minimal);
}

TEST_CASE("The configs of the repository are valid in both sizes") {
    const std::string config = GENERATE(
        "first.toml", "global_search.toml", "local_detection.toml", "trees.toml", "exactness.toml",
        "exactness_meshes.toml", "peers/brownian.toml", "peers/engines.toml", "peers/scenes.toml", "peers/growth.toml",
        "peers/ten_million.toml", "peers/threads.toml", "peers/meshes.toml", "peers/meshes_ordered.toml",
        "peers/meshes_kept.toml", "peers/meshes_cold.toml", "peers/meshes_counted.toml", "peers/first_pair.toml",
        "peers/builds.toml", "peers/slivers.toml", "auto/change.toml", "auto/regret.toml", "auto/regret_meshes.toml",
        "auto/regret_short.toml", "auto/regret_small.toml", "auto/regret_unseen.toml");
    for (const experiment_size size : {experiment_size::full, experiment_size::quick})
        REQUIRE_NOTHROW(aabblab::read_experiment(std::string(AABBLAB_CONFIGS) + "/" + config, size));
    // Their full sizes have twenty million triangles.
    for (const char* large : {"/peers/meshes_growth.toml", "/peers/refit.toml"})
        REQUIRE_NOTHROW(aabblab::read_experiment(std::string(AABBLAB_CONFIGS) + large, experiment_size::quick));
}
