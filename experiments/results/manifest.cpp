module;
#include <nlohmann/json.hpp>

#include "commit.hpp"

module aabblab.results;

import aabb.costs;
import aabb.digest;
import aabblab.files;
import aabblab.json;
import aabblab.machine;
import aabblab.sha256;

namespace aabblab {

namespace {

using json = nlohmann::ordered_json;

const machine& host() {
    static const machine detected = this_machine();
    return detected;
}

/// The build and machine, which determine times; results that differ in it must not be mixed in one table.
json build_json() {
    // A hash of the executable also detects changes that were not committed.
    static const std::string digest = aabb::hash_of_text(bytes_of_file("/proc/self/exe"));
    return {{"version", AABBLAB_VERSION}, {"commit", AABBLAB_COMMIT},
            {"dirty", AABBLAB_DIRTY},     {"compiler", AABBLAB_COMPILER},
            {"flags", AABBLAB_FLAGS},     {"build_type", AABBLAB_BUILD_TYPE},
            {"cpu", host().processor},    {"caches", host().caches},
            {"engines", AABBLAB_ENGINES}, {"program", digest}};
}

/// Further properties of the machine, which may change during an experiment without invalidating its times.
json machine_json() {
    json properties{{"processors", host().processors}, {"kernel", host().kernel}, {"libc", host().libc}};
    if (host().governor) properties["governor"] = *host().governor;
    if (host().hypervisor) properties["hypervisor"] = *host().hypervisor;
    return properties;
}

/// The cost model by which strategies plan. With other costs they do other work, so times are not comparable.
json costs_json() {
    json ns = json::object();
    for (const aabb::cost_info& cost : aabb::cost_infos) ns[std::string(cost.name)] = aabb::machine_costs().*cost.value;
    return {{"source", aabb::machine_costs() == aabb::cost_model{} ? "shipped" : "calibrated"}, {"ns", std::move(ns)}};
}

json json_of(const candidate_name& name) {
    json parts = json::object();
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (!name[kind].empty()) parts[std::string(name_of(kind))] = name[kind];
    if (!name.engine.empty()) parts["engine"] = name.engine;
    return parts;
}

candidate_name candidate_of(const json_value& parts) {
    candidate_name name;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        name[kind] = parts.text(std::string(name_of(kind))).value_or("");
    name.engine = parts.text("engine").value_or("");
    return name;
}

/// The parameters of a strategy or a kind of scene with their defaults; those without one must be set.
json json_of(std::span<const aabb::parameter_info> parameters) {
    json defaults = json::object();
    for (const aabb::parameter_info& p : parameters)
        if (!p.fallback.empty()) defaults[p.name] = p.fallback;
    return defaults;
}

/// The defaults that completed what scenes and candidates leave out, so that another version knows what was run.
json defaults_json(std::span<const scene_choice> scenes, std::span<const candidate_name> candidates) {
    json of_scenes = json::object();
    for (const scene_choice& scene : scenes)
        if (std::ranges::count(scene_names(), scene.kind) > 0)
            of_scenes[scene.kind] = json_of(scene_named(scene.kind).parameters);
    json of_strategies = json::object();
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        for (const candidate_name& name : candidates) {
            const std::string strategy = name[kind].substr(0, name[kind].find(':'));
            const auto info = std::ranges::find(aabb::strategies(kind), strategy, &aabb::strategy_info::name);
            if (info != aabb::strategies(kind).end())
                of_strategies[std::string(name_of(kind))][strategy] = json_of(info->parameters);
        }
    return {{"scenes", std::move(of_scenes)}, {"strategies", std::move(of_strategies)}};
}

json json_of(const table_seal& table) {
    return {{"rows", table.rows}, {"sha256", table.checksum}};
}

table_seal table_of(const json_value& table) {
    return {table.needed("rows").index(), table.needed("sha256").text()};
}

/// Replaces invalid UTF-8, since names of files may contain any bytes.
std::string text_of(const json& manifest, int indent) {
    return manifest.dump(indent, ' ', false, json::error_handler_t::replace);
}

/// The checksum of a manifest without the checksum itself.
std::string checksum_of(json manifest) {
    manifest["seal"].erase("manifest");
    return sha256_of(text_of(manifest, -1));
}

results_seal seal_in(const json_value& seal) {
    results_seal checksums{table_of(seal.needed("results.csv")), std::nullopt, {}};
    if (const auto table = seal.member("differences.csv")) checksums.differences = table_of(*table);
    for (const json_value& c : seal.objects("contenders")) checksums.candidates.push_back(candidate_of(c));
    return checksums;
}

/// A parsed manifest, which may have been edited.
struct parsed_manifest {
    json_value content;
    json raw;  ///< preserves the order of members, for checksums
};

/// Parses a manifest, the file that says how results were made, with their checksums. It is parsed twice: `content`
/// has messages that name the place of an error, `raw` keeps the order of members, on which checksums depend.
parsed_manifest parse_manifest(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file))
        throw aabb::input_error(file.string() + " does not exist; results without it cannot be used");
    const std::string text = text_of_file(file);
    const char* const rejection = "is not a manifest of results";
    json_value content(file.string(), text, rejection);
    if (!content.has("build") || !content.has("config")) throw aabb::input_error(file.string() + " " + rejection);
    return {std::move(content), json::parse(text)};
}

