#include "../testing.hpp"

import aabb;

using namespace aabb;

namespace {

struct tunable {
    static constexpr std::string_view name = "tunable";
    static constexpr std::string_view summary = "has one parameter of each kind";
    enum class colour { red, green };
    struct config {
        double weight = 0.5;
        std::optional<double> size;
        colour paint = colour::green;
    };
    static constexpr std::tuple parameters{
        number_parameter{"weight", &config::weight, 0.0, 1.0, "a share"},
        number_parameter{"size", &config::size, 0.0, std::numeric_limits<double>::max(), "a length"},
        choice_parameter{"paint", &config::paint, std::array<std::string_view, 2>{"red", "green"}, "a colour"}};
    explicit tunable(const config&) {}
};
static_assert(Strategy<tunable>);

struct plain {
    static constexpr std::string_view name = "plain";
    static constexpr std::string_view summary = "has none";
};

struct named {
    static constexpr std::string_view name = "named";
    static constexpr std::string_view summary = "has texts, one of them without a default";
    struct config {
        std::string file;
        std::string style = "plain";
    };
    static constexpr std::tuple parameters{
        text_parameter{"file", &config::file, "the path of a file", "what is read"},
        text_parameter{"style", &config::style, "the name of a style", "how it looks"}};
};
static_assert(Configurable<named>);

tunable::config read(std::string_view text) {
    return configured<tunable>(parse_strategy(text).settings);
}

}  // namespace

TEST_CASE("a strategy with settings is parsed from text and written back") {
    const strategy_choice choice = parse_strategy("shell:gaps=ciura,limit=2");
    CHECK(choice == strategy_choice{"shell", {{"gaps", "ciura"}, {"limit", "2"}}});
    CHECK(to_text(choice) == "shell:gaps=ciura,limit=2");
    CHECK(parse_strategy("std") == strategy_choice{"std", {}});
    CHECK_REFUSED(parse_strategy("shell:gaps"), "'gaps' after 'shell:' is not of the form name=value");
    CHECK_REFUSED(parse_strategy("shell:"), "'' after 'shell:' is not of the form name=value");
}

TEST_CASE("settings become the fields of a config") {
    CHECK(read("tunable").weight == 0.5);
    CHECK(read("tunable:weight=0.25").weight == 0.25);
    CHECK(read("tunable:size=3e2").size == 300);
    CHECK_FALSE(read("tunable:size=auto").size.has_value());
    CHECK(read("tunable:paint=red").paint == tunable::colour::red);
}

TEST_CASE("an invalid value is rejected with what is expected") {
    CHECK_REFUSED(read("tunable:weight=2"), "tunable: weight must be a number above 0 and at most 1, not '2'");
    CHECK_REFUSED(read("tunable:weight=0"), "tunable: weight must be a number above 0 and at most 1, not '0'");
    CHECK_REFUSED(read("tunable:weight=nan"), "tunable: weight must be a number above 0 and at most 1, not 'nan'");
    CHECK_REFUSED(read("tunable:size=1x"), "tunable: size must be a number above 0 or auto, not '1x'");
    CHECK_REFUSED(read("tunable:paint=blue"), "tunable: paint must be one of red, green, not 'blue'");
    CHECK_REFUSED(read("tunable:wieght=1"), "unknown parameter of tunable 'wieght'; did you mean 'weight'?");
    CHECK_REFUSED(configured<plain>(parse_strategy("plain:x=1").settings), "plain takes no parameters, but 'x' is set");
}

TEST_CASE("a text parameter is taken verbatim, and must not be empty") {
    const std::vector<setting> settings{{"file", "a b,\"c\"+d=e"}};
    CHECK(configured<named>(settings).file == "a b,\"c\"+d=e");
    CHECK(configured<named>(settings).style == "plain");
    CHECK_REFUSED(configured<named>(std::vector<setting>{{"file", ""}}),
                  "named: file must be the path of a file, not ''");
    CHECK_REFUSED(configured<named>(std::vector<setting>{{"style", "bold"}}),
                  "named: file must be given, the path of a file");
    const auto infos = parameters_of<named>();
    CHECK(infos[0].fallback.empty());
    CHECK(infos[1].fallback == "plain");
}

TEST_CASE("parameters describe themselves") {
    const auto infos = parameters_of<tunable>();
    REQUIRE(infos.size() == 3);
    CHECK(infos[0].fallback == "0.5");
    CHECK(infos[1].fallback == "auto");
    CHECK(infos[2].fallback == "green");
    CHECK(to_text(infos[2].values) == "one of red, green");
    CHECK(parameters_of<plain>().empty());
}

TEST_CASE("the nearest name is one typo away") {
    const std::vector<std::string> names = {"insertion", "std", "shell"};
    CHECK(nearest_name("shel", names) == "shell");
    CHECK(nearest_name("hsell", names) == "shell");
    CHECK(nearest_name("insetrion", names) == "insertion");
    CHECK(nearest_name("ertion", names) == "insertion");
    CHECK(nearest_name("insertion_sort", names) == "insertion");
    CHECK(edit_distance("", "abc") == 3);
    CHECK(edit_distance("ab", "ba") == 1);
    CHECK(edit_distance("same", "same") == 0);
}

TEST_CASE("a name that is far from all others has no nearest name") {
    const std::vector<std::string> names = {"insertion", "std", "shell"};
    for (const char* far : {"", "x", "columns", "bucket", "radix", "shovels", "shells_and_more"})
        CHECK(nearest_name(far, names).empty());
    CHECK(nearest_name("shells", std::vector<std::string>{}).empty());
    CHECK(unknown_name("sort", "columns", names) == "unknown sort 'columns'; expected one of insertion, std, shell");
    CHECK(unknown_name("sort", "columns", std::vector<std::string>{}) == "unknown sort 'columns'");
    CHECK(unknown_name("sort", "columns", std::vector<std::string>{std::string(121, 'x')}) == "unknown sort 'columns'");
}
