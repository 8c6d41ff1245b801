module aabblab.configs;

import :document;
import aabb.digest;
import aabb.selection;
import aabb.validation;

namespace aabblab {

// Defined in compose.cpp, scenes.cpp and below.
void read_compositions(const document& doc, const node* compose, experiment& e);
void read_scenes(const document& doc, experiment_size size, experiment& e);
void read_measure(const document& doc, experiment_size size, experiment& e);

namespace {

/// Reads a name, which must be safe in file names, as those of the results begin with it.
const std::string& plain_name_of(const document& doc, const node& name) {
    const std::string& text = doc.text_of("name", name);
    const auto fits = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
    if (text.empty() || !std::ranges::all_of(text, fits))
        doc.fail(name.line, "the name '" + text + "' must consist of letters, digits, - and _");
    return text;
}

constexpr std::size_t quick_repeats = 3, most_repeats = 1'000'000;

std::vector<std::string> engines_of(const document& doc) {
    const node* engines = doc.root().find("engines");
    if (!engines) return {};
    unique_list<std::string> names;
    for (const located_text& engine : doc.texts_of("engines", *engines)) {
        if (const std::string rejection = aabb::rejection_of_engine(engine.text); !rejection.empty())
            doc.fail(engine.line, rejection);
        if (!names.add(engine.text, engine.text)) doc.fail(engine.line, "engines lists '" + engine.text + "' twice");
    }
    return names.items();
}

/// Resolves a program like any file of the config; a name without a slash is left for PATH.
std::string resolve_program(const document& doc, const std::string& name) {
    if (name.find('/') == std::string::npos) return name;
    const std::filesystem::path program = resolve_file(name, doc.folder());
    if (std::filesystem::is_directory(program)) throw aabb::input_error(name + " is a folder; expected a program");
    return program.string();
}

/// Reads [[external]], a program of the user that takes part as an engine.
external_engine read_external(const document& doc, const node& table) {
    doc.require_table("external", table, " of [[external]]", {"name", "command", "exact", "timeout_s"});
    external_engine engine;
    const node& name = doc.required(table, "name", "this [[external]] has no name; expected name = \"…\"");
    engine.name = plain_name_of(doc, name);
    if (engine.name == "auto" || std::ranges::count(aabb::engines(), engine.name, &aabb::engine_info::name) > 0 ||
        std::ranges::count(aabb::left_out_engines(), engine.name, &aabb::left_out_engine::name) > 0)
        doc.fail(name.line, "there is an engine '" + engine.name + "' already; give this one another name");
    const node& command =
        doc.required(table, "command", "'" + engine.name + "' has no command; expected command = [\"…\"]");
    for (const located_text& word : doc.texts_of("command", command)) engine.command.push_back(word.text);
    if (engine.command.empty() || engine.command[0].empty())
        doc.fail(command.line, "the command of '" + engine.name + "' is empty; expected a program");
    doc.at_line(command.line, [&] { engine.program = resolve_program(doc, engine.command[0]); });
    engine.place = doc.place(command.line);
    if (const node* exact = table.find("exact")) engine.exact = doc.flag_of("exact", *exact);
    if (const node* timeout = table.find("timeout_s")) {
        constexpr std::uint64_t most = 1'000'000;
        engine.timeout_s = doc.integer_of("timeout_s", *timeout, 1);
        if (engine.timeout_s > most) doc.fail(timeout->line, "timeout_s must be at most " + std::to_string(most));
    }
    return engine;
}

std::vector<external_engine> externals_of(const document& doc) {
    unique_list<external_engine> externals;
    for (const node& table : doc.tables_of("external")) {
        const external_engine engine = read_external(doc, table);
        if (!externals.add(engine, engine.name))
            doc.fail(table.line, "two [[external]] have the name '" + engine.name + "'");
    }
    return externals.items();
}

/// Reads `metrics`, which replaces the recorded groups of the default: groups are only recorded, metrics also shown.
void read_metrics(const document& doc, const node& value, experiment& e) {
    e.recorded.clear();
    std::vector<std::string> known;
    for (const metric_group_info& group : metric_groups) known.emplace_back(group.name);
    const std::vector<std::string> names = metric_names();
    known.insert(known.end(), names.begin(), names.end());
    const std::vector<located_text> listed = doc.texts_of("metrics", value);
    if (listed.empty()) doc.fail(value.line, "metrics is an empty list; expected at least one metric");
    for (const located_text& name : listed) {
        const auto group = std::ranges::find(metric_groups, name.text, &metric_group_info::name);
        const auto metric = std::ranges::find(names, name.text);
        if (group != metric_groups.end()) {
            e.recorded.insert(static_cast<metric_group>(group - metric_groups.begin()));
        } else if (metric != names.end()) {
            e.recorded.insert(metric_named(name.text).group);
            if (std::ranges::find(e.shown, name.text) == e.shown.end()) e.shown.push_back(name.text);
        } else {
            doc.fail(name.line, aabb::unknown_name("metric", name.text, known, "aabblab list metrics"));
        }
    }
}

/// Reads one of the known words.
/// @returns its index
std::size_t read_word(const document& doc, const char* key, const node& value,
                      std::span<const std::string_view> known) {
    if (value.kind != node_kind::text) doc.fail_type(key, value, "a word in quotes");
    const auto word = std::ranges::find(known, value.text);
    const std::vector<std::string> names(known.begin(), known.end());
    if (word == known.end()) doc.fail(value.line, aabb::unknown_name(key, value.text, names));
    return static_cast<std::size_t>(word - known.begin());
}

/// Reads the query of the narrow phase (`ask`), whether caches are cold before it, and what a method knows of motion.
/// Only scenes of meshes support other values of the first two than the defaults, and only those of boxes of the last,
/// so the scenes must have been read.
void read_query(const document& doc, experiment& e) {
    const node* measure = doc.root().find("measure");
    if (!measure) return;
    const auto require_meshes = [&](const char* key, const node& value) {
        const auto boxes = std::ranges::find_if_not(e.scenes, has_meshes);
        if (boxes == e.scenes.end()) return;
        doc.fail(value.line, std::string(key) + " = \"" + value.text + "\" is for scenes of meshes, and " +
                                 boxes->kind + " has none");
    };
    if (const node* ask = measure->find("ask")) {
        e.query.kind = static_cast<query_kind>(read_word(doc, "ask", *ask, query_names));
        if (e.query.kind != query_kind::pairs) require_meshes("ask", *ask);
    }
    constexpr std::array<std::string_view, 2> states{"warm", "cold"};
    if (const node* caches = measure->find("caches")) {
        e.query.cold = read_word(doc, "caches", *caches, states) == 1;  // "cold"
        if (e.query.cold) require_meshes("caches", *caches);
    }
    constexpr std::array<std::string_view, 2> sources{"compared", "given"};
    if (const node* motion = measure->find("motion")) {
        e.query.says_moved = read_word(doc, "motion", *motion, sources) == 1;  // "given"
        const auto meshes = std::ranges::find_if(e.scenes, has_meshes);
        if (e.query.says_moved && meshes != e.scenes.end())
            doc.fail(motion->line, "motion = \"given\" is for scenes of boxes, and " + meshes->kind + " has meshes");
    }
    if (e.query.kind == query_kind::first) e.notes.emplace_back("query: any one contact of each frame");
    if (e.query.kind == query_kind::count) e.notes.emplace_back("query: the number of contacts of each frame");
    if (e.query.cold) e.notes.emplace_back("caches: cold before each query");
    if (e.query.says_moved) e.notes.emplace_back("motion: the ids of boxes that move are given");
}

/// Reads `processes`, the fresh processes among which the repeats are divided. More processes than repeats are an
/// error, but in quick runs, which have fewer repeats, and without timing, they are reduced.
void read_processes(const document& doc, experiment& e) {
    const node* measure = doc.root().find("measure");
    const node* processes = measure ? measure->find("processes") : nullptr;
    const node* in_quick = measure ? measure->find("quick") : nullptr;
    if (const node* fewer = in_quick ? in_quick->find("processes") : nullptr; fewer && e.quick) processes = fewer;
    if (!processes) return;
    e.processes = doc.integer_of("processes", *processes, 1);
    if (e.quick || !e.records(metric_group::time))
        e.processes = std::min(e.processes, e.repeats);
    else if (e.processes > e.repeats)
        doc.fail(processes->line, "processes must be at most repeats, which is " + std::to_string(e.repeats));
}

/// Reads everything that depends on the size of the experiment.
void read_sized(const document& doc, experiment_size size, experiment& e) {
    e.quick = size == experiment_size::quick;
    read_measure(doc, size, e);
    read_processes(doc, e);
    read_scenes(doc, size, e);
    read_query(doc, e);
}

}  // namespace

/// The name of the experiment and of its results folder.
std::string read_name(const document& doc) {
    return plain_name_of(doc, doc.required(doc.root(), "name", "this config has no name; expected name = \"…\""));
}

/// Reads the rest of [measure]. Its table `quick` applies in quick runs only, but its keys are checked in all.
void read_measure(const document& doc, experiment_size size, experiment& e) {
    const bool quick = size == experiment_size::quick;
    if (quick) e.repeats = quick_repeats;
    const node* measure = doc.root().find("measure");
    if (!measure) return;
    doc.require_table("measure", *measure, " of [measure]",
                      {"repeats", "processes", "patience", "ask", "caches", "motion", "metrics", "quick"});
    const node* repeats = measure->find("repeats");
    if (repeats && !quick) e.repeats = doc.integer_of("repeats", *repeats, 1);
    if (e.repeats > most_repeats) doc.fail(repeats->line, "repeats must be at most " + std::to_string(most_repeats));
    if (const node* value = measure->find("metrics")) read_metrics(doc, *value, e);
    if (const node* patience = measure->find("patience")) e.patience = doc.integer_of("patience", *patience, 2);
    const node* in_quick = measure->find("quick");
    if (!in_quick) return;
    doc.require_table("quick", *in_quick, " of quick", {"repeats", "processes"});
    if (const node* value = in_quick->find("repeats"); value && quick) e.repeats = doc.integer_of("repeats", *value, 1);
}

/// Reads a config of `run` from its text; the file's name is for messages.
experiment parse_experiment(const std::string& text, const std::string& file, experiment_size size) {
    const document doc(text, file);
    if (const node* curve = doc.root().find("curve"))
        doc.fail(curve->line, "[[curve]] belongs to a config of errors; use ./aabblab errors");
    doc.require_keys(doc.root(), "", {"name", "seed", "engines", "external", "scene", "compose", "measure", "quick"});
    experiment e;
    e.file = file;
    e.text = text;
    e.name = read_name(doc);
    e.engines = engines_of(doc);
    e.externals = externals_of(doc);
    read_compositions(doc, doc.root().find("compose"), e);
    read_sized(doc, size, e);
    // The quick settings are validated in full runs too, so that mistakes in them surface early.
    experiment in_quick = e;
    if (size == experiment_size::full) read_sized(doc, experiment_size::quick, in_quick);
    return e;
}

/// Reads a config. If it does not exist, the message suggests a config of the project with the same name.
std::string text_of_config(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file))
        for (const char* folder : {AABBLAB_CONFIGS, AABBLAB_CONFIGS "/errors"})
            if (const auto of_project = std::filesystem::path(folder) / file.filename();
                std::filesystem::exists(of_project))
                throw aabb::input_error(file.string() + " does not exist; did you mean " + of_project.string() + "?");
    if (file.extension() == ".aabbs")
        throw aabb::input_error(
            file.string() +
            " is a recording, not a config: pairs, explain and recommend take it, and a config reads "
            "it as kind = \"recording\", file = \"" +
            file.filename().string() + "\" under [[scene]]");
    return text_of_file(file, longest_config, "a config");
}