/// A JSON number if its text is identical to the value, otherwise a string.
json json_of(const std::string& value) {
    const json parsed = json::parse(value, nullptr, false);
    return parsed.is_number() && parsed.dump() == value ? parsed : json(value);
}

/// The scenes of a manifest in order, with the digests of the ground truth, which may be empty.
std::vector<std::pair<scene_choice, std::string>> scenes_in(const parsed_manifest& manifest) {
    std::vector<std::pair<scene_choice, std::string>> scenes;
    for (const json_value& scene : manifest.content.objects("scenes")) {
        scene_choice choice{scene.text("kind").value_or(""), /*settings=*/{}, /*meshes=*/{}, scene.index("seed")};
        // Preserve the order in which they were written, because rows have the same order.
        const json& raw = manifest.raw["scenes"][scenes.size()];
        if (!set_parameters(choice, raw.value("parameters", json()).dump()))
            scene.fail("must have parameters, an object of settings");
        scenes.emplace_back(std::move(choice), scene.text("digest").value_or(""));
    }
    return scenes;
}

}  // namespace

std::string parameters_json(const scene_choice& scene) {
    json parameters = json::object();
    for (const aabb::setting& s : scene.settings) parameters[s.name] = json_of(s.value);
    if (!scene.meshes.empty()) parameters["meshes"] = scene.meshes;
    return text_of(parameters, -1);
}

/// Sets a scene's meshes (an array of names) and settings (strings or numbers) from a JSON object.
/// @returns false if the text is anything else
bool set_parameters(scene_choice& scene, const std::string& text) {
    const json parameters = json::parse(text, nullptr, /*allow_exceptions=*/false);
    if (!parameters.is_object()) return false;
    for (const auto& [name, value] : parameters.items()) {
        if (name == "meshes") {
            if (!value.is_array()) return false;
            for (const json& mesh : value) {
                if (!mesh.is_string()) return false;
                scene.meshes.push_back(mesh);
            }
        } else if (value.is_string() || value.is_number()) {
            scene.settings.push_back({name, value.is_string() ? value.get<std::string>() : value.dump()});
        } else {
            return false;
        }
    }
    return true;
}

/// The manifest of a run as JSON. With a seal, after the run, it has checksums of the tables, and of itself.
std::string manifest_text(const experiment_record& e, const std::string& date, const scene_digests& digests,
                          const std::optional<results_seal>& seal) {
    json scenes = json::array();
    for (const scene_choice& scene : e.scenes) {
        const auto digest = digests.find(scene);
        scenes.push_back({{"kind", scene.kind}, {"parameters", json::parse(parameters_json(scene))}});
        if (scene.seed) scenes.back()["seed"] = *scene.seed;
        if (digest != digests.end()) scenes.back()["digest"] = digest->second;
    }
    // Without its folder, which says something only on the machine of the run.
    const json config{{"file", std::filesystem::path(e.file).filename().string()},
                      {"hash", e.hash},
                      {"quick", e.quick},
                      {"text", e.text}};
    json manifest{{"experiment", e.name},  {"date", date},     {"build", build_json()}, {"machine", machine_json()},
                  {"costs", costs_json()}, {"config", config}, {"scenes", scenes},      {"notes", e.notes}};
    if (seal) {
        manifest["defaults"] = defaults_json(e.scenes, seal->candidates);
        json& checksums = manifest["seal"] = json{{"results.csv", json_of(seal->results)}};
        if (seal->differences) checksums["differences.csv"] = json_of(*seal->differences);
        checksums["contenders"] = json::array();  // candidates; manifests keep this older name
        for (const candidate_name& name : seal->candidates) checksums["contenders"].push_back(json_of(name));
        checksums["manifest"] = checksum_of(manifest);
    }
    return text_of(manifest, /*indent=*/2) + "\n";
}

