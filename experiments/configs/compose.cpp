module aabblab.configs;

import :document;
import aabb.selection;
import aabb.validation;

namespace aabblab {

namespace {

/// A validator that throws aabb::input_error on an unknown or malformed choice.
using choice_check = std::function<void(const aabb::strategy_choice&)>;

/// Adds the strategies of a list entry: a name, or a table of a name and parameters, whose lists of values multiply.
/// @param key,example the key of the list and a valid name, for messages
void add_strategies(const document& doc, const std::string& key, const node& value, const std::string& example,
                    const choice_check& require, unique_list<aabb::strategy_choice>& choices) {
    const auto add = [&](const aabb::strategy_choice& choice) {
        doc.at_line(value.line, [&] { require(choice); });
        if (!choices.add(choice, to_text(choice))) doc.fail(value.line, key + " lists '" + to_text(choice) + "' twice");
    };
    if (value.kind == node_kind::text)
        return add(doc.at_line(value.line, [&] { return aabb::parse_strategy(value.text); }));
    if (value.kind != node_kind::table) doc.fail_type(key, value, "a name, a table with a name, or a list of them");
    const node& name = doc.required(value, "name", key + " has no name; expected { name = \"" + example + "\", … }");
    std::vector<alternatives> keys;
    for (const node& entry : value.items)
        if (entry.key != "name") keys.emplace_back(entry.key, doc.alternatives_of(entry.key, entry));
    const std::vector<located_text> names = doc.alternatives_of("name", name);
    for (const located_text& strategy : names) doc.at_line(strategy.line, [&] { require({strategy.text, {}}); });
    doc.require_small_product(value.line, "choices of " + key, sizes_of(keys, names.size()), choices.items().size());
    for (const located_text& strategy : names)
        for (const std::vector<aabb::setting>& settings : cartesian_product(keys)) add({strategy.text, settings});
}

/// Reads a name, a table of a name and parameters, or a list of both.
/// @param example a valid name, for messages
std::vector<aabb::strategy_choice> choices_of(const document& doc, const node& value, const std::string& example,
                                              const choice_check& require) {
    unique_list<aabb::strategy_choice> choices;
    if (value.kind != node_kind::list) {
        add_strategies(doc, value.key, value, example, require, choices);
        return choices.items();
    }
    if (value.items.empty()) doc.fail(value.line, value.key + " is an empty list; expected at least one name");
    for (const node& item : value.items) add_strategies(doc, value.key, item, example, require, choices);
    return choices.items();
}

struct listed_strategies {
    std::vector<std::optional<aabb::strategy_choice>> choices;  ///< nullopt if the config leaves the kind out
    std::vector<std::string> others;                            ///< strategies that others_but adds
};

/// Expands { others_but = […] }: adds every strategy of the kind that is neither excluded nor listed by name.
/// @param listed holds the choices that are listed by name
void add_others(const document& doc, aabb::strategy_kind kind, const std::vector<located_text>& excluded,
                listed_strategies& listed) {
    std::set<std::string> named;  // excluded, listed or added
    for (const located_text& name : excluded) {
        doc.at_line(name.line, [&] { aabb::require_known(kind, {name.text, {}}); });
        named.insert(name.text);
    }
    for (const auto& choice : listed.choices) named.insert(choice->name);
    for (const aabb::strategy_info& info : aabb::strategies(kind))
        if (named.insert(info.name).second) {
            listed.choices.emplace_back(aabb::strategy_choice{info.name, {}});
            listed.others.push_back(info.name);
        }
}

/// Reads the strategies of a kind: those listed by name, and with others_but all others except those it excludes.
/// @param value null if the config leaves the kind out; then nullopt, the default, is the only choice
listed_strategies strategies_of(const document& doc, aabb::strategy_kind kind, const node* value) {
    if (!value) return {.choices = {std::nullopt}, .others = {}};
    node named = *value;
    const auto excluded = doc.take_others(named);  // nullopt without others_but; leaves the names
    const auto require = [kind](const aabb::strategy_choice& choice) {
        if (choice.name == "auto")
            throw aabb::input_error("auto is not a " + std::string(name_of(kind)) + " strategy: omit " +
                                    std::string(name_of(kind)) + ", and write auto = true beside the named strategies");
        aabb::require_known(kind, choice);
    };
    listed_strategies listed;
    if (!excluded || !named.items.empty())
        for (const aabb::strategy_choice& choice : choices_of(doc, named, aabb::strategies(kind)[0].name, require))
            listed.choices.emplace_back(choice);
    if (excluded) add_others(doc, kind, *excluded, listed);
    return listed;
}

/// Rejects an unknown key; if it is the name of a strategy, the message suggests the strategy's kind.
[[noreturn]] void fail_key(const document& doc, const node& entry, const std::vector<std::string>& known) {
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (std::ranges::find(aabb::strategies(kind), entry.key, &aabb::strategy_info::name) !=
            aabb::strategies(kind).end())
            doc.fail(entry.line, "'" + entry.key + "' is a strategy, not a kind; write " + std::string(name_of(kind)) +
                                     " = \"" + entry.key + "\", or { name = \"" + entry.key +
                                     "\", … } with its parameters");
    doc.fail(entry.line, aabb::unknown_name("key of [compose]", entry.key, known));
}

void require_kinds(const document& doc, const node& compose) {
    std::vector<std::string> known;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) known.emplace_back(name_of(kind));
    known.emplace_back("auto");
    for (const node& entry : compose.items)
        if (std::ranges::find(known, entry.key) == known.end()) fail_key(doc, entry, known);
}

std::string text_of(const aabb::composition& c) {
    return to_text(c, aabb::stage::global_search) + " + " + to_text(c, aabb::stage::local_detection);
}

/// Rejects duplicates, and combinations that make no sense.
void add_composition(const document& doc, int line, const aabb::composition& c, unique_list<aabb::composition>& list) {
    for (const aabb::stage stage : {aabb::stage::global_search, aabb::stage::local_detection})
        if (const std::string_view reason = aabb::rejection_of(c, stage); !reason.empty())
            doc.fail(line, to_text(c, stage) + ": " + std::string(reason));
    if (!list.add(c, text_of(c))) doc.fail(line, "this composition is listed twice: " + text_of(c));
}

/// Every combination of the listed strategies, one per kind; the last kind varies fastest. Invalid ones with a strategy
/// from others_but are dropped; others are kept, so that the caller reports them as errors.
/// @param listed the number of compositions that the config has already, which count towards its limit
std::vector<aabb::named_strategies> combinations_of(const document& doc, const node& compose, std::size_t listed) {
    aabb::by_kind<listed_strategies> strategies;
    std::vector<std::size_t> factors;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        strategies[kind] = strategies_of(doc, kind, compose.find(name_of(kind)));
        factors.push_back(strategies[kind].choices.size());
    }
    doc.require_small_product(compose.line, "compositions", factors, listed);
    std::vector<aabb::named_strategies> combinations(1);  // of the kinds so far
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        std::vector<aabb::named_strategies> extended;
        for (const aabb::named_strategies& combination : combinations)
            for (const auto& choice : strategies[kind].choices) extended.emplace_back(combination)[kind] = choice;
        combinations = std::move(extended);
    }
    std::erase_if(combinations, [&](const aabb::named_strategies& combination) {
        const bool has_other = std::ranges::any_of(aabb::strategy_kinds, [&](aabb::strategy_kind kind) {
            return combination[kind] && std::ranges::count(strategies[kind].others, combination[kind]->name) > 0;
        });
        const aabb::composition c(combination);
        return has_other && !(rejection_of(c, aabb::stage::global_search).empty() &&
                              rejection_of(c, aabb::stage::local_detection).empty());
    });
    return combinations;
}

