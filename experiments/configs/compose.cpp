module;
#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

module aabblab.configs;

import :document;
import aabb;
import aabb.registry;

namespace aabblab {

namespace {

/// One entry of a list: a name, or a table with a name and parameters, whose lists multiply.
void add_strategies(const document& doc, aabb::strategy_kind kind, const node& value,
                    each_once<aabb::strategy_choice>& choices) {
    const std::string key(name_of(kind));
    const auto add = [&](const aabb::strategy_choice& choice) {
        doc.at(value.line, [&] { aabb::require_known(kind, choice); });
        if (!choices.add(choice, to_text(choice))) doc.fail(value.line, key + " lists '" + to_text(choice) + "' twice");
    };
    if (value.kind == node_kind::text) return add(doc.at(value.line, [&] { return aabb::parse_strategy(value.text); }));
    if (value.kind != node_kind::table) doc.fail_type(key, value, "a name, a table with a name, or a list of them");
    const node* name = value.find("name");
    if (!name)
        doc.fail(value.line, key + " has no name; expected { name = \"" + aabb::strategies(kind)[0].name + "\", … }");
    std::vector<alternatives> parameters;
    for (const node& entry : value.items)
        if (entry.key != "name") parameters.emplace_back(entry.key, doc.alternatives_of(entry.key, entry));
    const std::vector<located_text> names = doc.alternatives_of("name", *name);
    for (const located_text& one : names) doc.at(one.line, [&] { aabb::require_known(kind, {one.text, {}}); });
    std::vector<std::size_t> factors = sizes_of(parameters);
    factors.push_back(names.size());
    doc.require_few(value.line, "choices of " + key, factors, choices.all().size());
    for (const located_text& one : names)
        for (const std::vector<aabb::setting>& settings : multiplied(parameters)) add({one.text, settings});
}

std::vector<aabb::strategy_choice> strategies_of(const document& doc, aabb::strategy_kind kind, const node* value,
                                                 const aabb::strategy_choice& fallback) {
    if (!value) return {fallback};
    each_once<aabb::strategy_choice> choices;
    if (value->kind != node_kind::list) {
        add_strategies(doc, kind, *value, choices);
        return choices.all();
    }
    if (value->items.empty())
        doc.fail(value->line, std::string(name_of(kind)) + " is an empty list; expected at least one name");
    for (const node& item : value->items) add_strategies(doc, kind, item, choices);
    return choices.all();
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

void add_composition(const document& doc, int line, const composition& c, each_once<composition>& list) {
    if (const std::string_view reason = aabb::refusal_of(c.global); !reason.empty())
        doc.fail(line, to_text(c.global) + ": " + std::string(reason));
    if (const std::string_view reason = aabb::refusal_of(c.local); !reason.empty())
        doc.fail(line, to_text(c.local) + ": " + std::string(reason));
    const std::string text = to_text(c.global) + " + " + to_text(c.local);
    if (!list.add(c, text)) doc.fail(line, "this composition is listed twice: " + text);
}

void add_compositions(const document& doc, const node& compose, each_once<composition>& list) {
    doc.require_table("compose", compose);
    std::vector<std::string> known;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) known.emplace_back(name_of(kind));
    known.emplace_back("split_large");
    doc.require_keys(compose, " of [compose]", known);
    const composition fallback;
    const auto of = [&](aabb::strategy_kind kind, const aabb::strategy_choice& otherwise) {
        return strategies_of(doc, kind, compose.find(name_of(kind)), otherwise);
    };
    const auto sorts = of(aabb::strategy_kind::sort, fallback.global.sort);
    const auto partitions = of(aabb::strategy_kind::partition, fallback.global.partition);
    const auto sweeps = of(aabb::strategy_kind::sweep, fallback.global.sweep);
    const auto splits = splits_of(doc, compose.find("split_large"));
    const auto trees = of(aabb::strategy_kind::tree, fallback.local.tree);
    const auto triangles = of(aabb::strategy_kind::triangle, fallback.local.triangle);
    const std::array<std::size_t, 6> factors = {sorts.size(),  partitions.size(), sweeps.size(),
                                                splits.size(), trees.size(),      triangles.size()};
    doc.require_few(compose.line, "compositions", factors, list.all().size());
    for (const auto& sort : sorts)
        for (const auto& partition : partitions)
            for (const auto& sweep : sweeps)
                for (const auto& split : splits)
                    for (const auto& tree : trees)
                        for (const auto& triangle : triangles)
                            add_composition(doc, compose.line, {{sort, partition, sweep, split}, {tree, triangle}},
                                            list);
}

}  // namespace

/// One [compose], or several [[compose]], whose lists multiply each for itself.
/// @param compose null where the config has none.
std::vector<composition> compositions_of(const document& doc, const node* compose) {
    static const node nothing{};
    each_once<composition> list;
    if (compose && compose->kind == node_kind::list)
        for (const node& one : compose->items) add_compositions(doc, one, list);
    else
        add_compositions(doc, compose ? *compose : nothing, list);
    if (list.all().empty()) doc.fail(compose->line, "compose is an empty list; expected a table");
    return list.all();
}

}  // namespace aabblab
