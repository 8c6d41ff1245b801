#include "../experiments/program.hpp"

#include "worlds.hpp"

import aabblab.claims;
import aabblab.conditions;
import aabblab.reproduction;

TEST_CASE("A program of another language finds the same ratios, intervals and verdicts in the rows", "[long]") {
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

    // It would notice: a ratio told as another, or a verdict.
    const auto tell_otherwise = [&](const char* file, const std::string& what, const std::string& instead) {
        folder.write(file, replaced(bytes_of_file(folder / file), what, instead));
    };
    tell_otherwise("endpoints.csv", ",0.9", ",0.7");
    tell_otherwise("endpoints.csv", ",less,for", ",more,for");
    tell_otherwise("verdicts.csv", ",holds,", ",undecided,");
    const program_result otherwise = recomputed();
    INFO(otherwise.out + otherwise.err);
    CHECK(otherwise.status == 1);
    CHECK(otherwise.out.ends_with(" 3 differences\n"));
}