/// Reads the parts of a manifest by which results are verified, and rejects it if it was altered after it was sealed.
sealed_manifest read_sealed_manifest(const std::filesystem::path& file) {
    const parsed_manifest manifest = parse_manifest(file);
    sealed_manifest result{manifest.content.text("experiment").value_or(""), scenes_in(manifest),
                           /*seal=*/std::nullopt};
    const std::optional<json_value> seal = manifest.content.member("seal");
    if (!seal) return result;
    result.seal = seal_in(*seal);
    if (seal->needed("manifest").text() != checksum_of(manifest.raw))
        throw aabb::input_error(file.string() +
                                " was altered after the run: it does not have the checksum that it states");
    return result;
}

/// Why results cannot be resumed: times of another build, machine or cost model are not comparable; empty if they can.
std::string rejection_to_resume(const std::filesystem::path& manifest, const experiment_record& e) {
    const parsed_manifest previous = parse_manifest(manifest);
    const std::string where = "the results in " + manifest.parent_path().string();
    if (previous.content.needed("config").text("hash") != e.hash)
        return where + " are of another config or size, or of other meshes or recordings";
    if (previous.raw["build"] != build_json())
        return where + " were made by another build or machine (commit " +
               previous.content.needed("build").text("commit").value_or("unknown") +
               "), whose times cannot be compared";
    if (previous.raw.value("costs", json()) != costs_json())
        return where + " were made with other costs (aabblab calibrate), with which strategies plan differently";
    if (!previous.content.has("seal")) return {};
    // Altered results must not be resumed and sealed again.
    try {
        (void)verified_rows(manifest.parent_path());
    } catch (const aabb::input_error& altered) {
        return altered.what();
    }
    return {};
}

/// The date of results that are resumed, and the digests of the ground truth of their scenes.
std::pair<std::string, scene_digests> resume_manifest(const std::filesystem::path& file, const experiment_record& e) {
    if (const std::string rejection = rejection_to_resume(file, e); !rejection.empty())
        throw aabb::input_error(rejection + "; --out DIR puts new ones elsewhere");
    const parsed_manifest previous = parse_manifest(file);
    scene_digests digests;
    for (auto& [scene, digest] : scenes_in(previous))
        if (!digest.empty()) digests[std::move(scene)] = std::move(digest);
    return {previous.content.text("date").value_or(""), digests};
}

std::vector<scene_defaults> read_scene_defaults(const std::filesystem::path& folder) {
    std::vector<scene_defaults> defaults;
    const std::filesystem::path file = folder / "manifest.json";
    const parsed_manifest manifest = parse_manifest(file);
    const std::optional<json_value> stated = manifest.content.member("defaults");
    if (!stated) return defaults;
    (void)stated->needed("scenes");  // rejects anything but an object with this member
    const json& of_scenes = manifest.raw["defaults"]["scenes"];
    for (const auto& [kind, parameters] : of_scenes.items()) {
        scene_defaults& of_kind = defaults.emplace_back(scene_defaults{kind, {}});
        for (const auto& [name, value] : parameters.items()) {
            if (!value.is_string())
                throw aabb::input_error(file.string() + ": the default of " + name + " of " + kind + " is not a text");
            of_kind.parameters.push_back({name, value.get<std::string>()});
        }
    }
    return defaults;
}

std::string build_description() {
    return build_json().dump(2) + "\n";
}

/// Reads the parts of a manifest that reports show.
manifest_summary read_manifest(const std::filesystem::path& folder) {
    const parsed_manifest manifest = parse_manifest(folder / "manifest.json");
    const json_value build = manifest.content.needed("build");
    const json_value config = manifest.content.needed("config");
    manifest_summary summary{.date = manifest.content.text("date").value_or(""),
                             .commit = build.text("commit").value_or("unknown"),
                             .compiler = build.text("compiler").value_or(""),
                             .flags = build.text("flags").value_or(""),
                             .cpu = build.text("cpu").value_or(""),
                             .notes = manifest.content.texts("notes"),
                             .config = config.text("text").value_or(""),
                             .quick = config.flag("quick").value_or(false),
                             .finished = manifest.content.has("seal"),
                             .text = text_of(manifest.raw, /*indent=*/2) + "\n"};
    if (build.flag("dirty").value_or(false)) summary.commit += " (changed)";  // files differed from the commit
    return summary;
}

}  // namespace aabblab
