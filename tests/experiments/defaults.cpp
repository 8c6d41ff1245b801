#include <nlohmann/json.hpp>

#include "program.hpp"

import aabblab.atlas;
import aabblab.results;

TEST_CASE_METHOD(in_folder, "A finished run states the defaults that completed its config, and the atlas uses them") {
    folder.write("small.toml",
                 "name = \"atlas\"\n[[scene]]\nkind = \"cloud\"\nobjects = 50\nframes = 3\n"
                 "[[compose]]\nsort = [{ name = \"shell\", gaps = \"shell\" }, \"shell\"]\n[measure]\nrepeats = 2\n");
    run_well({"run", folder / "small.toml", "--out", folder / "run"});
    auto manifest = nlohmann::ordered_json::parse(bytes_of_file(folder / "run/manifest.json"));
    CHECK(manifest["config"]["file"] == "small.toml");
    CHECK(manifest["defaults"]["strategies"]["sort"]["shell"]["gaps"] == "ciura");
    CHECK(manifest["defaults"]["strategies"]["sweep"]["one_axis"]["axis"] == "auto");
    CHECK_FALSE(manifest["defaults"]["strategies"].contains("tree"));  // a scene of boxes
    const std::string density = manifest["defaults"]["scenes"]["cloud"]["density"];
    const std::vector<aabblab::atlas_scene> atlas = aabblab::read_atlas(folder / "run", /*is_held_out=*/false);
    REQUIRE(atlas.size() == 1);
    CHECK(atlas[0].number("density") == std::stod(density));

    // As if the run's version had had another default.
    manifest.erase("seal");
    manifest["defaults"]["scenes"]["cloud"]["density"] = "0.9";
    std::ofstream(folder / "run/manifest.json") << manifest.dump(2) << "\n";
    CHECK(aabblab::read_scene_defaults(folder / "run").at(0).kind == "cloud");
    const std::vector<aabblab::atlas_scene> other = aabblab::read_atlas(folder / "run", /*is_held_out=*/false);
    CHECK(other.at(0).number("density") == 0.9);
    CHECK(other[0].number("objects") == 50);
    // Its measures are those of the scene with that default.
    CHECK(other[0].measures.pairs_per_object > atlas[0].measures.pairs_per_object);
    CHECK(other[0].scene == atlas[0].scene);

    // Results of earlier versions state none.
    manifest.erase("defaults");
    std::ofstream(folder / "run/manifest.json") << manifest.dump(2) << "\n";
    CHECK(aabblab::read_scene_defaults(folder / "run").empty());
    CHECK(aabblab::read_atlas(folder / "run", /*is_held_out=*/false).at(0).number("density") == std::stod(density));
    manifest["defaults"] = {{"scenes", {{"cloud", {{"density", 1}}}}}};
    std::ofstream(folder / "run/manifest.json") << manifest.dump(2) << "\n";
    CHECK_THROWS_AS(aabblab::read_scene_defaults(folder / "run"), aabb::input_error);
}