/// @param compose a table whose keys are kinds; its lists multiply
void add_compositions(const document& doc, const node& compose, unique_list<aabb::composition>& list) {
    for (const aabb::named_strategies& named : combinations_of(doc, compose, list.items().size()))
        add_composition(doc, compose.line, aabb::composition(named), list);
}

/// Adds each combination of the strategies that the table names, which `auto` completes for each scene by selecting the
/// other strategies. One that no selection makes valid is rejected here, by a selection without a scene.
void add_automatic(const document& doc, const node& compose, std::vector<aabb::named_strategies>& automatic) {
    for (const aabb::named_strategies& named : combinations_of(doc, compose, automatic.size())) {
        unique_list<aabb::composition> ignored;
        add_composition(doc, compose.line, select_composition(named, /*scene=*/{}), ignored);
        if (std::ranges::find(automatic, named) != automatic.end()) doc.fail(compose.line, "this auto is listed twice");
        automatic.push_back(named);
    }
}

/// A label for the strategies of one kind along a curve: their names, and the settings that all points share.
std::string common_text(std::span<const aabb::strategy_choice> choices) {
    std::string text;
    std::set<std::string> names;
    for (const aabb::strategy_choice& choice : choices)
        if (names.insert(choice.name).second) text += (text.empty() ? "" : ", ") + choice.name;
    for (const aabb::setting& s : choices[0].settings)
        if (std::ranges::all_of(choices, [&](const aabb::strategy_choice& choice) {
                return std::ranges::find(choice.settings, s) != choice.settings.end();
            }))
            text += " " + s.name + "=" + s.value;
    return text;
}

