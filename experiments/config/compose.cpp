module;
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

module aabblab.config;

import :document;
import aabb;
import aabb.registry;

namespace aabblab {

namespace {

/// One entry of a list: a name, or a table with a name and parameters, whose lists multiply.
void add_strategies(const document& doc, aabb::strategy_kind kind, const node& value,
                    std::vector<aabb::strategy_choice>& choices) {
    const std::string key(name_of(kind));
    const auto add = [&](const aabb::strategy_choice& choice) {
        doc.at(value.line, [&] { aabb::require_known(kind, choice); });
        if (std::ranges::find(choices, choice) != choices.end())
            doc.fail(value.line, key + " lists '" + to_text(choice) + "' twice");
        choices.push_back(choice);
    };
    if (value.kind == node_kind::text) return add(doc.at(value.line, [&] { return aabb::parse_strategy(value.text); }));
    if (value.kind != node_kind::table) doc.fail_type(key, value, "a name, a table with a name, or a list of them");
    const node* name = value.find("name");
    if (!name)
        doc.fail(value.line, key + " has no name; expected { name = \"" + aabb::strategies(kind)[0].name + "\", … }");
    std::vector<alternatives> parameters;
    for (const node& entry : value.items)
        if (entry.key != "name") parameters.emplace_back(entry.key, doc.alternatives_of(entry.key, entry));
    for (const located_text& one : doc.alternatives_of("name", *name))
        for (const std::vector<aabb::setting>& settings : multiplied(parameters)) add({one.text, settings});
}

std::vector<aabb::strategy_choice> strategies_of(const document& doc, aabb::strategy_kind kind, const node* value,
                                                 const aabb::strategy_choice& fallback) {
    if (!value) return {fallback};
    std::vector<aabb::strategy_choice> choices;
    if (value->kind != node_kind::list) {
        add_strategies(doc, kind, *value, choices);
        return choices;
    }
    if (value->items.empty())
        doc.fail(value->line, std::string(name_of(kind)) + " is an empty list; expected at least one name");
    for (const node& item : value->items) add_strategies(doc, kind, item, choices);
    return choices;
}

}  // namespace

namespace {

std::vector<std::optional<double>> splits_of(const document& doc, const node* value) {
    if (!value) return {std::nullopt};
    std::vector<std::optional<double>> sizes;
    for (const located_text& one : doc.alternatives_of("split_large", *value))
        sizes.push_back(doc.at(one.line, [&] { return aabb::parse_split_large(one.text); }));
    return sizes;
}

void add_compositions(const document& doc, const node& compose, std::vector<composition>& all) {
    doc.require_table("compose", compose);
    std::vector<std::string> known;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) known.emplace_back(name_of(kind));
    known.emplace_back("split_large");
    doc.require_keys(compose, " of [compose]", known);
    const composition fallback;
    const auto of = [&](aabb::strategy_kind kind, const aabb::strategy_choice& otherwise) {
        return strategies_of(doc, kind, compose.find(name_of(kind)), otherwise);
    };
    const auto add = [&](const composition& c) {
        if (const std::string_view reason = aabb::refusal_of(c.global); !reason.empty())
            doc.fail(compose.line, to_text(c.global) + ": " + std::string(reason));
        if (const std::string_view reason = aabb::refusal_of(c.local); !reason.empty())
            doc.fail(compose.line, to_text(c.local) + ": " + std::string(reason));
        if (std::ranges::find(all, c) != all.end())
            doc.fail(compose.line, "this composition is listed twice: " + to_text(c.global) + " + " + to_text(c.local));
        all.push_back(c);
    };
    for (const auto& sort : of(aabb::strategy_kind::sort, fallback.global.sort))
        for (const auto& partition : of(aabb::strategy_kind::partition, fallback.global.partition))
            for (const auto& sweep : of(aabb::strategy_kind::sweep, fallback.global.sweep))
                for (const auto& split : splits_of(doc, compose.find("split_large")))
                    for (const auto& tree : of(aabb::strategy_kind::tree, fallback.local.tree))
                        for (const auto& triangle : of(aabb::strategy_kind::triangle, fallback.local.triangle))
                            add({{sort, partition, sweep, split}, {tree, triangle}});
}

}  // namespace

/// One [compose], or several [[compose]], whose lists multiply each for itself.
/// @param compose null where the config has none.
std::vector<composition> compositions_of(const document& doc, const node* compose) {
    static const node nothing{};
    std::vector<composition> all;
    if (compose && compose->kind == node_kind::list)
        for (const node& one : compose->items) add_compositions(doc, one, all);
    else
        add_compositions(doc, compose ? *compose : nothing, all);
    if (all.empty()) doc.fail(compose->line, "compose is an empty list; expected a table");
    return all;
}

}  // namespace aabblab
