module aabblab.configs;

import :document;
import aabb.collision_filter;
import aabb.digest;
import aabblab.filters;

namespace aabblab {

namespace {

/// `quick = false` excludes the scene from quick runs.
bool is_false(const node& value) {
    return value.kind == node_kind::boolean && value.text == "false";
}

/// The table of a scene without its entry `quick`, a table whose entries override the others in quick runs.
node at_size(const document& doc, const node& written, experiment_size size) {
    node scene = written;
    std::erase_if(scene.items, [](const node& entry) { return entry.key == "quick"; });
    const node* quick = written.find("quick");
    if (!quick || is_false(*quick)) return scene;
    doc.require_table("quick", *quick);
    if (size == experiment_size::full) return scene;
    for (const node& entry : quick->items) {
        const auto overridden = std::ranges::find(scene.items, entry.key, &node::key);
        if (overridden == scene.items.end())
            scene.items.push_back(entry);
        else
            *overridden = entry;
    }
    return scene;
}

const scene_info& info_of(const document& doc, const located_text& kind) {
    return doc.at_line(kind.line, [&]() -> const scene_info& { return scene_named(kind.text); });
}

/// Expands { others_but = […] } to every generated scene of boxes that is neither excluded nor listed by name.
std::vector<located_text> kinds_of(const document& doc, node list) {
    const auto excluded = doc.take_others(list);
    if (!excluded) return doc.alternatives_of("kind", list);
    std::vector<located_text> names = doc.texts_of("kind", list);
    for (const located_text& name : *excluded) info_of(doc, name);
    for (const scene_info& info : scene_kinds()) {
        const auto is_named = [&](const auto& in) {
            return std::ranges::count(in, info.name, &located_text::text) > 0;
        };
        if (!info.has_meshes && !info.reads_file && !is_named(*excluded) && !is_named(names))
            names.push_back({info.name, list.line});
    }
    return names;
}

/// The keys of a scene that are not settings.
constexpr std::string_view own_keys[] = {"kind", "seed", "meshes", "without_data"};

/// Rejects keys that the kind of scene does not have, in the scene and in its `quick`.
void require_known_keys(const document& doc, const node& scene, const scene_info& info) {
    const node* quick = scene.find("quick");
    if (quick && is_false(*quick)) quick = nullptr;
    for (const node* table : {&scene, quick})
        if (const node* seed = table && info.reads_file ? table->find("seed") : nullptr)
            doc.fail(seed->line, info.name + " reads a file, so it has no seed");
    std::vector<std::string> known{"kind", "seed", "quick"};
    known.insert(known.end(), filter_settings.begin(), filter_settings.end());
    if (info.has_meshes) known.insert(known.end(), {"meshes", "without_data"});
    for (const aabb::parameter_info& p : info.parameters) known.push_back(p.name);
    doc.require_keys(scene, " of scene " + info.name, known);
    if (quick) doc.require_keys(*quick, " of scene " + info.name, known);
}

/// The names of meshes under a key; empty if the scene lacks it.
std::vector<std::string> names_of(const document& doc, const node& scene, const std::string& key) {
    std::vector<std::string> names;
    const node* value = scene.find(key);
    if (!value) return names;
    for (located_text& name : doc.texts_of(key, *value)) names.push_back(std::move(name.text));
    if (names.empty()) doc.fail(value->line, key + " is an empty list; expected at least one mesh");
    return names;
}

/// The meshes of a scene. If one does not exist, those of `without_data` replace all of them, with a note.
std::vector<std::string> meshes_of(const document& doc, const node& scene, std::vector<std::string>& notes) {
    std::vector<std::string> meshes = names_of(doc, scene, "meshes");
    std::vector<std::string> fallback = names_of(doc, scene, "without_data");
    auto missing = meshes.begin();
    const auto exists = [&](const std::string& mesh) { return is_mesh(mesh, doc.folder()); };
    if (const node* listed = scene.find("meshes"))
        doc.at_line(listed->line, [&] { missing = std::ranges::find_if_not(meshes, exists); });
    if (fallback.empty() || missing == meshes.end()) return meshes;
    std::string note(name_without_order(*missing, doc.folder()));
    note += " does not exist (./aabblab data gets it), so the scene in line " + std::to_string(scene.line) + " uses";
    for (const std::string& mesh : fallback) note += (&mesh == fallback.data() ? " " : ", ") + mesh;
    notes.push_back(note + " instead");
    return fallback;
}

/// The settings of a scene with their alternative values. Every file that they name must exist.
std::vector<alternatives> settings_of(const document& doc, const node& scene, bool reads_file) {
    std::vector<alternatives> settings;
    for (const node& entry : scene.items) {
        if (std::ranges::find(own_keys, entry.key) != std::end(own_keys)) continue;
        settings.emplace_back(entry.key, doc.alternatives_of(entry.key, entry));
        const bool is_filter = std::ranges::find(filter_settings, entry.key) != filter_settings.end();
        if (is_filter || (reads_file && entry.key == "file"))
            for (const located_text& name : settings.back().second)
                doc.at_line(name.line, [&] { static_cast<void>(resolve_file(name.text, doc.folder())); });
    }
    return settings;
}

/// The seeds of a scene: a number or a list of them; 1 by default.
/// @param seed null if the config has none
std::vector<std::optional<std::uint64_t>> seeds_of(const document& doc, const node* seed) {
    if (!seed) return {1U};
    if (seed->kind != node_kind::list) return {doc.integer_of("seed", *seed, 0)};
    if (seed->items.empty()) doc.fail(seed->line, "seed is an empty list; expected at least one number");
    unique_list<std::optional<std::uint64_t>> seeds;
    for (const node& item : seed->items)
        if (!seeds.add(doc.integer_of("seed", item, 0), item.text))
            doc.fail(item.line, "seed lists '" + item.text + "' twice");
    return seeds.items();
}

/// Digests every frame of a file. Reading to the end also rejects a malformed file before the experiment starts.
/// @tparam Placed the state of an object per frame, a box or a pose
template <class Placed>
void add_frames(aabb::digest& digest, auto& scene, std::size_t objects) {
    digest.add(std::array{static_cast<std::uint32_t>(objects), static_cast<std::uint32_t>(scene.frames())});
    const auto add_all = [&](const auto& placed) {
        using state = std::remove_cvref_t<decltype(placed[0])>;
        for (const state& p : placed) digest.add(std::bit_cast<std::array<std::uint32_t, sizeof(state) / 4>>(p));
    };
    for (std::vector<Placed> frame; scene.next(frame);) {
        add_all(frame);
        if constexpr (std::same_as<Placed, aabb::box>) add_all(scene.in_double());
    }
}

/// Digests a filter; a scene without one adds nothing.
void add_filter(aabb::digest& digest, const scene_choice& choice, std::size_t objects) {
    const auto filter = filter_of(choice, objects);
    if (!filter) return;
    for (std::uint32_t id = 0; id < objects; ++id) {
        const aabb::object_filter object = (*filter)[id];
        digest.add(std::array{object.group, object.mask, static_cast<std::uint32_t>(object.set),
                              static_cast<std::uint32_t>(object.rests)});
    }
    for (const auto [a, b] : filter->exceptions()) digest.add(std::array{a, b});
}

/// Generates the scene once and digests the contents of its meshes and files: if they change, a run cannot be resumed.
void add_content(aabb::digest& digest, const scene_choice& choice, const scene_info& info) {
    if (info.has_meshes) {
        const std::unique_ptr<aabb::mesh_scene> scene = make_mesh_scene(choice);
        for (const aabb::mesh& m : scene->meshes) {
            for (const aabb::vec3f& v : m.vertices) digest.add(std::bit_cast<std::array<std::uint32_t, 3>>(v));
            for (const aabb::vec3d& v : m.given) digest.add(std::bit_cast<std::array<std::uint32_t, 6>>(v));
            for (const std::array<std::uint32_t, 3>& triangle : m.triangles) digest.add(triangle);
        }
        if (info.reads_file) add_frames<aabb::pose>(digest, *scene, scene->mesh_of.size());
        add_filter(digest, choice, scene->mesh_of.size());
    } else {
        const std::unique_ptr<aabb::box_scene> scene = make_box_scene(choice);
        if (info.reads_file) add_frames<aabb::box>(digest, *scene, scene->objects());
        add_filter(digest, choice, scene->objects());
    }
}

/// A scene of the config that has not been generated yet.
struct written_scene {
    scene_choice choice;
    const scene_info* info;
    int line;
    int file_line = 0;  ///< of the file's name; 0 if the scene has no file
};

/// The first line that names the strategy; 0 if none does.
int line_naming(const node& in, const std::string& strategy) {
    if (in.kind == node_kind::text && in.text.substr(0, in.text.find(':')) == strategy) return in.line;
    for (const node& item : in.items)
        if (const int line = line_naming(item, strategy); line > 0) return line;
    return 0;
}

/// Rejects compositions that need meshes if the scene has only boxes, at the line that names such a strategy.
void require_runnable(const document& doc, const written_scene& scene, const experiment& e) {
    if (scene.info->has_meshes) return;
    const node* compose = doc.root().find("compose");
    for (const aabb::composition& c : every_composition(e))
        for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
            const auto strategy = std::ranges::find(aabb::strategies(kind), c[kind].name, &aabb::strategy_info::name);
            if (strategy->needs_meshes.empty()) continue;
            const int line = compose ? line_naming(*compose, strategy->name) : 0;
            doc.fail(line > 0 ? line : scene.line, scene.choice.kind + ": " + strategy->needs_meshes);
        }
}

/// The line that names the scene's file; 0 if it has none.
int line_of_file(const scene_choice& choice, const std::vector<alternatives>& keys) {
    const auto file = std::ranges::find(choice.settings, "file", &aabb::setting::name);
    const auto key = std::ranges::find(keys, "file", &alternatives::first);
    if (file == choice.settings.end() || key == keys.end()) return 0;
    return std::ranges::find(key->second, file->value, &located_text::text)->line;
}

/// Digests the scene. Errors are reported at its line, but those of its file at the line that names the file.
void add_content(const document& doc, const written_scene& scene, aabb::digest& digest) {
    try {
        add_content(digest, scene.choice, *scene.info);
    } catch (const aabb::input_error& error) {
        const std::string sentence = error.what();
        const auto file = std::ranges::find(scene.choice.settings, "file", &aabb::setting::name);
        const bool is_of_file = scene.info->reads_file && scene.file_line > 0 && !file->value.empty() &&
                                sentence.starts_with(resolve_file(file->value, doc.folder()).string());
        doc.fail(is_of_file ? scene.file_line : scene.line, sentence);
    }
}

/// Adds the scenes of one [[scene]]: every combination of its kinds, settings and seeds.
/// @param seed the default of the config; null if it has none
void add_scenes(const document& doc, const node& written, const node* seed, experiment_size size,
                std::vector<std::string>& notes, unique_list<written_scene>& scenes) {
    doc.require_table("scene", written);
    const node scene = at_size(doc, written, size);
    const node& kinds =
        doc.required(scene, "kind", "this scene has no kind; expected kind = \"" + scene_names()[0] + "\" or another");
    const std::vector<located_text> names = kinds_of(doc, kinds);
    for (const located_text& kind : names) require_known_keys(doc, written, info_of(doc, kind));
    const node* own_seed = scene.find("seed");
    const std::vector<std::optional<std::uint64_t>> all_seeds = seeds_of(doc, own_seed ? own_seed : seed);
    const node* quick = written.find("quick");
    if (size == experiment_size::quick && quick && is_false(*quick)) return;
    for (const located_text& kind : names) {
        const scene_info& info = info_of(doc, kind);
        const std::vector<std::string> meshes = meshes_of(doc, scene, notes);
        const std::vector<alternatives> keys = settings_of(doc, scene, info.reads_file);
        const std::vector<std::optional<std::uint64_t>> no_seed{std::nullopt};
        const auto& seeds = info.reads_file ? no_seed : all_seeds;
        doc.require_small_product(written.line, "scenes", sizes_of(keys, seeds.size()), scenes.items().size());
        for (const std::vector<aabb::setting>& settings : cartesian_product(keys))
            for (const std::optional<std::uint64_t> seed_value : seeds) {
                written_scene resolved{{kind.text, settings, meshes, seed_value, doc.folder()}, &info, written.line};
                resolved.file_line = line_of_file(resolved.choice, keys);
                const std::string text = resolved.choice.kind + " " + parameters_text(resolved.choice);
                if (!scenes.add(resolved, text)) doc.fail(written.line, "this scene is listed twice: " + text);
            }
    }
}

}  // namespace