/// The default label of a curve, from its triangle tests or from the kinds of strategies that its table names.
std::string label_of(const node& methods, const error_curve& curve) {
    if (!curve.triangles.empty()) return common_text(curve.triangles);
    std::string label;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        if (!methods.find(name_of(kind))) continue;
        std::vector<aabb::strategy_choice> choices;
        for (const aabb::composition& c : curve.compositions) choices.push_back(c[kind]);
        label += (label.empty() ? "" : " + ") + common_text(choices);
    }
    return label;
}

}  // namespace

/// Reads compose = "auto", or any number of [compose], each with combinations of its own. Those that `auto` completes
/// go to e.automatic, the others to e.compositions.
/// @param compose null if the config has none
void read_compositions(const document& doc, const node* compose, experiment& e) {
    static const node nothing{};  // an empty table composes the defaults
    unique_list<aabb::composition> list;
    const auto add = [&](const node& table) {
        doc.require_table("compose", table);
        require_kinds(doc, table);
        if (const node* automatic = table.find("auto"); automatic && doc.flag_of("auto", *automatic))
            add_automatic(doc, table, e.automatic);
        else
            add_compositions(doc, table, list);
    };
    if (compose && compose->kind == node_kind::text) {
        if (compose->text != "auto")
            doc.fail(compose->line, "compose must be a table or \"auto\", not \"" + compose->text + "\"");
        e.automatic.emplace_back();
    } else if (compose && compose->kind == node_kind::list) {
        for (const node& table : compose->items) add(table);
    } else {
        add(compose ? *compose : nothing);
    }
    e.compositions = list.items();
    if (e.compositions.empty() && e.automatic.empty())
        doc.fail(compose->line, "compose is an empty list; expected a table");
}

/// A curve that names only triangle tests runs on triangle pairs; any other curve runs on whole scenes.
error_curve read_curve(const document& doc, const node& written) {
    std::vector<std::string> known{"label"};
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) known.emplace_back(name_of(kind));
    doc.require_table("curve", written, " of [[curve]]", known);
    node methods = written;
    std::erase_if(methods.items, [](const node& entry) { return entry.key == "label"; });
    if (methods.items.empty())
        doc.fail(written.line,
                 "this curve has no method; expected triangle = \"exact\" or another test, or strategies "
                 "of other kinds");
    error_curve curve;
    if (methods.items.size() == 1 && methods.items[0].key == name_of(aabb::strategy_kind::triangle)) {
        curve.triangles = choices_of(doc, methods.items[0], "moller", [](const aabb::strategy_choice& choice) {
            static_cast<void>(triangle_test_named(choice));  // throws if the test or a setting is unknown
        });
    } else {
        unique_list<aabb::composition> list;
        curve.named = combinations_of(doc, methods, /*listed=*/0);
        for (const aabb::named_strategies& named : curve.named)
            add_composition(doc, methods.line, aabb::composition(named), list);
        curve.compositions = list.items();
    }
    const node* label = written.find("label");
    curve.label = label ? doc.text_of("label", *label) : label_of(methods, curve);
    if (curve.label.empty()) doc.fail(written.line, "the label of this curve is empty");
    return curve;
}

/// Makes the triangle test of this name, which is a strategy or comes from a library.
std::unique_ptr<aabb::triangle_test> triangle_test_named(const aabb::strategy_choice& choice) {
    std::vector<std::string> names = aabb::strategy_names(aabb::strategy_kind::triangle);
    if (std::ranges::find(names, choice.name) != names.end()) return aabb::make_triangle_test(choice);
    for (const aabb::library_test_info& test : aabb::library_tests()) {
        if (test.name == choice.name) return aabb::make_library_test(choice);
        names.push_back(test.name);
    }
    throw aabb::input_error(aabb::unknown_name("triangle", choice.name, names));
}

std::vector<std::string> constructing_tests() {
    std::vector<std::string> names = aabb::strategy_names(aabb::strategy_kind::triangle);
    for (const aabb::library_test_info& test : aabb::library_tests()) names.push_back(test.name);
    std::erase_if(names, [](const std::string& name) { return !triangle_test_named({name, {}})->constructs(); });
    return names;
}

}  // namespace aabblab
