#include "../testing.hpp"

import aabb.base;
import aabblab.json;

using aabblab::json_value;

namespace {

json_value read(const std::string& text) {
    return {"a.json", text, "is not a list of things"};
}

}  // namespace

TEST_CASE("A member of JSON comes by its type, and empty where it is not there") {
    const json_value all = read(R"({"text":"t","number":-1.5,"index":18446744073709551615,"flag":true,"none":null,
        "of":{"texts":["a","b"],"indices":[1,2],"objects":[{"x":1},{"x":2}],"numbers":[1,2.5]}})");
    CHECK(all.text("text") == "t");
    CHECK(all.number("number") == -1.5);
    CHECK(all.number("index") == 0x1p64);
    CHECK(all.index("index") == 18446744073709551615U);
    CHECK(all.flag("flag") == true);
    CHECK(all.needed("none").is_null());
    const json_value of = all.needed("of");
    CHECK(of.texts("texts") == std::vector<std::string>{"a", "b"});
    CHECK(of.indices("indices") == std::vector<std::size_t>{1, 2});
    REQUIRE(of.objects("objects").size() == 2);
    CHECK(of.objects("objects")[1].index("x") == 2);
    CHECK(of.numbers<2>("numbers", {}) == std::array{1.0, 2.5});
    CHECK_FALSE(all.has("nothing"));
    CHECK_FALSE(all.text("nothing").has_value());
    CHECK_FALSE(all.member("nothing").has_value());
    CHECK(all.objects("nothing").empty());
    CHECK(all.numbers<1>("nothing", {7}) == std::array{7.0});
}

TEST_CASE("A member of JSON that is of another type, or missing, gets one sentence with the way to it") {
    const json_value all = read(R"({"a":[{"b":1},2,-3],"n":{"t":[1,"x"],"b":true,"f":0.5},"z":null})");
    const auto rejected = [&](const std::function<void()>& ask, const std::string& sentence) {
        CHECK_REFUSED(ask(), "a.json: " + sentence);
    };
    rejected([&] { (void)all.text("a"); }, "a must be a string");
    rejected([&] { (void)all.number("a"); }, "a must be a number");
    rejected([&] { (void)all.index("z"); }, "z must be a whole number");
    rejected([&] { (void)all.flag("z"); }, "z must be true or false");
    rejected([&] { (void)all.needed("n").index("f"); }, "n.f must be a whole number");
    rejected([&] { (void)all.needed("n").needed("b").list(); }, "n.b must be a list");
    rejected([&] { (void)all.needed("n").texts("t"); }, "n.t[0] must be a string");
    rejected([&] { (void)all.needed("n").indices("t"); }, "n.t must be a list of whole numbers");
    rejected([&] { (void)all.needed("n").numbers<2>("t", {}); }, "n.t must be a list of 2 numbers");
    rejected([&] { (void)all.objects("a"); }, "a[1] must be an object");
    rejected([&] { (void)all.needed("a").list()[2].index(); }, "a[2] must be a whole number");
    rejected([&] { (void)all.needed("a").list()[0].needed("c"); }, "a[0].c is missing");
    rejected([&] { (void)all.needed("z").has("x"); }, "z must be an object");
    rejected([&] { (void)all.needed("x"); }, "x is missing");
    rejected([&] { (void)read("[1]").text("a"); }, "the file must be an object");
}

TEST_CASE("What is no JSON is refused where it goes wrong, however deeply it is nested") {
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
    // What stands in a string nests nothing.
    const std::string brackets(100, '[');
    CHECK(read("{\"a\":\"\\\"" + brackets + "\"}").text("a") == "\"" + brackets);
    const auto nested = [](std::size_t depth) { return std::string(depth, '[') + std::string(depth, ']'); };
    CHECK_NOTHROW(read(nested(64)));
    CHECK_THROWS_AS(read(nested(65)), aabb::input_error);
    CHECK_REFUSED(json_value("a.glb", "{]", "is not a glTF file", json_value::position::byte),
                  "a.glb: is not a glTF file: its JSON is malformed at byte 2");
}
