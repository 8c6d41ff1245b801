module aabblab.configs;

import :choices;
import :document;
import aabb.base;
import aabb.selection;

namespace aabblab {

namespace {

/// What a config says of a kind.
struct listed_strategies {
    std::vector<std::optional<aabb::strategy_choice>> choices;  ///< one that is not there where it says nothing
    std::vector<std::string> others;                            ///< names of those that it plays without naming them
};

/// Adds those of a kind that { others_but = […] } in its list stands for: whatever is named neither there nor in the
/// list.
void add_others(const document& doc, aabb::strategy_kind kind, const node& but, listed_strategies& listed) {
    std::set<std::string> named;
    for (const located_text& name : doc.texts_of(but.key, but)) {
        doc.at(name.line, [&] { aabb::require_known(kind, {name.text, {}}); });
        named.insert(name.text);
    }
    for (const auto& choice : listed.choices) named.insert(choice->name);
    for (const aabb::strategy_info& info : aabb::strategies(kind))
        if (named.insert(info.name).second) {
            listed.choices.emplace_back(aabb::strategy_choice{info.name, {}});
            listed.others.push_back(info.name);
        }
}

listed_strategies strategies_of(const document& doc, aabb::strategy_kind kind, const node* value) {
    if (!value) return {{std::nullopt}, {}};
    node named = *value;
    const auto stands_for_others = [](const node& item) { return item.find("others_but") != nullptr; };
    const auto others = std::ranges::find_if(value->items, stands_for_others);
    const bool has_others = value->kind == node_kind::list && others != value->items.end();
    if (has_others) named.items.erase(named.items.begin() + (others - value->items.begin()));
    const auto require = [kind](const aabb::strategy_choice& choice) {
        if (choice.name == "auto")
            throw aabb::input_error("auto is no " + std::string(name_of(kind)) + ": leave " +
                                    std::string(name_of(kind)) + " out, and write auto = true beside what is named");
        aabb::require_known(kind, choice);
    };
    listed_strategies listed;
    if (!has_others || !named.items.empty())
        for (const aabb::strategy_choice& choice : choices_of(doc, named, aabb::strategies(kind)[0].name, require))
            listed.choices.emplace_back(choice);
    if (has_others) {
        doc.require_keys(*others, " beside others_but", {"others_but"});
        add_others(doc, kind, *others->find("others_but"), listed);
    }
    return listed;
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
    known.emplace_back("auto");
    for (const node& entry : compose.items)
        if (std::ranges::find(known, entry.key) == known.end()) fail_key(doc, entry, known);
}

/// What tells it from others.
std::string text_of(const aabb::composition& c) {
    return to_text(c, aabb::stage::global_search) + " + " + to_text(c, aabb::stage::local_detection);
}

bool is_refused(const aabb::composition& c) {
    return !refusal_of(c, aabb::stage::global_search).empty() || !refusal_of(c, aabb::stage::local_detection).empty();
}

void add_composition(const document& doc, int line, const aabb::composition& c, each_once<aabb::composition>& list) {
    for (const aabb::stage stage : {aabb::stage::global_search, aabb::stage::local_detection})
        if (const std::string_view reason = aabb::refusal_of(c, stage); !reason.empty())
            doc.fail(line, to_text(c, stage) + ": " + std::string(reason));
    if (!list.add(c, text_of(c))) doc.fail(line, "this composition is listed twice: " + text_of(c));
}

}  // namespace

/// What the kinds name, every combination; the last kind varies fastest. Those with strategies that are not named are
/// left out where they are refused.
std::vector<aabb::named_strategies> named_by(const document& doc, const node& compose, std::size_t listed) {
    aabb::by_kind<listed_strategies> of;
    std::vector<std::size_t> factors;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        of[kind] = strategies_of(doc, kind, compose.find(name_of(kind)));
        factors.push_back(of[kind].choices.size());
    }
    doc.require_few(compose.line, "compositions", factors, listed);
    std::vector<aabb::named_strategies> products(1);
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        std::vector<aabb::named_strategies> longer;
        for (const aabb::named_strategies& product : products)
            for (const auto& choice : of[kind].choices) longer.emplace_back(product)[kind] = choice;
        products = std::move(longer);
    }
    std::erase_if(products, [&](const aabb::named_strategies& product) {
        const bool is_named = std::ranges::none_of(aabb::strategy_kinds, [&](aabb::strategy_kind kind) {
            return product[kind] && std::ranges::count(of[kind].others, product[kind]->name) > 0;
        });
        return !is_named && is_refused(aabb::composition(product));
    });
    return products;
}

/// @param compose whose keys are kinds; its lists multiply
void add_compositions(const document& doc, const node& compose, each_once<aabb::composition>& list) {
    for (const aabb::named_strategies& named : named_by(doc, compose, list.all().size()))
        add_composition(doc, compose.line, aabb::composition(named), list);
}

namespace {

bool is_automatic(const document& doc, const node& compose) {
    const node* value = compose.find("auto");
    if (value && value->kind != node_kind::boolean) doc.fail_type("auto", *value, "true or false");
    return value && value->text == "true";
}

/// What is refused with what is named is refused whatever the scene.
void add_automatic(const document& doc, const node& compose, std::vector<aabb::named_strategies>& automatic) {
    for (const aabb::named_strategies& named : named_by(doc, compose, automatic.size())) {
        each_once<aabb::composition> alone;
        add_composition(doc, compose.line, select_composition(named, {}), alone);
        if (std::ranges::find(automatic, named) != automatic.end()) doc.fail(compose.line, "this auto is listed twice");
        automatic.push_back(named);
    }
}

}  // namespace

/// One [compose], or several [[compose]], whose lists multiply each for itself, or "auto".
/// @param compose null where the config has none.
void read_compositions(const document& doc, const node* compose, experiment& e) {
    static const node nothing{};
    each_once<aabb::composition> list;
    const auto add = [&](const node& one) {
        doc.require_table("compose", one);
        require_kinds(doc, one);
        if (is_automatic(doc, one))
            add_automatic(doc, one, e.automatic);
        else
            add_compositions(doc, one, list);
    };
    if (compose && compose->kind == node_kind::text) {
        if (compose->text != "auto")
            doc.fail(compose->line, "compose must be a table or \"auto\", not \"" + compose->text + "\"");
        e.automatic.emplace_back();
    } else if (compose && compose->kind == node_kind::list) {
        for (const node& one : compose->items) add(one);
    } else {
        add(compose ? *compose : nothing);
    }
    e.compositions = list.all();
    if (e.compositions.empty() && e.automatic.empty())
        doc.fail(compose->line, "compose is an empty list; expected a table");
}

}  // namespace aabblab
