#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators.hpp>
#include <string>

#include "program.hpp"
#include "temporary_folder.hpp"

namespace {

const std::string apart = "0 0 0 1 0 0 0 1 0  5 5 5 6 5 5 5 6 5\n";
const std::string crossing = "0,0,0, 1,0,0, 0,1,0,\t.25 0x1p-2 -1 .25 .25 1e0 +2 2 0x1.8p+1 # a comment\r\n";

}  // namespace

TEST_CASE("classify answers 0 or 1 a line") {
    const temporary_folder folder;
    const std::string lines = "# two pairs\n\n" + apart + "  \t\n" + crossing;
    const program_result from_file = run_program({"classify", folder.write("pairs.txt", lines)});
    REQUIRE(from_file.status == 0);
    REQUIRE(from_file.out == "0\n1\n");
    REQUIRE(from_file.err.empty());
    REQUIRE(run_program({"classify", "-"}, lines).out == "0\n1\n");
    REQUIRE(run_program({"classify", "-", "--triangle", "moller"}, lines).out == "0\n1\n");
}

TEST_CASE("classify rounds each number once, straight to float") {
    // 2^-24 and a little above 1: the nearest float is 1 + 2^-23, but rounded to double first it would be 1.
    const std::string touching =
        "0 0 0x1.000002p0 1 0 0x1.000002p0 0 1 0x1.000002p0  .2 .2 1.00000005960464477539062500001 .2 .3 0 .3 .2 0\n";
    REQUIRE(run_program({"classify", "-"}, touching).out == "1\n");
    REQUIRE(run_program({"classify", "-", "--double"}, touching).out == "0\n");
}

TEST_CASE("classify keeps doubles when asked to") {
    const std::string just_above = "0 0 0 1 0 0 0 1 0  .2 .2 1e-60 .2 .3 1 .3 .2 1\n";
    REQUIRE(run_program({"classify", "-"}, just_above).out == "1\n");
    REQUIRE(run_program({"classify", "-", "--double"}, just_above).out == "0\n");
    const program_result refused = run_program({"classify", "-", "--double", "--triangle", "moller"}, just_above);
    REQUIRE(refused.status == 2);
    REQUIRE(is_one_sentence(refused.err));
}

TEST_CASE("classify names the line and the number that is wrong, after the answers before it") {
    const auto [line, said] = GENERATE(table<std::string, std::string>({
        {"1 2 3", "standard input:3: expected 18 numbers, two triangles, not 3"},
        {"1, 2,, 3", "standard input:3: a number is missing before a comma"},
        {"1 2 3,", "standard input:3: a number is missing after the last comma"},
        {"1 2 x 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9", "standard input:3: number 3 of 18: 'x' is not a number"},
        {"1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 nan", "number 18 of 18: 'nan' is not finite"},
        {"-inf 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9", "number 1 of 18: '-inf' is not finite"},
        {"1e39 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9", "number 1 of 18: '1e39' is too large"},
    }));
    const program_result result = run_program({"classify", "-"}, apart + crossing + line + "\n" + apart);
    REQUIRE(result.status == 2);
    REQUIRE(result.out == "0\n1\n");
    REQUIRE(is_one_sentence(result.err));
    REQUIRE(result.err.find(said) != std::string::npos);
}

TEST_CASE("classify refuses what is no readable file") {
    const temporary_folder folder;
    for (const std::string& file : {(folder / "missing.txt").string(), folder.path().string()}) {
        const program_result result = run_program({"classify", file});
        REQUIRE(result.status == 2);
        REQUIRE(is_one_sentence(result.err));
        REQUIRE(result.err.find(file) != std::string::npos);
    }
}
