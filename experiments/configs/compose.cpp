module;
#include <algorithm>
#include <cstddef>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

module aabblab.configs;

import :choices;
import :document;
import aabb.policy;
import aabb.registry;

namespace aabblab {

namespace {

/// One that is not there where the config says nothing.
std::vector<std::optional<aabb::strategy_choice>> strategies_of(const document& doc, aabb::strategy_kind kind,
                                                                const node* value) {
    if (!value) return {std::nullopt};
    const std::vector<aabb::strategy_choice> choices =
        choices_of(doc, *value, aabb::strategies(kind)[0].name,
                   [kind](const aabb::strategy_choice& choice) { aabb::require_known(kind, choice); });
    return {choices.begin(), choices.end()};
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

}  // namespace

/// @param compose whose keys are kinds; its lists multiply
void add_compositions(const document& doc, const node& compose, each_once<aabb::composition>& list) {
    aabb::by_kind<std::vector<std::optional<aabb::strategy_choice>>> choices;
    std::vector<std::size_t> factors;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        choices[kind] = strategies_of(doc, kind, compose.find(name_of(kind)));
        factors.push_back(choices[kind].size());
    }
    doc.require_few(compose.line, "compositions", factors, list.all().size());
    // The last kind varies fastest.
    std::vector<aabb::named_strategies> products(1);
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        std::vector<aabb::named_strategies> longer;
        for (const aabb::named_strategies& product : products)
            for (const auto& choice : choices[kind]) longer.emplace_back(product)[kind] = choice;
        products = std::move(longer);
    }
    for (const aabb::named_strategies& named : products)
        add_composition(doc, compose.line, aabb::composition(named), list);
}

/// One [compose], or several [[compose]], whose lists multiply each for itself.
/// @param compose null where the config has none.
std::vector<aabb::composition> compositions_of(const document& doc, const node* compose) {
    static const node nothing{};
    each_once<aabb::composition> list;
    const auto add = [&](const node& one) {
        doc.require_table("compose", one);
        require_kinds(doc, one);
        add_compositions(doc, one, list);
    };
    if (compose && compose->kind == node_kind::list)
        for (const node& one : compose->items) add(one);
    else
        add(compose ? *compose : nothing);
    if (list.all().empty()) doc.fail(compose->line, "compose is an empty list; expected a table");
    return list.all();
}

}  // namespace aabblab
