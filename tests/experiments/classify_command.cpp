#include <catch2/generators/catch_generators.hpp>

#include "program.hpp"

namespace {

const std::string disjoint = "0 0 0 1 0 0 0 1 0  5 5 5 6 5 5 5 6 5\n";
const std::string crossing = "0,0,0, 1,0,0, 0,1,0,\t.25 0x1p-2 -1 .25 .25 1e0 +2 2 0x1.8p+1 # a comment\r\n";

}  // namespace

TEST_CASE_METHOD(in_folder, "classify prints 0 or 1 per line") {
    const std::string lines = "# two pairs\n\n" + disjoint + "  \t\n" + crossing;
    const program_result from_file = run_well({"classify", folder.write("pairs.txt", lines)});
    REQUIRE(from_file.out == "0\n1\n");
    REQUIRE(from_file.err.empty());
    REQUIRE(run_program({"classify", "-"}, lines).out == "0\n1\n");
    REQUIRE(run_program({"classify", "-", "--triangle", "moller"}, lines).out == "0\n1\n");
}

TEST_CASE("classify rounds each number once, directly to float") {
    // Slightly above 1 + 2^-24: the nearest float is 1 + 2^-23, but rounding to double first would give 1.
    const std::string touching =
        "0 0 0x1.000002p0 1 0 0x1.000002p0 0 1 0x1.000002p0  .2 .2 1.00000005960464477539062500001 .2 .3 0 .3 .2 0\n";
    REQUIRE(run_program({"classify", "-"}, touching).out == "1\n");
    REQUIRE(run_program({"classify", "-", "--double"}, touching).out == "0\n");
}

TEST_CASE("classify --double keeps doubles") {
    const std::string just_above = "0 0 0 1 0 0 0 1 0  .2 .2 1e-60 .2 .3 1 .3 .2 1\n";
    REQUIRE(run_program({"classify", "-"}, just_above).out == "1\n");
    REQUIRE(run_program({"classify", "-", "--double"}, just_above).out == "0\n");
    run_refused({"classify", "-", "--double", "--triangle", "moller"}, just_above);
}

TEST_CASE("classify --geometry prints kind, corners and error of an intersection") {
    const std::string face = "0 0 0 4 0 0 0 4 0  ";
    const auto geometry_of = [&](const std::string& other, const std::vector<std::string>& options) {
        return run_well(joined({"classify", "-", "--geometry"}, options), face + other + "\n").out;
    };
    const std::vector<std::vector<std::string>> variants = {
        {}, {"--double"}, {"--triangle", "epeck"}, {"--triangle", "epeck", "--double"}};
    for (const auto& options : variants) {
        CHECK(geometry_of("5 5 5 6 5 5 5 6 5", options) == "none 0 0 0 0\n");
        CHECK(geometry_of("1 1 0 1 1 3 2 1 3", options) == "point 1 1 1 0 0 0 0\n");
        CHECK(geometry_of("1 1 0 2 1 0 1 2 0", options).starts_with("overlap 3 "));
        CHECK(geometry_of("1 1 0 2 1 0 1 2 0", options).ends_with(" 0 0 0\n"));
        const std::string segment = geometry_of("1 0 0 2 0 0 1 0 3", options);
        CHECK((segment == "segment 2 1 0 0 2 0 0 0 0 0\n" || segment == "segment 2 2 0 0 1 0 0 0 0 0\n"));
    }
    // Both endpoints are constructed, so `exact` states an error; `epeck` only rounds, and these are doubles.
    const std::string through = "1 1 -1 1 1 3 2 1 3";
    std::istringstream words(geometry_of(through, {}));
    std::string kind;
    int corners = 0;
    double x[2] = {}, y[2] = {}, z[2] = {}, error[3] = {};
    words >> kind >> corners >> x[0] >> y[0] >> z[0] >> x[1] >> y[1] >> z[1] >> error[0] >> error[1] >> error[2];
    REQUIRE(words);
    CHECK(kind == "transversal");
    CHECK(corners == 2);
    CHECK(std::abs(x[0] + x[1] - 2.25) <= 2 * error[0]);
    CHECK(std::abs(y[0] + y[1] - 2) <= 2 * error[1]);
    CHECK(std::abs(z[0]) + std::abs(z[1]) <= 2 * error[2]);
    CHECK_BETWEEN(0, error[0], 1e-14);
    CHECK(error[1] == 0);
    CHECK(geometry_of(through, {"--triangle", "epeck"}).ends_with(" 0 0 0\n"));
    // A tenth, as float and as double.
    CHECK(geometry_of(".1 1 0 .1 1 3 .1 2 3", {}) == "point 1 0.10000000149011612 1 0 0 0 0\n");
    CHECK(geometry_of(".1 1 0 .1 1 3 .1 2 3", {"--double"}) == "point 1 0.1 1 0 0 0 0\n");
}

TEST_CASE("classify rejects --geometry for tests that only decide") {
    for (const std::string test : {"moller", "devillers_guigue", "epick", "interval_arithmetic:fallback=exact"}) {
        const program_result rejected = run_refused({"classify", "-", "--geometry", "--triangle", test}, crossing);
        CHECK(rejected.out.empty());
        CHECK(rejected.err ==
              "aabblab: --geometry: " + test.substr(0, test.find(':')) +
                  " decides whether triangles intersect, but does not construct their intersection; give "
                  "--triangle exact or epeck\n");
    }
}

TEST_CASE("classify reports a wrong number with its line, after the results before it") {
    const auto [line, message] = GENERATE(table<std::string, std::string>({
        {"1 2 3", "standard input:3: expected 18 numbers, two triangles, not 3"},
        {"1, 2,, 3", "standard input:3: a number is missing before a comma"},
        {"1 2 3,", "standard input:3: a number is missing after the last comma"},
        {"1 2 x 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9", "standard input:3: number 3 of 18: 'x' is not a number"},
        {"1 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 nan", "number 18 of 18: 'nan' is not finite"},
        {"-inf 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9", "number 1 of 18: '-inf' is not finite"},
        {"1e39 2 3 4 5 6 7 8 9 1 2 3 4 5 6 7 8 9", "number 1 of 18: '1e39' is too large"},
    }));
    const program_result result = run_program({"classify", "-"}, disjoint + crossing + line + "\n" + disjoint);
    REQUIRE(result.status == 2);
    REQUIRE(result.out == "0\n1\n");
    REQUIRE(is_one_sentence(result.err));
    REQUIRE(holds(result.err, message));
}
