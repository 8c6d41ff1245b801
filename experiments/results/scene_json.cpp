module;
#include <nlohmann/json.hpp>

module aabblab.results;

import aabb.policy;

namespace aabblab {

namespace {

using json = nlohmann::ordered_json;

/// A number where that says the same, to the letter.
json json_of(const std::string& value) {
    const json parsed = json::parse(value, nullptr, false);
    return parsed.is_number() && parsed.dump() == value ? parsed : json(value);
}

std::string text_of(const json& value) {
    return value.is_string() ? value.get<std::string>() : value.dump();
}

}  // namespace

std::string parameters_json(const scene_choice& scene) {
    json all = json::object();
    for (const aabb::setting& s : scene.settings) all[s.name] = json_of(s.value);
    if (!scene.meshes.empty()) all["meshes"] = scene.meshes;
    // The name of a file need not be UTF-8.
    return all.dump(-1, ' ', false, json::error_handler_t::replace);
}

bool set_parameters(scene_choice& scene, const std::string& text) {
    const json all = json::parse(text, nullptr, false);
    if (!all.is_object()) return false;
    for (const auto& [name, value] : all.items()) {
        if (name == "meshes") {
            if (!value.is_array()) return false;
            for (const json& mesh : value) {
                if (!mesh.is_string()) return false;
                scene.meshes.push_back(mesh);
            }
        } else if (value.is_string() || value.is_number()) {
            scene.settings.push_back({name, text_of(value)});
        } else {
            return false;
        }
    }
    return true;
}

}  // namespace aabblab
