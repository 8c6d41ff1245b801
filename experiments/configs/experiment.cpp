module;
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <ios>
#include <string>
#include <utility>
#include <vector>

module aabblab.configs;

import :document;
import aabb;
import aabb.validation;
import aabblab.scenes;

namespace aabblab {

// Defined in compose.cpp and scenes.cpp.
std::vector<composition> compositions_of(const document& doc, const node* compose);
void read_scenes(const document& doc, experiment_size size, experiment& e);

namespace {

constexpr std::size_t quick_repeats = 3;
constexpr std::size_t most_repeats = 1'000'000;

/// Results stand in a folder of this name.
std::string name_of(const document& doc) {
    const node* name = doc.root().find("name");
    if (!name) doc.fail(1, "this config has no name; expected name = \"…\"");
    const std::string& text = doc.text_of("name", *name);
    const auto fits = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
    if (text.empty() || !std::ranges::all_of(text, fits))
        doc.fail(name->line, "the name '" + text + "' must consist of letters, digits, - and _");
    return text;
}

std::vector<std::string> engines_of(const document& doc) {
    std::vector<std::string> names;
    const node* engines = doc.root().find("engines");
    if (!engines) return names;
    std::vector<std::string> known;
    for (const aabb::engine_info& info : aabb::engines()) known.push_back(info.name);
    for (const located_text& one : doc.texts_of("engines", *engines)) {
        if (std::ranges::find(known, one.text) == known.end())
            doc.fail(one.line, aabb::unknown_name("engine", one.text, known));
        if (std::ranges::find(names, one.text) != names.end())
            doc.fail(one.line, "engines lists '" + one.text + "' twice");
        names.push_back(one.text);
    }
    return names;
}

void read_metrics(const document& doc, const node& value, metrics& measured) {
    const std::vector<std::pair<std::string, bool metrics::*>> all{
        {"time", &metrics::time}, {"counts", &metrics::counts}, {"bytes", &metrics::bytes}, {"error", &metrics::error}};
    std::vector<std::string> known;
    for (const auto& [name, field] : all) {
        known.push_back(name);
        measured.*field = false;
    }
    const std::vector<located_text> wanted = doc.texts_of("metrics", value);
    if (wanted.empty()) doc.fail(value.line, "metrics is an empty list; expected at least one metric");
    for (const located_text& one : wanted) {
        const auto found = std::ranges::find(known, one.text);
        if (found == known.end()) doc.fail(one.line, aabb::unknown_name("metric", one.text, known));
        measured.*all[static_cast<std::size_t>(found - known.begin())].second = true;
    }
}

void read_measure(const document& doc, experiment_size size, experiment& e) {
    const bool quick = size == experiment_size::quick;
    if (quick) e.repeats = quick_repeats;
    const node* measure = doc.root().find("measure");
    if (!measure) return;
    doc.require_table("measure", *measure);
    doc.require_keys(*measure, " of [measure]", {"repeats", "processes", "metrics", "quick"});
    const node* repeats = measure->find("repeats");
    if (repeats && !quick) e.repeats = doc.integer_of("repeats", *repeats, 1);
    if (e.repeats > most_repeats) doc.fail(repeats->line, "repeats must be at most " + std::to_string(most_repeats));
    if (const node* value = measure->find("metrics")) read_metrics(doc, *value, e.measured);
    const node* in_quick = measure->find("quick");
    if (!in_quick) return;
    doc.require_table("quick", *in_quick);
    doc.require_keys(*in_quick, " of quick", {"repeats"});
    if (const node* value = in_quick->find("repeats"); value && quick) e.repeats = doc.integer_of("repeats", *value, 1);
}

/// Fresh processes share the repeats, so there are at most as many.
void read_processes(const document& doc, experiment& e) {
    const node* measure = doc.root().find("measure");
    const node* processes = measure ? measure->find("processes") : nullptr;
    if (!processes) return;
    e.processes = doc.integer_of("processes", *processes, 1);
    if (e.quick || !e.measured.time)
        e.processes = std::min(e.processes, e.repeats);
    else if (e.processes > e.repeats)
        doc.fail(processes->line, "processes must be at most repeats, which is " + std::to_string(e.repeats));
}

}  // namespace

experiment parse_experiment(const std::string& text, const std::string& file, experiment_size size) {
    const document doc(text, file);
    doc.require_keys(doc.root(), "", {"name", "seed", "engines", "scene", "compose", "measure", "quick"});
    experiment e;
    e.file = file;
    e.text = text;
    e.quick = size == experiment_size::quick;
    e.name = name_of(doc);
    e.engines = engines_of(doc);
    e.compositions = compositions_of(doc, doc.root().find("compose"));
    read_measure(doc, size, e);
    read_processes(doc, e);
    read_scenes(doc, size, e);
    // What stands under quick is checked now, not when somebody first asks for it.
    if (size == experiment_size::full) (void)parse_experiment(text, file, experiment_size::quick);
    return e;
}

experiment read_experiment(const std::filesystem::path& file, experiment_size size) {
    if (!std::filesystem::exists(file)) throw aabb::input_error(file.string() + " is not there; expected a config");
    if (std::filesystem::is_directory(file)) throw aabb::input_error(file.string() + " is a folder; expected a config");
    std::ifstream in(file, std::ios::binary);
    std::string text(longest_config + 1, ' ');  // one byte more shows that it is too long
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(in.gcount()));
    if (!in.good() && !in.eof()) throw aabb::input_error(file.string() + " cannot be read");
    return parse_experiment(text, file.string(), size);
}

std::string parameters_text(const scene_choice& scene) {
    std::string text;
    const auto add = [&](const std::string& part) { text += (text.empty() ? "" : " ") + part; };
    for (const aabb::setting& s : scene.settings) add(s.name + "=" + s.value);
    std::string meshes;
    for (const std::string& mesh : scene.meshes) meshes += (meshes.empty() ? "meshes=" : "+") + mesh;
    if (!meshes.empty()) add(meshes);
    if (scene.seed) add("seed=" + std::to_string(*scene.seed));
    return text;
}

std::string hash_of(const experiment& e) {
    std::string all = e.name + " repeats=" + std::to_string(e.repeats) + " processes=" + std::to_string(e.processes);
    for (const bool metric : {e.measured.time, e.measured.counts, e.measured.bytes, e.measured.error})
        all += metric ? '+' : '-';
    for (const std::string& engine : e.engines) all += "\n" + engine;
    for (const composition& c : e.compositions) all += "\n" + to_text(c.global) + " + " + to_text(c.local);
    for (const scene_choice& scene : e.scenes) all += "\n" + scene.kind + " " + parameters_text(scene);
    all += "\n" + e.content_digest;
    std::array<char, 17> digits{};
    std::snprintf(digits.data(), digits.size(), "%016llx",
                  static_cast<unsigned long long>(XXH3_64bits(all.data(), all.size())));
    return digits.data();
}

}  // namespace aabblab
