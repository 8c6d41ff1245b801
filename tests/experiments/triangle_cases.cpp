#include "temporary_folder.hpp"

import aabb.base;
import aabb.extreme;
import aabblab.configs;
import aabblab.extreme;

namespace {

std::string case_named(const std::string& name, const std::string& intersect) {
    return "[[case]]\nname = \"" + name +
           "\"\nsource = \"s\"\nabout = \"a\"\nclass = \"crossing\"\n"
           "first = [[0, 0, 0], [2.0, 0, 0], [0, 2, 0]]\n"
           "second = [[0.5, 0.5, -1], [0.5, 0.5, 1], [3, 3, 0]]\nintersect = " +
           intersect + "\n";
}

std::string rejection_of(const std::string& text) {
    return refusal_in<aabb::input_error>([&] { return aabblab::parse_triangle_cases(text, "c.toml"); });
}

/// A case with the line of that key replaced.
std::string with_line(const std::string& key, const std::string& line) {
    std::istringstream in(case_named("one", "true"));
    std::string text;
    for (std::string old; std::getline(in, old);) text += (old.starts_with(key + " ") ? line : old) + "\n";
    return text;
}

}  // namespace

TEST_CASE("A file of cases is read with exact numbers") {
    const std::string least = "second = [[5e-324, -0.0, 1e-45], [3.4028234663852886e+38, 0.1, 1], [3, 3, 0]]";
    const std::vector<aabb::triangle_case> cases =
        aabblab::parse_triangle_cases(with_line("second", least) + "intersect_double = false\n", "c.toml");
    REQUIRE(cases.size() == 1);
    CHECK(cases[0].name == "one");
    CHECK(cases[0].source == "s");
    CHECK(cases[0].about == "a");
    CHECK(cases[0].kind == "crossing");
    CHECK(cases[0].first[1][0] == 2);
    CHECK(cases[0].second[0][0] == 5e-324);
    CHECK(std::signbit(cases[0].second[0][1]));
    CHECK(cases[0].second[0][2] == 1e-45);
    CHECK(cases[0].second[1][0] == double{std::numeric_limits<float>::max()});
    CHECK(cases[0].second[1][1] == 0.1);
    CHECK(cases[0].intersect);
    CHECK_FALSE(cases[0].intersect_double);
    CHECK(aabblab::parse_triangle_cases(case_named("one", "true"), "c.toml")[0].intersect_double);
}

TEST_CASE("An invalid file of cases is rejected in one sentence with file and line") {
    CHECK(rejection_of(case_named("one", "true") + case_named("two", "false")) == "accepted");
    CHECK(rejection_of("") == "c.toml has no cases; expected [[case]]");
    CHECK(rejection_of("[case]\n") == "c.toml:1: case must be in double brackets: [[case]]");
    CHECK(rejection_of("[[cases]]\n").starts_with("c.toml:1: unknown key 'cases'"));
    CHECK(rejection_of("[[case]\n").starts_with("c.toml:1:"));
    CHECK(rejection_of(with_line("about", "abuot = \"a\"")) ==
          "c.toml:4: unknown key of [[case]] 'abuot'; did you mean 'about'?");
    CHECK(rejection_of(with_line("about", "")) == "c.toml:1: this case has no about");
    CHECK(rejection_of(with_line("source", "source = 3")) == "c.toml:3: source is a number; expected a name");
    CHECK(rejection_of(with_line("intersect", "intersect = 1")) ==
          "c.toml:8: intersect is a number; expected true or false");
    const std::string corners = "first must be three corners of three coordinates each";
    CHECK(rejection_of(with_line("first", "first = [[0, 0, 0], [1, 0, 0]]")) == "c.toml:6: " + corners);
    CHECK(rejection_of(with_line("first", "first = [[0, 0, 0], [1, 0], [0, 1, 0]]")) == "c.toml:6: " + corners);
    CHECK(rejection_of(with_line("first", "first = 3")) == "c.toml:6: " + corners);
    CHECK(rejection_of(with_line("first", "first = [[0, 0, 0], [1, 0, '0'], [0, 1, 0]]")) ==
          "c.toml:6: a coordinate of first is a name; expected a number");
    for (const char* beyond : {"1e39", "inf", "-inf", "nan"})
        CHECK(rejection_of(with_line("first", std::string("first = [[0, 0, 0], [1, 0, ") + beyond + "], [0, 1, 0]]"))
                  .ends_with(", beyond the range of float"));
    CHECK(rejection_of(case_named("one", "true") + case_named("one", "true")) ==
          "c.toml:9: two cases have the name 'one'");
}

TEST_CASE_METHOD(in_folder, "Every triangle test that must be exact solves the project's own cases") {
    const std::vector<aabb::triangle_case> cases = aabblab::read_triangle_cases(AABBLAB_CASES);
    REQUIRE(cases.size() >= 100);
    const std::string text = csv_of(aabblab::run_triangle_cases(cases));
    const std::vector<aabblab::extreme_row> rows = aabblab::read_extreme_rows(folder.write("extreme.csv", text));
    for (const std::string& failure : aabblab::failures_in(rows)) FAIL_CHECK(failure);
    std::set<std::string> exact_tests;
    for (const aabblab::extreme_row& row : rows)
        if (row.role == aabblab::candidate_role::triangle_test && row.must_be_exact)
            exact_tests.insert(row.full_name());
    CHECK(exact_tests == std::set<std::string>{"epeck in double", "epeck in float", "epick in double", "epick in float",
                                               "exact in double", "exact in float", "interval_arithmetic in double",
                                               "interval_arithmetic in float"});
    CHECK_FALSE(aabblab::inexact_case_table(rows).rows.empty());
}
