#include <catch2/generators/catch_generators.hpp>

#include "configs.hpp"

using aabblab::experiment_size;

namespace {

const std::string head = "name = \"test\"\n";
const std::string scene = "[[scene]]\nkind = \"brownian\"\nobjects = 10\n";

/// "KEY = [1, 2, …]"
std::string list_of(const std::string& key, std::size_t values) {
    std::string text = key + " = [1";
    for (std::size_t i = 2; i <= values; ++i) text += ", " + std::to_string(i);
    return text + "]\n";
}

/// A line with as many choices of a strategy as sizes.
std::string prepares(std::size_t sizes) {
    std::string list = list_of("size", sizes);
    list.pop_back();
    return "prepare = { name = \"split_large\", " + list + " }\n";
}

}  // namespace

TEST_CASE("TOML that fails an assertion of the library is reported as malformed with its line") {
    const std::string value = GENERATE("[}", "[,", "[=", "[#", "[[}", "[1,}", "{a=}", "{=", "[{]", "[\n\n}");
    const std::string sentence = rejection_of(head + "a = " + value);
    INFO(value << "\n" << sentence);
    const auto line = 2 + std::count(value.begin(), value.end(), '\n');
    REQUIRE(sentence.starts_with("test.toml:" + std::to_string(line) + ":"));
    REQUIRE(holds(sentence, ": this is not TOML"));
}

TEST_CASE("Deeply nested keys and values are rejected") {
    const std::size_t parts = GENERATE(17, 30'000);
    const std::string key = repeated("a", parts, GENERATE(".", " . ", ".\"b\\\"\".", ".'='."));
    const std::string before = GENERATE("", "text = \"a#b\"\n", "text = '''a\n\"'''\n", "# '\n");
    const std::string line = before.starts_with("text = ''") ? ":4" : before.empty() ? ":2" : ":3";
    CHECK(rejection_of(head + before + key + " = 1\n") == "test.toml" + line + ": a key has more than 16 parts");
    CHECK(rejection_of(head + before + "[" + key + "]\n") == "test.toml" + line + ": a key has more than 16 parts");
    CHECK(rejection_of(head + before + "a={" + key + " = 1}\n") ==
          "test.toml" + line + ": a key has more than 16 parts");
    CHECK(holds(rejection_of(head + "a = " + std::string(parts, '[')), "maximum nested value depth"));
}

TEST_CASE("A string that ends in quotes does not hide the key after it") {
    const std::string key = repeated("c", 60'000, ".");
    for (const std::string& quote : {std::string("\""), std::string("'")})
        for (std::size_t extra = 0; extra < 3; ++extra) {
            const std::string text = repeated(quote, 3) + "x" + repeated(quote, 3 + extra);
            INFO(text);
            CHECK(rejection_of(head + "a = {b = " + text + ", " + key + " = 1}\n") ==
                  "test.toml:2: a key has more than 16 parts");
            // A short key is read: the string ends where TOML says.
            CHECK(holds(rejection_of(head + "a = {b = " + text + ", c.c = 1}\n"), "unknown key 'a'"));
        }
}

TEST_CASE("Dots outside keys do not count as key parts") {
    const std::string dotted = repeated("a", 100, ".");
    const std::string sizes = "displacement = [" + repeated("0.5", 30, ", ") + "]\n";
    CHECK(rejection_of(head + "# " + dotted + "\n" + scene) == "accepted");
    CHECK(holds(rejection_of(head + scene + sizes), "displacement lists '0.5' twice"));
    CHECK(holds(rejection_of(head + "engines = \"" + dotted + "\"\n" + scene), "unknown engine"));
    CHECK(holds(rejection_of(head + "engines = '" + dotted + "'\n" + scene), "unknown engine"));
    CHECK(holds(rejection_of(head + "engines = \"\"\"\n" + dotted + "\"\"\"\n" + scene), "unknown engine"));
}

TEST_CASE_METHOD(in_folder, "A config longer than the limit is rejected") {
    const std::string text = head + scene;
    const std::string longest = text + std::string(262'144 - text.size(), '#');
    CHECK(rejection_of(longest) == "accepted");
    CHECK(rejection_of(longest + "#") == "test.toml is longer than 262144 bytes, the limit for a config");
    REQUIRE_NOTHROW(aabblab::read_experiment(folder.write("a.toml", longest), experiment_size::full));
    REQUIRE_THROWS_AS(aabblab::read_experiment("/dev/zero", experiment_size::full), aabb::input_error);
}

TEST_CASE("Products of lists are limited before they are expanded") {
    const std::string message = "the lists multiply to more than 100000 ";
    const auto cuts = [&](std::size_t segments) {
        std::string list = list_of("segments", segments);
        list.pop_back();
        return "{ name = \"axial_cut\", axes = [1, 2, 3], limit = [\"on\", \"off\"], " + list + " }";
    };
    CHECK(rejection_of(head + scene + "[compose]\npartition = " + cuts(20'000) + "\n") ==
          "test.toml:6: " + message + "choices of partition, the limit for a config");
    // Each list is short enough, but not their product.
    const std::string splits = prepares(100);
    CHECK(rejection_of(head + scene + "[compose]\npartition = " + cuts(200) + "\n" + splits) ==
          "test.toml:5: " + message + "compositions, the limit for a config");
    // Nor is the sum of several tables.
    const std::string half = "[[compose]]\npartition = " + cuts(100) + "\n" + splits;
    const std::string first = half + "sort = \"insertion\"\n";
    CHECK(rejection_of(head + scene + first + half + "sort = \"std\"\n").starts_with("test.toml:9: " + message));
    CHECK(rejection_of(head + "[[scene]]\nkind = [\"brownian\", \"still\"]\n" + list_of("seed", 400) +
                       list_of("objects", 400)) == "test.toml:2: " + message + "scenes, the limit for a config");
}

TEST_CASE("Names are checked before lists are expanded and scenes generated") {
    CHECK(rejection_of(head + scene + "[compose]\n" + prepares(20'000) +
                       "partition = \"none\"\ntree = [\"canonical\", \"leafles\"]\ntriangle = \"exact\"\n") ==
          "test.toml:8: unknown tree 'leafles'; did you mean 'leafless'?");
    CHECK(rejection_of(head + scene + "[compose]\nsort = { name = [\"std\", \"shel\"], a = [1, 2] }\n") ==
          "test.toml:6: unknown sort 'shel'; did you mean 'shell'?");
    // A scene with this many objects does not fit into memory.
    CHECK(rejection_of(head + "[[scene]]\nkind = [\"brownian\", \"stil\"]\nobjects = 4000000000\n") ==
          "test.toml:3: unknown scene 'stil'; did you mean 'still'?");
}
