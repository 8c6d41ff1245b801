module;
#define XXH_INLINE_ALL
#include <xxhash.h>

#include <nlohmann/json.hpp>

#include <array>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

#include "commit.hpp"

module aabblab.results;

import aabb.base;
import aabblab.files;
import aabblab.scenes;

namespace aabblab {

namespace {

using json = nlohmann::ordered_json;

std::string cpu_model() {
    std::ifstream in("/proc/cpuinfo");
    for (std::string line; std::getline(in, line);)
        if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
    return "unknown";
}

/// Of the program that runs: what was changed and not committed makes another build too.
std::string own_digest() {
    const std::string bytes = bytes_of_file("/proc/self/exe");
    std::array<char, 17> digits{};
    std::snprintf(digits.data(), digits.size(), "%016llx",
                  static_cast<unsigned long long>(XXH3_64bits(bytes.data(), bytes.size())));
    return digits.data();
}

/// What made the results. Times of different builds or machines must not meet in one table.
json build() {
    static const std::string digest = own_digest();
    return {{"version", AABBLAB_VERSION},   {"commit", AABBLAB_COMMIT},   {"dirty", AABBLAB_DIRTY},
            {"compiler", AABBLAB_COMPILER}, {"flags", AABBLAB_FLAGS},     {"build_type", AABBLAB_BUILD_TYPE},
            {"cpu", cpu_model()},           {"engines", AABBLAB_ENGINES}, {"program", digest}};
}

json read_json(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file))
        throw aabb::input_error(file.string() + " is not there; results without it cannot be used");
    json content = json::parse(bytes_of_file(file), nullptr, false);
    if (!content.is_object() || !content.contains("build") || !content.contains("config"))
        throw aabb::input_error(file.string() + " is not a manifest of results");
    return content;
}

}  // namespace

std::string date_now() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text.data();
}

std::string manifest_text(const experiment_record& e, const std::string& date, const scene_digests& digests) {
    json scenes = json::array();
    for (const scene_choice& scene : e.scenes) {
        const auto digest = digests.find(scene);
        scenes.push_back({{"kind", scene.kind}, {"parameters", json::parse(parameters_json(scene))}});
        if (scene.seed) scenes.back()["seed"] = *scene.seed;
        if (digest != digests.end()) scenes.back()["digest"] = digest->second;
    }
    const json manifest{
        {"experiment", e.name}, {"date", date},
        {"build", build()},     {"config", {{"file", e.file}, {"hash", e.hash}, {"quick", e.quick}, {"text", e.text}}},
        {"scenes", scenes},     {"notes", e.notes}};
    // The file's name need not be UTF-8.
    return manifest.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

std::string refusal_to_resume(const std::filesystem::path& manifest, const experiment_record& e) {
    const json before = read_json(manifest);
    const std::string where = "the results in " + manifest.parent_path().string();
    if (before["config"].value("hash", "") != e.hash)
        return where + " are of another config or size, or of other meshes or recordings";
    if (before["build"] != build())
        return where + " were made by another build or machine (commit " + before["build"].value("commit", "unknown") +
               "), whose times cannot be compared";
    return {};
}

resumed_manifest resume_manifest(const std::filesystem::path& file, const experiment_record& e) {
    if (const std::string refusal = refusal_to_resume(file, e); !refusal.empty())
        throw aabb::input_error(refusal + "; --out DIR puts new ones elsewhere");
    const json before = read_json(file);
    resumed_manifest manifest{before.value("date", ""), {}};
    for (const json& scene : before.value("scenes", json::array())) {
        scene_choice played{scene.value("kind", ""), {}, {}, std::nullopt};
        if (scene.contains("seed")) played.seed = scene.value("seed", std::uint64_t{0});
        if (scene.contains("digest") && set_parameters(played, scene.value("parameters", json()).dump()))
            manifest.digests[played] = scene["digest"];
    }
    return manifest;
}

std::string build_description() {
    return build().dump(2) + "\n";
}

manifest_summary read_manifest(const std::filesystem::path& folder) {
    const json manifest = read_json(folder / "manifest.json");
    const json& made = manifest["build"];
    manifest_summary summary{manifest.value("date", ""), made.value("commit", "unknown"), made.value("compiler", ""),
                             made.value("cpu", ""), manifest.value("notes", std::vector<std::string>{})};
    if (made.value("dirty", false)) summary.commit += " (changed)";
    return summary;
}

}  // namespace aabblab
