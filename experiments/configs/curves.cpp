module aabblab.configs;

import :choices;
import :document;

namespace aabblab {

// Defined in compose.cpp.
void add_compositions(const document& doc, const node& compose, each_once<aabb::composition>& list);

namespace {

/// What choices have in common: their names, and the settings that they share.
std::string common_text(std::span<const aabb::strategy_choice> choices) {
    std::string text;
    std::vector<std::string> names;
    for (const aabb::strategy_choice& choice : choices) {
        if (std::ranges::find(names, choice.name) != names.end()) continue;
        names.push_back(choice.name);
        text += (text.empty() ? "" : ", ") + choice.name;
    }
    for (const aabb::setting& s : choices[0].settings)
        if (std::ranges::all_of(choices, [&](const aabb::strategy_choice& choice) {
                return std::ranges::find(choice.settings, s) != choice.settings.end();
            }))
            text += " " + s.name + "=" + s.value;
    return text;
}

/// Of the kinds that the config names.
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

/// A triangle test alone is held against pairs of triangles; anything else is a composition, which plays scenes whole.
error_curve curve_of(const document& doc, const node& written) {
    doc.require_table("curve", written);
    std::vector<std::string> known{"label"};
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) known.emplace_back(name_of(kind));
    doc.require_keys(written, " of [[curve]]", known);
    node methods = written;
    std::erase_if(methods.items, [](const node& entry) { return entry.key == "label"; });
    if (methods.items.empty())
        doc.fail(written.line,
                 "this curve has no method; expected triangle = \"exact\" or another test, or strategies "
                 "of other kinds");
    error_curve curve;
    if (methods.items.size() == 1 && methods.items[0].key == name_of(aabb::strategy_kind::triangle)) {
        curve.triangles = choices_of(doc, methods.items[0], "moller", [](const aabb::strategy_choice& choice) {
            static_cast<void>(triangle_test_named(choice));
        });
    } else {
        each_once<aabb::composition> list;
        add_compositions(doc, methods, list);
        curve.compositions = list.all();
    }
    const node* label = written.find("label");
    curve.label = label ? doc.text_of("label", *label) : label_of(methods, curve);
    if (curve.label.empty()) doc.fail(written.line, "the label of this curve is empty");
    return curve;
}

}  // namespace aabblab
