#include "studies.hpp"
#include "worlds.hpp"

import aabblab.claims;

TEST_CASE("An independent program in Python computes the same ratios, intervals, verdicts and figures", "[long]") {
    const temporary_folder folder;
    worlds::write_world(folder.path(), 0.9, 0.15);
    write_studies(folder.path());
    run_well({"reproduce", "--judge", "--out", folder.path().string()});
    const auto recomputed = [&] {
        return run_command({"python3", AABBLAB_CONFIGS "/../../tests/paper/recompute.py", folder.path()});
    };
    const program_result same = recomputed();
    INFO(same.out + same.err);
    CHECK(same.status == 0);
    CHECK(same.out.ends_with("of " + std::to_string(aabblab::stated().claims.size()) +
                             " claims recomputed, 0 differences\n"));

    // Of the claims, of triangle tests and of lists.
    CHECK(holds(same.out, "recomputed; not recomputed: verdicts\n"));

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
    const program_result altered = recomputed();
    INFO(altered.out + altered.err);
    CHECK(altered.status == 1);
    // A renamed curve is two.
    CHECK(altered.out.ends_with(" 7 differences\n"));
}
