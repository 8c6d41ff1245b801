module aabblab.extreme;

import :contenders;
import aabb.pipeline;
import aabb.policy;
import aabb.registry;
import aabb.validation;

namespace aabblab {

namespace {

/// With each named value of each parameter; a default is not written.
std::vector<aabb::strategy_choice> with_named_values(aabb::strategy_kind kind, const std::string& name) {
    const auto info = std::ranges::find(aabb::strategies(kind), name, &aabb::strategy_info::name);
    std::vector<aabb::strategy_choice> all{{name, {}}};
    for (const aabb::parameter_info& parameter : info->parameters) {
        const auto* const named = std::get_if<aabb::name_values>(&parameter.values);
        if (!named) continue;
        std::vector<aabb::strategy_choice> more;
        for (const std::string& value : named->names) {
            if (value == parameter.fallback) continue;
            for (aabb::strategy_choice choice : all) {
                choice.settings.push_back({parameter.name, value});
                more.push_back(std::move(choice));
            }
        }
        all.insert(all.end(), std::move_iterator(more.begin()), std::move_iterator(more.end()));
    }
    return all;
}

std::vector<aabb::composition> with_named_values(const aabb::composition& c, aabb::stage stage) {
    std::vector<aabb::composition> all{c};
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        if (info_of(kind).stage != stage) continue;
        std::vector<aabb::composition> longer;
        for (const aabb::composition& shorter : all)
            for (const aabb::strategy_choice& choice : with_named_values(kind, c[kind].name))
                longer.emplace_back(shorter)[kind] = choice;
        all = std::move(longer);
    }
    return all;
}

}  // namespace

std::vector<aabb::composition> exact_compositions(aabb::stage stage, bool named_values) {
    std::vector<aabb::composition> all = aabb::every_composition(stage);
    if (named_values) {
        std::vector<aabb::composition> more;
        for (const aabb::composition& c : all) std::ranges::move(with_named_values(c, stage), std::back_inserter(more));
        all = std::move(more);
    }
    // Scenes of meshes have a global search of their own.
    std::erase_if(all, [&](const aabb::composition& c) {
        return !is_exact(c, stage) || !refusal_of(c, stage).empty() || !needs_meshes(c).empty();
    });
    return all;
}

std::vector<aabb::composition> inexact_compositions() {
    std::vector<aabb::composition> all;
    for (const aabb::strategy_info& info : aabb::strategies(aabb::strategy_kind::triangle)) {
        aabb::composition c;
        c[aabb::strategy_kind::triangle] = {info.name, {}};
        if (!is_exact(c, aabb::stage::local_detection)) all.push_back(std::move(c));
    }
    return all;
}

std::vector<named_test> all_triangle_tests() {
    std::vector<named_test> all;
    for (const aabb::strategy_info& info : aabb::strategies(aabb::strategy_kind::triangle))
        for (const aabb::strategy_choice& choice : with_named_values(aabb::strategy_kind::triangle, info.name)) {
            aabb::composition c;
            c[aabb::strategy_kind::triangle] = choice;
            all.push_back({to_text(choice), is_exact(c, aabb::stage::local_detection), choice.settings.empty(),
                           aabb::make_triangle_test(choice)});
        }
    for (const aabb::library_test_info& info : aabb::library_tests())
        all.push_back({info.name, info.exact, true, aabb::make_library_test({info.name, {}})});
    return all;
}

}  // namespace aabblab
