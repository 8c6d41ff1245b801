#pragma once

#include "../experiments/program.hpp"

// Small studies of error against run time, for reports.

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
