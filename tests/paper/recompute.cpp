#include "studies.hpp"
#include "worlds.hpp"

import aabblab.claims;

TEST_CASE("An independent program in Python computes the same ratios, intervals, verdicts and figures", "[long]") {
    const temporary_folder folder;
    worlds::write_world(folder.path(), 0.9, 0.15);
    write_studies(folder.path());
    write_atlas(folder.path());
    run_well({"validate", "stiff", "plate", "--quick", "--out", folder / "stiff"});
    run_well({"reproduce", "--judge", "--out", folder.path().string()});
    const auto recomputed = [&] {
        return run_command({"python3", AABBLAB_CONFIGS "/../../tests/paper/recompute.py", folder.path()});
    };
    const program_result same = recomputed();
    INFO(same.out + same.err);
    CHECK(same.status == 0);
    CHECK(same.out.ends_with("of " + std::to_string(aabblab::stated().claims.size()) +
                             " claims recomputed, 0 differences\n"));

    CHECK(holds(same.out, "recomputed; not recomputed: none\n"));
    for (const char* figure : {"verdicts", "c12", "tunnelled", "map_1", "map_classic_2", "map_inversions", "regret"})
        CHECK(std::filesystem::exists(folder / "figures" / (std::string(figure) + ".csv")));

    // It detects altered ratios, verdicts and points.
    const auto alter = [&](const char* file, const std::string& what, const std::string& instead) {
        folder.write(file, replaced(bytes_of_file(folder / file), what, instead));
    };
    alter("endpoints.csv", ",0.9", ",0.7");
    alter("endpoints.csv", ",less,for", ",more,for");
    alter("verdicts.csv", ",holds,", ",undecided,");
    const auto add_point = [&](const std::string& figure, const char* line) {
        folder.write("figures/" + figure + ".csv", bytes_of_file(folder / "figures" / (figure + ".csv")) + line);
    };
    add_point("c12", "2,5,1,1,1,axial cut\n");
    add_point("errors_float", "2,5,1,1,1,exact,5,5,\n");
    alter(("figures/" + lists_figure + ".csv").c_str(), "no list", "some list");
    add_point("verdicts", "4,0,1.01,1,1.02,undecided,C1a\n");
    // A closed form, and what a row states.
    alter("figures/tunnelled.csv", ",2,0.5,0.5,0.5,1 - extent", ",2,0.5001,0.5,0.5,1 - extent");
    alter("stiff/plate.csv", "\"a step of 4 extents, plain\",share of 200 shots that tunnel,0.75,",
          "\"a step of 4 extents, plain\",share of 200 shots that tunnel,0.74,");
    add_point("map_1", "5,100,0.5,0.5,0.5,another,a panel\n");
    add_point("regret", "2,0.5,9,9,9,std + one_axis\n");
    // Results of earlier versions have no measures, without which one figure of each set cannot be recomputed.
    for (const char* part : {"atlas", "atlas_unseen"})
        std::filesystem::remove(folder / "atlas" / part / "measures.csv");
    const program_result altered = recomputed();
    INFO(altered.out + altered.err);
    CHECK(altered.status == 1);
    CHECK(holds(altered.out,
                "not recomputed: map_classic_inversions, map_inversions (there are no measures of scenes, "
                "atlas/PART/measures.csv)\n"));
    // A renamed curve is two.
    CHECK(altered.out.ends_with(" 12 differences\n"));
}
