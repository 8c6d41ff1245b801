module aabblab.configs;

import :document;

namespace aabblab {

// Defined in compose.cpp, experiment.cpp and scenes.cpp.
error_curve read_curve(const document& doc, const node& written);
std::string read_name(const document& doc);
std::string text_of_config(const std::filesystem::path& file);
void read_measure(const document& doc, experiment_size size, experiment& e);
void read_scenes(const document& doc, experiment_size size, experiment& e);
const node* seed_of(const document& doc, experiment_size size);

namespace {

const std::vector<std::string> known_precisions = {"float", "double"};
constexpr std::uint64_t default_count = 100'000;
constexpr std::uint64_t quick_share = 20;  // a quick run takes 1/20 of the pairs by default

/// The number of pairs of each class in a table: `count`. In quick runs, that of `quick`, or else a 20th.
std::uint64_t count_of(const document& doc, const node& pairs, experiment_size size) {
    const node* count = pairs.find("count");
    const node* quick = pairs.find("quick");
    std::uint64_t full_count = count ? doc.integer_of("count", *count, /*least=*/1) : default_count;
    std::uint64_t quick_count = std::max<std::uint64_t>(1, full_count / quick_share);
    if (quick) {
        doc.require_table("quick", *quick, " of quick", {"count"});
        if (const node* in_quick = quick->find("count")) quick_count = doc.integer_of("count", *in_quick, 1);
    }
    return size == experiment_size::quick ? quick_count : full_count;
}

/// Adds the sets of pairs of a table: every class that it lists, or all, in every precision that it lists.
/// @param key "pairs", or "hits", whose count includes only pairs that intersect
void add_pairs(const document& doc, const std::string& key, const node& written, experiment_size size,
               std::uint64_t seed, unique_list<pair_set>& sets) {
    doc.require_table(key, written, " of [[" + key + "]]", {"class", "precision", "count", "quick"});
    std::vector<located_text> classes;
    if (const node* listed = written.find("class"))
        classes = doc.alternatives_of("class", *listed);
    else
        for (const pair_class_info& c : pair_classes()) classes.push_back({std::string(c.name), written.line});
    std::vector<located_text> precisions{{"float", written.line}};
    if (const node* listed = written.find("precision")) precisions = doc.alternatives_of("precision", *listed);
    const std::uint64_t count = count_of(doc, written, size);
    for (const located_text& precision : precisions) {
        if (precision.text != "float" && precision.text != "double")
            doc.fail(precision.line, aabb::unknown_name("precision", precision.text, known_precisions));
        for (const located_text& name : classes) {
            // Throws if there is no such class.
            doc.at_line(name.line, [&] { static_cast<void>(pair_source<float>(name.text, seed)); });
            if (!sets.add({name.text, /*in_double=*/precision.text == "double", count, seed},
                          name.text + " in " + precision.text))
                doc.fail(name.line, "these " + key + " are listed twice: " + name.text + " in " + precision.text);
        }
    }
}

/// Rejects a study with pairs of doubles if all its tests support only floats, and notes which do.
void require_test_for_doubles(const document& doc, error_study& study) {
    if (std::ranges::none_of(study.pairs, &pair_set::in_double)) return;
    bool has_test = false;
    std::string float_tests;
    for (const error_curve& curve : study.curves)
        for (const aabb::strategy_choice& choice : curve.triangles)
            if (triangle_test_named(choice)->takes_double())
                has_test = true;
            else
                float_tests += (float_tests.empty() ? "" : "; ") + to_text(choice);
    if (!float_tests.empty())
        study.notes.push_back("these triangle tests take only floats, and do not run on pairs of doubles: " +
                              float_tests);
    if (!has_test) doc.fail(doc.root().find("pairs")->line, "no curve has a test for triangles of doubles");
}

/// Rejects scenes of boxes; unknown kinds are reported later.
void require_meshes(const document& doc, const node& scene) {
    const node* kinds = scene.find("kind");
    if (!kinds) return;
    for (const located_text& kind : doc.alternatives_of("kind", *kinds))
        if (std::ranges::count(scene_names(), kind.text) > 0 && !scene_named(kind.text).has_meshes)
            doc.fail(kind.line, kind.text + " is a scene of boxes, which has no triangles");
}

/// Reads the curves. All are of triangle tests or all of compositions, and no method may be a point of two curves.
std::vector<error_curve> curves_of(const document& doc) {
    std::vector<error_curve> curves;
    std::set<std::string> methods;  // of all curves so far
    for (const node& table : doc.tables_of("curve")) {
        curves.push_back(read_curve(doc, table));
        const error_curve& curve = curves.back();
        if (std::ranges::count(curves, curve.label, &error_curve::label) > 1)
            doc.fail(table.line, "two curves have the label '" + curve.label + "'");
        if (curve.triangles.empty() != curves[0].triangles.empty())
            doc.fail(table.line, "'" + curve.label + "' and '" + curves[0].label +
                                     "' cannot be in one config: triangle tests alone run on pairs of triangles, other "
                                     "compositions on scenes; put them into two configs");
        const auto add = [&](const std::string& text) {
            if (!methods.insert(text).second) doc.fail(table.line, "'" + text + "' is a point of two curves");
        };
        for (const aabb::strategy_choice& choice : curve.triangles) add(to_text(choice));
        for (const aabb::composition& c : curve.compositions)
            add(to_text(c, aabb::stage::global_search) + " + " + to_text(c, aabb::stage::local_detection));
    }
    return curves;
}

/// Rejects keys that belong only to the other kind of study.
/// @param reason follows the name of the key in the message
void reject_keys(const document& doc, std::initializer_list<std::string_view> keys, const std::string& reason) {
    for (const std::string_view key : keys)
        if (const node* entry = doc.root().find(key)) {
            const std::string name = "[" + std::string(key) + "]";
            doc.fail(entry->line, (entry->kind == node_kind::list ? "[" + name + "]" : name) + " " + reason);
        }
}

/// The plots of a config; without any, wrong results are plotted against time.
std::vector<metric_plot> plots_of(const document& doc) {
    std::vector<metric_plot> plots;
    for (const node& table : doc.tables_of("plot")) {
        doc.require_table("plot", table, " of [[plot]]", {"x", "y"});
        const auto metric_of = [&](const char* key) {
            const node& value =
                doc.required(table, key, std::string("this plot has no ") + key + "; expected the name of a metric");
            const std::string& name = doc.text_of(key, value);
            doc.at_line(value.line, [&] { static_cast<void>(metric_named(name)); });  // rejects unknown names
            return name;
        };
        plots.push_back({metric_of("x"), metric_of("y")});
    }
    if (plots.empty()) plots.push_back({"frame_ms", "wrong_share"});
    return plots;
}

/// The experiment for curves of compositions: it runs the scenes of the config with the compositions of all curves.
experiment scene_experiment_of(const document& doc, const error_study& study, experiment_size size) {
    experiment e;
    // A config is read for full and for quick runs. `read_scenes` does not generate scenes of the first reading again.
    if (study.scene_experiment) e.scenes = study.scene_experiment->scenes;
    e.name = study.name;
    e.file = doc.file();
    e.text = study.text;
    e.quick = size == experiment_size::quick;
    read_measure(doc, size, e);
    // Here one process asks for all pairs, with warm caches, and plots name the metrics.
    if (const node* measure = doc.root().find("measure"))
        for (const char* key : {"processes", "ask", "caches", "metrics"})
            if (const node* entry = measure->find(key))
                doc.fail(entry->line, std::string("errors has no ") + key + ", which is for run");
    for (const error_curve& curve : study.curves)
        e.compositions.insert(e.compositions.end(), curve.compositions.begin(), curve.compositions.end());
    for (const metric_plot& plot : study.plots)
        for (const std::string& name : {plot.x, plot.y})
            if (std::ranges::find(e.shown, name) == e.shown.end()) e.shown.push_back(name);
    read_scenes(doc, size, e);
    return e;
}

/// The sets of pairs of all tables [[pairs]] or [[hits]], as the key says.
std::vector<pair_set> pairs_of(const document& doc, const std::string& key, experiment_size size) {
    const std::span<const node> tables = doc.tables_of(key);
    if (tables.empty()) return {};
    const node* seed = seed_of(doc, size);
    const std::uint64_t number = seed ? doc.integer_of("seed", *seed, 0) : 1;
    unique_list<pair_set> sets;
    for (const node& table : tables) add_pairs(doc, key, table, size, number, sets);
    return sets.items();
}

/// Reads the triangle pairs and the mesh scenes on which triangle tests are compared.
void read_triangles(const document& doc, experiment_size size, error_study& study) {
    study.pairs = pairs_of(doc, "pairs", size);
    require_test_for_doubles(doc, study);
    for (const node& table : doc.tables_of("scene")) require_meshes(doc, table);
    if (doc.root().find("scene")) {
        experiment with_scenes;
        // A config is read for full and for quick runs. Scenes of the first reading are not generated again.
        with_scenes.scenes = study.scenes;
        read_scenes(doc, size, with_scenes);
        study.scenes = with_scenes.scenes;
        study.notes.insert(study.notes.end(), with_scenes.notes.begin(), with_scenes.notes.end());
    }
    if (study.pairs.empty() && study.scenes.empty())
        doc.fail(1, "this config has no pairs of triangles; expected [[pairs]], or a [[scene]] of meshes");
}

/// Reads what differs between full and quick runs: triangle pairs for triangle tests, scenes for compositions.
void read_sized(const document& doc, experiment_size size, error_study& study) {
    study.hits = pairs_of(doc, "hits", size);
    if (study.curves.empty()) {
        if (study.hits.empty()) doc.fail(1, "this config has no curve; expected at least one [[curve]], or [[hits]]");
        reject_keys(doc, {"pairs", "scene", "plot", "measure"}, "is for curves, and this config has none");
    } else if (study.curves[0].triangles.empty()) {
        reject_keys(doc, {"pairs"}, "is for curves of triangle tests alone; these run whole scenes");
        study.plots = plots_of(doc);
        study.scene_experiment = scene_experiment_of(doc, study, size);
        study.notes = study.scene_experiment->notes;
    } else {
        reject_keys(doc, {"plot", "measure"},
                    "is for compositions; triangle tests alone are plotted against their time");
        read_triangles(doc, size, study);
    }
}

}  // namespace

/// Reads a config of `errors` from its text; the file's name is for messages.
error_study parse_error_study(const std::string& text, const std::string& file, experiment_size size) {
    const document doc(text, file);
    if (const node* compose = doc.root().find("compose"))
        doc.fail(compose->line, "[compose] belongs to a config of run; use ./aabblab run");
    doc.require_keys(doc.root(), "", {"name", "seed", "pairs", "scene", "curve", "hits", "plot", "measure", "quick"});
    error_study study;
    study.name = read_name(doc);
    study.text = text;
    study.curves = curves_of(doc);
    read_sized(doc, size, study);
    // The quick settings are validated in full runs too, so that mistakes in them surface early.
    error_study in_quick = study;
    if (size == experiment_size::full) read_sized(doc, experiment_size::quick, in_quick);
    return study;
}

study_curves read_curves(const std::filesystem::path& file) {
    const document doc(text_of_config(file), file.string());
    return {curves_of(doc), plots_of(doc)};
}

error_study read_error_study(const std::filesystem::path& file, experiment_size size) {
    return parse_error_study(text_of_config(file), file.string(), size);
}

}  // namespace aabblab
