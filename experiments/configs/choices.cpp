module aabblab.configs;

import :choices;
import :document;

namespace aabblab {

namespace {

/// One entry of a list: a name, or a table with a name and parameters, whose lists multiply.
void add_strategies(const document& doc, const std::string& key, const node& value, const std::string& example,
                    const choice_check& require, each_once<aabb::strategy_choice>& choices) {
    const auto add = [&](const aabb::strategy_choice& choice) {
        doc.at(value.line, [&] { require(choice); });
        if (!choices.add(choice, to_text(choice))) doc.fail(value.line, key + " lists '" + to_text(choice) + "' twice");
    };
    if (value.kind == node_kind::text) return add(doc.at(value.line, [&] { return aabb::parse_strategy(value.text); }));
    if (value.kind != node_kind::table) doc.fail_type(key, value, "a name, a table with a name, or a list of them");
    const node* name = value.find("name");
    if (!name) doc.fail(value.line, key + " has no name; expected { name = \"" + example + "\", … }");
    std::vector<alternatives> parameters;
    for (const node& entry : value.items)
        if (entry.key != "name") parameters.emplace_back(entry.key, doc.alternatives_of(entry.key, entry));
    const std::vector<located_text> names = doc.alternatives_of("name", *name);
    for (const located_text& one : names) doc.at(one.line, [&] { require({one.text, {}}); });
    std::vector<std::size_t> factors = sizes_of(parameters);
    factors.push_back(names.size());
    doc.require_few(value.line, "choices of " + key, factors, choices.all().size());
    for (const located_text& one : names)
        for (const std::vector<aabb::setting>& settings : multiplied(parameters)) add({one.text, settings});
}

}  // namespace

std::vector<aabb::strategy_choice> choices_of(const document& doc, const node& value, const std::string& example,
                                              const choice_check& require) {
    each_once<aabb::strategy_choice> choices;
    if (value.kind != node_kind::list) {
        add_strategies(doc, value.key, value, example, require, choices);
        return choices.all();
    }
    if (value.items.empty()) doc.fail(value.line, value.key + " is an empty list; expected at least one name");
    for (const node& item : value.items) add_strategies(doc, value.key, item, example, require, choices);
    return choices.all();
}

}  // namespace aabblab
