#include "../testing.hpp"

import aabb.base;
import aabblab.json;

using aabblab::json_value;

namespace {

json_value read(const std::string& text) {
    return {"a.json", text, "is not a list of things"};
}

}  // namespace

TEST_CASE("JSON members are read by type, and missing ones are empty") {
    const json_value root = read(R"({"text":"t","number":-1.5,"index":18446744073709551615,"flag":true,"none":null,
        "of":{"texts":["a","b"],"indices":[1,2],"objects":[{"x":1},{"x":2}],"numbers":[1,2.5]}})");
    CHECK(root.text("text") == "t");
    CHECK(root.number("number") == -1.5);
    CHECK(root.number("index") == 0x1p64);
    CHECK(root.index("index") == 18446744073709551615U);
    CHECK(root.flag("flag") == true);
    CHECK(root.needed("none").is_null());
    const json_value lists = root.needed("of");
    CHECK(lists.texts("texts") == std::vector<std::string>{"a", "b"});
    CHECK(lists.indices("indices") == std::vector<std::size_t>{1, 2});
    REQUIRE(lists.objects("objects").size() == 2);
    CHECK(lists.objects("objects")[1].index("x") == 2);
    CHECK(lists.numbers<2>("numbers", {}) == std::array{1.0, 2.5});
    CHECK_FALSE(root.has("nothing"));
    CHECK_FALSE(root.text("nothing").has_value());
    CHECK_FALSE(root.member("nothing").has_value());
    CHECK(root.objects("nothing").empty());
    CHECK(root.numbers<1>("nothing", {7}) == std::array{7.0});
}

TEST_CASE("JSON members of a wrong type, or missing, are rejected with their path") {
    const json_value root = read(R"({"a":[{"b":1},2,-3],"n":{"t":[1,"x"],"b":true,"f":0.5},"z":null})");
    const auto check_rejection = [&](const std::function<void()>& read_member, const std::string& sentence) {
        CHECK_REFUSED(read_member(), "a.json: " + sentence);
    };
    check_rejection([&] { (void)root.text("a"); }, "a must be a string");
    check_rejection([&] { (void)root.number("a"); }, "a must be a number");
    check_rejection([&] { (void)root.index("z"); }, "z must be a whole number");
    check_rejection([&] { (void)root.flag("z"); }, "z must be true or false");
    check_rejection([&] { (void)root.needed("n").index("f"); }, "n.f must be a whole number");
    check_rejection([&] { (void)root.needed("n").needed("b").list(); }, "n.b must be a list");
    check_rejection([&] { (void)root.needed("n").texts("t"); }, "n.t[0] must be a string");
    check_rejection([&] { (void)root.needed("n").indices("t"); }, "n.t must be a list of whole numbers");
    check_rejection([&] { (void)root.needed("n").numbers<2>("t", {}); }, "n.t must be a list of 2 numbers");
    check_rejection([&] { (void)root.objects("a"); }, "a[1] must be an object");
    check_rejection([&] { (void)root.needed("a").list()[2].index(); }, "a[2] must be a whole number");
    check_rejection([&] { (void)root.needed("a").list()[0].needed("c"); }, "a[0].c is missing");
    check_rejection([&] { (void)root.needed("z").has("x"); }, "z must be an object");
    check_rejection([&] { (void)root.needed("x"); }, "x is missing");
    check_rejection([&] { (void)read("[1]").text("a"); }, "the file must be an object");
}

TEST_CASE("Malformed JSON is rejected with its position, even if deeply nested") {
    const std::string deep = std::string(1'000'000, '[') + std::string(1'000'000, ']');
    const std::vector<std::pair<std::string, std::string>> rejected{
        {"{\n\"a\":\n1,}", "a.json:3: is not a list of things: its JSON is malformed"},
        {"", "a.json:1: is not a list of things: its JSON is malformed"},
        {"{\"a\":\"\xff\"}", "a.json:1: is not a list of things: its JSON is malformed"},
        {"{\"a\":1e999}", "a.json: is not a list of things: a number in it does not fit a double"},
        {deep, "a.json: is not a list of things: its JSON is nested more than 64 deep"},
    };
    for (const auto& [text, sentence] : rejected) {
        CAPTURE(text.substr(0, 20));
        CHECK_REFUSED(read(text), sentence);
    }
    // Brackets in a string do not nest.
    const std::string brackets(100, '[');
    CHECK(read("{\"a\":\"\\\"" + brackets + "\"}").text("a") == "\"" + brackets);
    const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
    CHECK_NOTHROW(read(nested(64)));
    CHECK_THROWS_AS(read(nested(65)), aabb::input_error);
    CHECK_REFUSED(json_value("a.glb", "{]", "is not a glTF file", json_value::position::byte),
                  "a.glb: is not a glTF file: its JSON is malformed at byte 2");
}
