#pragma once

#include "../experiments/program.hpp"

import aabblab.configs;
import aabblab.suites;

// Small studies of error against run time, of bodies in contact, and a small atlas, for reports.

/// The name of the first one's figure.
inline const std::string lists_figure = "wrong_share_over_whole_cpu_ms_brownian-objects-200-frames-6";

/// The config of a small study of lists. What `others` names of each curve is a default elsewhere.
inline std::string lists_config(const std::string& others = "") {
    std::string text =
        "name = \"lists\"\n[[scene]]\nkind = \"brownian\"\nobjects = 200\nframes = 6\n[measure]\nrepeats = 5\n"
        "[[plot]]\nx = \"whole_cpu_ms\"\ny = \"wrong_share\"\n";
    for (const char* curve : {"label = \"no list\"\nprepare = \"none\"\n",
                              "label = \"over margin\"\nprepare = { name = \"neighbour_list\", margin = [0.1, 0.5] }\n",
                              "label = \"over every\"\nprepare = { name = \"neighbour_list\", margin = 0, every = [2, "
                              "4] }\n"})
        text += std::string("[[curve]]\n") + curve + others;
    return text;
}

/// Small studies of error against run time, which are run.
inline void write_studies(const std::filesystem::path& folder) {
    const temporary_folder configs;
    const auto run = [&](const std::string& name, const std::string& text) {
        run_well({"errors", configs.write(name + ".toml", text), "--out", folder / "errors" / name});
    };
    run("lists", lists_config());
    run("tests",
        "name = \"tests\"\n[[pairs]]\nclass = [\"random\", \"small\"]\ncount = 2000\n[[scene]]\nkind = "
        "\"mesh_pair\"\nmeshes = \"icosphere:triangles=320\"\nframes = 2\n[[curve]]\ntriangle = \"exact\"\n[[curve]]\n"
        "label = \"GJK over iterations\"\ntriangle = { name = \"gjk\", iterations = [1, 3, 5] }\n");
}

/// A small atlas, which is run: scenes of the map, at rest in part, and another.
inline void write_atlas(const std::filesystem::path& folder) {
    const temporary_folder configs;
    const auto run = [&](const std::string& name, const std::string& scenes) {
        const std::string config =
            configs.write(name + ".toml", "name = \"" + name + "\"\n" + scenes +
                                              "[[compose]]\nauto = true\n[[compose]]\nsort = [\"std\", \"insertion\"]\n"
                                              "[[compose]]\nprepare = [\"none\", { name = \"neighbour_list\", margin = "
                                              "0.1 }]\n[measure]\nrepeats = 2\n");
        const aabblab::experiment e = aabblab::read_experiment(config, aabblab::experiment_size::full);
        REQUIRE(measure_part_of_atlas(e, folder / "atlas" / name).empty());
    };
    run("atlas",
        "[[scene]]\nkind = \"cloud\"\nobjects = [300, 600]\ndisplacement = [0.01, 1]\nratio = [1, 10]\nclouds = [1, "
        "2]\n"
        "frames = 3\n[[scene]]\nkind = \"cloud\"\nobjects = 300\nmoving = 0.5\nframes = 3\n");
    run("atlas_unseen", "[[scene]]\nkind = \"free_fall\"\nobjects = 300\nframes = 3\n");
}