/// The entry with the default seeds of scenes: that of `quick` in quick runs, if it has one. Null if there is none.
const node* seed_of(const document& doc, experiment_size size) {
    const node* quick = doc.root().find("quick");
    if (quick) {
        doc.require_table("quick", *quick, " of quick", {"seed"});
        if (const node* seed = quick->find("seed"); seed && size == experiment_size::quick) return seed;
    }
    return doc.root().find("seed");
}

/// Reads and checks all scenes into e.scenes. A config is read for full and for quick runs: scenes that e already has,
/// from the first reading, are not generated again for a check of their files.
void read_scenes(const document& doc, experiment_size size, experiment& e) {
    const node& scenes = doc.required(doc.root(), "scene", "this config has no scene; expected at least one [[scene]]");
    const std::span<const node> tables = doc.tables_of("scene");
    const node* seed = seed_of(doc, size);
    unique_list<written_scene> written;
    for (const node& scene : tables) add_scenes(doc, scene, seed, size, e.notes, written);
    if (written.items().empty())
        doc.fail(scenes.line, tables.empty() ? "this config has no scene; expected at least one [[scene]]"
                                             : "every scene of this config is left out by quick = false");
    const std::set<scene_choice> checked(e.scenes.begin(), e.scenes.end());
    e.scenes.clear();
    aabb::digest content;
    for (const written_scene& scene : written.items()) {
        require_runnable(doc, scene, e);
        if (!checked.contains(scene.choice)) add_content(doc, scene, content);
        e.scenes.push_back(scene.choice);
    }
    e.content_digest = content.text();
}

}  // namespace aabblab
