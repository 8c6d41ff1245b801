#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_exception.hpp>
#include <memory>
#include <string>
#include <vector>

#include "../compositions.hpp"

using namespace aabb;
using Catch::Matchers::Message;

TEST_CASE("every strategy of every kind says what it is and has sound defaults") {
    for (const strategy_kind kind : strategy_kinds) {
        REQUIRE_FALSE(strategies(kind).empty());
        for (const strategy_info& info : strategies(kind)) {
            INFO(name_of(kind) << " " << info.name);
            CHECK(info.summary.size() > 10);
            strategy_choice defaults{info.name, {}};
            for (const parameter_info& p : info.parameters) defaults.settings.push_back({p.name, p.fallback});
            CHECK_NOTHROW(require_known(kind, defaults));
            CHECK(parse_strategy(to_text(defaults)) == defaults);
        }
    }
}

TEST_CASE("an unknown strategy is refused with the nearest name") {
    CHECK_THROWS_MATCHES(require_known(strategy_kind::sort, {"insrtion", {}}), input_error,
                         Message("unknown sort 'insrtion'; did you mean 'insertion'?"));
    CHECK_THROWS_MATCHES(
        compose(global_composition{{"std", {}}, {"grid", {}}, {"one_axis", {}}}, instrumentation::none), input_error,
        Message("unknown partition 'grid'; did you mean 'uniform_grid'?"));
    CHECK_THROWS_MATCHES(compose(local_composition{{"leaf_less", {}}, {"moller", {}}}, instrumentation::none),
                         input_error, Message("unknown tree 'leaf_less'; did you mean 'leafless'?"));
    CHECK_THROWS_MATCHES(
        require_known(strategy_kind::partition, parse_strategy("uniform_grid:cell_size=1,cell_size=2")), input_error,
        Message("uniform_grid: cell_size is given twice"));
    CHECK_THROWS_MATCHES(make_triangle_test({"muller", {}}), input_error,
                         Message("unknown triangle 'muller'; did you mean 'moller'?"));
    CHECK_THROWS_MATCHES(
        compose(local_composition{{"leafless", {{"leaftest", "none"}}}, {"moller", {}}}, instrumentation::none),
        input_error, Message("unknown parameter of leafless 'leaftest'; did you mean 'leaf_test'?"));
}
