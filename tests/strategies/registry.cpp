#include "../compositions.hpp"

using namespace aabb;

TEST_CASE("every strategy of every kind has a summary and valid defaults") {
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

TEST_CASE("an unknown strategy is rejected with the nearest name") {
    CHECK_REFUSED(require_known(strategy_kind::sort, {"insrtion", {}}),
                  "unknown sort 'insrtion'; did you mean 'insertion'?");
    CHECK_REFUSED(global_of(composed({{strategy_kind::partition, "grid"}})),
                  "unknown partition 'grid'; did you mean 'uniform_grid'?");
    CHECK_REFUSED(local_of(composed({{strategy_kind::tree, "leaf_less"}})),
                  "unknown tree 'leaf_less'; did you mean 'leafless'?");
    CHECK_REFUSED(require_known(strategy_kind::partition, parse_strategy("uniform_grid:cell_size=1,cell_size=2")),
                  "uniform_grid: cell_size is given twice");
    CHECK_REFUSED(make_triangle_test({"muller", {}}), "unknown triangle 'muller'; did you mean 'moller'?");
    CHECK_REFUSED(local_of(composed({{strategy_kind::tree, "leafless:leaftest=none"}})),
                  "unknown parameter of leafless 'leaftest'; did you mean 'leaf_test'?");
}

TEST_CASE("a strategy of another kind is rejected with its kind, and never with a distant name") {
    CHECK_REFUSED(require_known(strategy_kind::partition, {"bucket", {}}),
                  "'bucket' is of the kind sort, not partition");
    CHECK_REFUSED(composed({{strategy_kind::sort, "columns:threads=2"}}),
                  "'columns' is of the kind partition, not sort");
    // Several kinds have a "none".
    std::string sorts;
    for (const std::string& name : strategy_names(strategy_kind::sort)) sorts += (sorts.empty() ? "" : ", ") + name;
    CHECK_REFUSED(require_known(strategy_kind::sort, {"none", {}}), "unknown sort 'none'; expected one of " + sorts);
}

TEST_CASE("a parameter that is now a kind is rejected with the new spelling") {
    CHECK_REFUSED(require_known(strategy_kind::tree, parse_strategy("canonical:build=sah")),
                  "canonical has no parameter build, which is a kind of its own: write build = \"sah\" "
                  "or --build sah");
}

TEST_CASE("unnamed strategies are the defaults if nothing is named, else those that fit") {
    const auto completed = [](strategy_kind kind, const char* name) {
        return text_of_global(composed({{kind, name}}));
    };
    CHECK(completed(strategy_kind::tree, "leafless") == "bucket + columns + simd");
    CHECK(completed(strategy_kind::sort, "shell") == "shell + none + one_axis");
    CHECK(completed(strategy_kind::sweep, "all_axes") == "std + none + all_axes");
    CHECK(completed(strategy_kind::partition, "axial_cut") == "std + axial_cut + one_axis");
    // columns rejects one_axis, so the others are the defaults.
    CHECK(completed(strategy_kind::partition, "columns:axes=1") == "bucket + columns:axes=1 + simd");
    // Neither set of defaults fits: the rejection names the usual companions.
    CHECK(completed(strategy_kind::sweep, "incremental") == "std + none + incremental");
    for (const strategy_info& info : strategies(strategy_kind::sort))
        CHECK(rejection_of(composed({{strategy_kind::sort, info.name.c_str()}}), stage::global_search).empty());
    CHECK_REFUSED(composed({{strategy_kind::sort, "shall"}}), "unknown sort 'shall'; did you mean 'shell'?");
}

TEST_CASE("every kind has a stage and a valid default strategy") {
    for (const strategy_kind kind : strategy_kinds)
        CHECK_NOTHROW(require_known(kind, {std::string(info_of(kind).fallback), {}}));
    for (const stage of : {stage::global_search, stage::local_detection}) {
        CHECK(rejection_of(composition{}, of).empty());
        // Standalone kinds are written only if they are not the default.
        CHECK(to_text(composed({{strategy_kind::prepare, "split_large"}, {strategy_kind::build, "sah"}}), of) ==
              (of == stage::global_search ? "split_large + bucket + columns + simd" : "sah + implicit + exact"));
        CHECK(to_text(composition{}, of) ==
              (of == stage::global_search ? "bucket + columns + simd" : "implicit + exact"));
        for (const composition& c : every_composition(of)) CHECK(rejection_of(c, of).empty());
    }
    CHECK(every_composition(stage::local_detection).size() ==
          strategies(strategy_kind::tree).size() * strategies(strategy_kind::triangle).size() +
              2 * (strategies(strategy_kind::build).size() - 1));
}