experiment read_experiment(const std::filesystem::path& file, experiment_size size) {
    return parse_experiment(text_of_config(file), file.string(), size);
}

std::vector<aabb::composition> every_composition(const experiment& e) {
    std::vector<aabb::composition> compositions = e.compositions;
    for (const aabb::named_strategies& named : e.automatic) compositions.push_back(select_composition(named, {}));
    return compositions;
}

/// Hashes a text of everything in the config that determines results, but not the config's own layout and comments.
std::string hash_of(const experiment& e) {
    std::string text = e.name + " repeats=" + std::to_string(e.repeats) + " processes=" + std::to_string(e.processes);
    if (e.patience) text += " patience=" + std::to_string(*e.patience);
    for (std::size_t i = 0; i < metric_groups.size(); ++i) text += e.records(static_cast<metric_group>(i)) ? '+' : '-';
    for (const std::string& engine : e.engines) text += "\n" + engine;
    for (const external_engine& engine : e.externals) {
        text += "\n" + engine.name + (engine.exact ? " exact" : " inexact");
        for (const std::string& word : engine.command) text += " + " + word;
    }
    for (const aabb::composition& c : e.compositions) {
        text += "\n";
        for (const aabb::strategy_kind kind : aabb::strategy_kinds) text += to_text(c[kind]) + " + ";
    }
    for (const aabb::named_strategies& named : e.automatic) {
        text += "\nauto";
        for (const aabb::strategy_kind kind : aabb::strategy_kinds)
            if (named[kind]) text += " + " + to_text(*named[kind]);
    }
    for (const scene_choice& scene : e.scenes) text += "\n" + scene.kind + " " + parameters_text(scene);
    if (e.query != query_settings{})
        text += "\n" + std::string(query_names[static_cast<std::size_t>(e.query.kind)]) +
                (e.query.cold ? " cold" : " warm") + (e.query.says_moved ? " given" : "");
    return aabb::hash_of_text(text + "\n" + e.content_digest);
}

}  // namespace aabblab
