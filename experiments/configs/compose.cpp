module;
#include <algorithm>
#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

module aabblab.configs;

import :document;
import aabb.policy;
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

std::vector<aabb::strategy_choice> strategies_of(const document& doc, aabb::strategy_kind kind, const node* value) {
    if (!value) return {aabb::composition()[kind]};
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

/// A key that nobody knows; the name of a strategy says of which kind it is.
[[noreturn]] void fail_key(const document& doc, const node& entry, const std::vector<std::string>& known) {
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (std::ranges::find(aabb::strategies(kind), entry.key, &aabb::strategy_info::name) !=
            aabb::strategies(kind).end())
            doc.fail(entry.line, "'" + entry.key + "' is a strategy, not a kind of them; write " +
                                     std::string(name_of(kind)) + " = \"" + entry.key + "\", or { name = \"" +
                                     entry.key + "\", … } with its parameters");
    doc.fail(entry.line, aabb::unknown_name("key of [compose]", entry.key, known));
}

void require_kinds(const document& doc, const node& compose) {
    std::vector<std::string> known;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) known.emplace_back(name_of(kind));
    for (const node& entry : compose.items)
        if (std::ranges::find(known, entry.key) == known.end()) fail_key(doc, entry, known);
}

/// What tells it from others.
std::string text_of(const aabb::composition& c) {
    return to_text(c, aabb::stage::global_search) + " + " + to_text(c, aabb::stage::local_detection);
}

void add_composition(const document& doc, int line, const aabb::composition& c, each_once<aabb::composition>& list) {
    for (const aabb::stage stage : {aabb::stage::global_search, aabb::stage::local_detection})
        if (const std::string_view reason = aabb::refusal_of(c, stage); !reason.empty())
            doc.fail(line, to_text(c, stage) + ": " + std::string(reason));
    if (!list.add(c, text_of(c))) doc.fail(line, "this composition is listed twice: " + text_of(c));
}

void add_compositions(const document& doc, const node& compose, each_once<aabb::composition>& list) {
    doc.require_table("compose", compose);
    require_kinds(doc, compose);
    aabb::by_kind<std::vector<aabb::strategy_choice>> choices;
    std::vector<std::size_t> factors;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        choices[kind] = strategies_of(doc, kind, compose.find(name_of(kind)));
        factors.push_back(choices[kind].size());
    }
    doc.require_few(compose.line, "compositions", factors, list.all().size());
    // The last kind varies fastest.
    std::vector<aabb::composition> products(1);
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        std::vector<aabb::composition> longer;
        for (const aabb::composition& product : products)
            for (const aabb::strategy_choice& choice : choices[kind]) longer.emplace_back(product)[kind] = choice;
        products = std::move(longer);
    }
    for (const aabb::composition& c : products) add_composition(doc, compose.line, c, list);
}

}  // namespace

/// One [compose], or several [[compose]], whose lists multiply each for itself.
/// @param compose null where the config has none.
std::vector<aabb::composition> compositions_of(const document& doc, const node* compose) {
    static const node nothing{};
    each_once<aabb::composition> list;
    if (compose && compose->kind == node_kind::list)
        for (const node& one : compose->items) add_compositions(doc, one, list);
    else
        add_compositions(doc, compose ? *compose : nothing, list);
    if (list.all().empty()) doc.fail(compose->line, "compose is an empty list; expected a table");
    return list.all();
}

}  // namespace aabblab
