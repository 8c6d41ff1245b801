#include "../experiments/program.hpp"

#include "worlds.hpp"

import aabblab.claims;
import aabblab.conditions;
import aabblab.reproduction;

TEST_CASE("An independent program in Python computes the same ratios, intervals and verdicts", "[long]") {
    const temporary_folder folder;
    worlds::write_world(folder.path(), 0.9, 0.15);
    const aabblab::measurements results(folder.path());
    write_reproduction(folder.path(), {&results, 1}, judged(results), {}, {});
    const auto recomputed = [&] {
        return run_command({"python3", AABBLAB_CONFIGS "/../../tests/paper/recompute.py", folder.path()});
    };
    const program_result same = recomputed();
    INFO(same.out + same.err);
    CHECK(same.status == 0);
    CHECK(same.out.ends_with("of " + std::to_string(aabblab::listed_claims().size()) +
                             " claims recomputed, 0 differences\n"));

    // It detects altered ratios and verdicts.
    const auto alter = [&](const char* file, const std::string& what, const std::string& instead) {
        folder.write(file, replaced(bytes_of_file(folder / file), what, instead));
    };
    alter("endpoints.csv", ",0.9", ",0.7");
    alter("endpoints.csv", ",less,for", ",more,for");
    alter("verdicts.csv", ",holds,", ",undecided,");
    const program_result altered = recomputed();
    INFO(altered.out + altered.err);
    CHECK(altered.status == 1);
    CHECK(altered.out.ends_with(" 3 differences\n"));
}
