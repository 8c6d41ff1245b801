module;
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

module aabblab.configs;

import :document;
import aabb.base;
import aabb.policy;
import aabblab.scenes;

namespace aabblab {

// Defined in experiment.cpp and scenes.cpp.
std::string name_of(const document& doc);
std::string text_of_config(const std::filesystem::path& file);
void read_scenes(const document& doc, experiment_size size, experiment& e);
const node* seed_of(const document& doc, experiment_size size);

namespace {

const std::vector<std::string> known_precisions = {"float", "double"};
constexpr std::uint64_t quick_share = 20;  // of the pairs, unless the config says how many

/// What a curve's points have in common: the choice without what multiplies.
std::string label_of(const std::vector<located_text>& names, const std::vector<alternatives>& parameters) {
    std::string label;
    for (const located_text& name : names) label += (label.empty() ? "" : ", ") + name.text;
    for (const auto& [key, values] : parameters)
        if (values.size() == 1) label += " " + key + "=" + values[0].text;
    return label;
}

error_curve curve_of(const document& doc, const node& written) {
    doc.require_table("curve", written);
    doc.require_keys(written, " of [[curve]]", {"label", "triangle"});
    const node* triangle = written.find("triangle");
    if (!triangle) doc.fail(written.line, "this curve has no method; expected triangle = \"exact\" or another test");
    std::vector<located_text> names;
    std::vector<alternatives> parameters;
    if (triangle->kind == node_kind::table) {
        const node* name = triangle->find("name");
        if (!name) doc.fail(triangle->line, "triangle has no name; expected { name = \"moller\", … }");
        names = doc.alternatives_of("name", *name);
        for (const node& entry : triangle->items)
            if (entry.key != "name") parameters.emplace_back(entry.key, doc.alternatives_of(entry.key, entry));
    } else {
        names = doc.alternatives_of("triangle", *triangle);
    }
    error_curve curve;
    const node* label = written.find("label");
    curve.label = label ? doc.text_of("label", *label) : label_of(names, parameters);
    std::vector<std::size_t> factors = sizes_of(parameters);
    factors.push_back(names.size());
    doc.require_few(triangle->line, "points of a curve", factors, 0);
    for (const located_text& name : names)
        for (std::vector<aabb::setting>& settings : multiplied(parameters)) {
            aabb::strategy_choice choice{name.text, std::move(settings)};
            if (choice.settings.empty()) choice = doc.at(name.line, [&] { return aabb::parse_strategy(name.text); });
            doc.at(triangle->line, [&] { static_cast<void>(triangle_test_named(choice)); });
            curve.points.push_back(std::move(choice));
        }
    return curve;
}

/// How many pairs at this size of the study.
std::uint64_t count_of(const document& doc, const node& pairs, experiment_size size) {
    const node* count = pairs.find("count");
    const node* quick = pairs.find("quick");
    std::uint64_t wanted = count ? doc.integer_of("count", *count, 1) : 100'000;
    std::uint64_t few = std::max<std::uint64_t>(1, wanted / quick_share);
    if (quick) {
        doc.require_table("quick", *quick);
        doc.require_keys(*quick, " of quick", {"count"});
        if (const node* in_quick = quick->find("count")) few = doc.integer_of("count", *in_quick, 1);
    }
    return size == experiment_size::quick ? few : wanted;
}

void add_pairs(const document& doc, const node& written, experiment_size size, std::uint64_t seed,
               each_once<pair_set>& sets) {
    doc.require_table("pairs", written);
    doc.require_keys(written, " of [[pairs]]", {"class", "precision", "count", "quick"});
    std::vector<located_text> classes;
    if (const node* given = written.find("class")) {
        classes = doc.alternatives_of("class", *given);
    } else {
        for (const pair_class_info& c : pair_classes()) classes.push_back({std::string(c.name), written.line});
    }
    std::vector<located_text> precisions{{"float", written.line}};
    if (const node* given = written.find("precision")) precisions = doc.alternatives_of("precision", *given);
    const std::uint64_t count = count_of(doc, written, size);
    for (const located_text& precision : precisions) {
        if (precision.text != "float" && precision.text != "double")
            doc.fail(precision.line, aabb::unknown_name("precision", precision.text, known_precisions));
        for (const located_text& one : classes) {
            doc.at(one.line, [&] { static_cast<void>(pair_source<float>(one.text, seed)); });
            if (!sets.add({one.text, precision.text == "double", count, seed}, one.text + " in " + precision.text))
                doc.fail(one.line, "these pairs are listed twice: " + one.text + " in " + precision.text);
        }
    }
}

/// Some tests take floats only.
void require_doubles_taken(const document& doc, error_study& study) {
    if (std::ranges::none_of(study.pairs, &pair_set::in_double)) return;
    std::size_t taking = 0;
    for (const error_curve& curve : study.curves)
        for (const aabb::strategy_choice& choice : curve.points) {
            if (triangle_test_named(choice)->takes_double())
                ++taking;
            else
                study.notes.push_back(to_text(choice) + " takes triangles of floats only, and has no part in doubles");
        }
    if (taking == 0) doc.fail(doc.root().find("pairs")->line, "no curve takes triangles of doubles");
}

void require_meshes(const document& doc, const node& scene) {
    const node* kinds = scene.find("kind");
    if (!kinds) return;
    for (const located_text& kind : doc.alternatives_of("kind", *kinds)) {
        const auto info = std::ranges::find(scene_kinds(), kind.text, &scene_info::name);
        if (info != scene_kinds().end() && !info->has_meshes)
            doc.fail(kind.line, kind.text + " is a scene of boxes, which has no triangles");
    }
}

}  // namespace

error_study parse_error_study(const std::string& text, const std::string& file, experiment_size size) {
    const document doc(text, file);
    doc.require_keys(doc.root(), "", {"name", "seed", "pairs", "scene", "curve", "quick"});
    error_study study;
    study.name = name_of(doc);
    study.text = text;
    const node* seed = seed_of(doc, size);
    const std::uint64_t number = seed ? doc.integer_of("seed", *seed, 0) : 1;
    const auto tables = [&](const char* key) -> std::vector<node> {
        const node* list = doc.root().find(key);
        if (!list) return {};
        if (list->kind != node_kind::list)
            doc.fail(list->line, std::string(key) + " must stand in double brackets: [[" + key + "]]");
        return list->items;
    };
    each_once<aabb::strategy_choice> methods;
    for (const node& one : tables("curve")) {
        study.curves.push_back(curve_of(doc, one));
        const error_curve& curve = study.curves.back();
        if (curve.label.empty()) doc.fail(one.line, "the label of this curve is empty");
        if (std::ranges::count(study.curves, curve.label, &error_curve::label) > 1)
            doc.fail(one.line, "two curves have the label '" + curve.label + "'");
        for (const aabb::strategy_choice& choice : curve.points)
            if (!methods.add(choice, to_text(choice)))
                doc.fail(one.line, "'" + to_text(choice) + "' is a point of two curves");
    }
    if (study.curves.empty()) doc.fail(1, "this config has no curve; expected at least one [[curve]]");
    each_once<pair_set> sets;
    for (const node& one : tables("pairs")) add_pairs(doc, one, size, number, sets);
    study.pairs = sets.all();
    require_doubles_taken(doc, study);
    for (const node& one : tables("scene")) require_meshes(doc, one);
    if (doc.root().find("scene")) {
        experiment played;
        read_scenes(doc, size, played);
        study.scenes = played.scenes;
        study.notes.insert(study.notes.end(), played.notes.begin(), played.notes.end());
    }
    if (study.pairs.empty() && study.scenes.empty())
        doc.fail(1, "this config has no pairs of triangles; expected [[pairs]], or a [[scene]] of meshes");
    if (size == experiment_size::full) static_cast<void>(parse_error_study(text, file, experiment_size::quick));
    return study;
}

error_study read_error_study(const std::filesystem::path& file, experiment_size size) {
    return parse_error_study(text_of_config(file), file.string(), size);
}

}  // namespace aabblab
