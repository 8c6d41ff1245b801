#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "command_parser.hpp"
#include "output.hpp"

// Imports, so it comes last.
#include "composing.hpp"

import aabb.base;
import aabb.geometry;
import aabb.policy;
import aabb.registry;
import aabb.selection;
import aabblab.files;
import aabblab.scenes;

namespace aabblab {

namespace {

/// "bucket, or what goes with what is named", "as it serves the scene"
std::string usual_of(aabb::strategy_kind kind) {
    if (aabb::depends_on_scene(kind)) return "as it serves the scene";
    const aabb::strategy_kind_info& info = info_of(kind);
    const std::string text(info.fallback);
    return info.beside == info.fallback ? text : text + ", or what goes with what is named";
}

}  // namespace

std::string names_in_line(aabb::strategy_kind kind) {
    std::string text;
    for (const std::string& name : aabb::strategy_names(kind)) text += (text.empty() ? "" : ", ") + name;
    return text;
}

void stage_options::add_to(const command_parser& command) {
    for (const aabb::strategy_kind kind : kinds()) {
        const std::string name(name_of(kind));
        command
            .add_option(
                "--" + name, given_[kind],
                "One of " + names_in_line(kind) + " (default " + usual_of(kind) + "), as in NAME:parameter=value")
            .type_name("S");
    }
    command.footer("aabblab list has every strategy with its parameters.");
}

bool stage_options::any() const {
    return std::ranges::any_of(given_.all, [](const auto& one) { return one.has_value(); });
}

std::string stage_options::names() const {
    std::string text;
    const std::vector<aabb::strategy_kind> all = kinds();
    for (std::size_t i = 0; i < all.size(); ++i)
        text += (i == 0 ? "" : i + 1 == all.size() ? " and " : ", ") + ("--" + std::string(name_of(all[i])));
    return text;
}

void stage_options::add_to(aabb::named_strategies& named) const {
    for (const aabb::strategy_kind kind : kinds()) {
        if (!given_[kind]) continue;
        if (*given_[kind] == "auto")
            throw aabb::input_error("--" + std::string(name_of(kind)) +
                                    " auto: leave it out, since what is not named is selected");
        named[kind] = aabb::parse_strategy(*given_[kind]);
    }
}

std::vector<aabb::strategy_kind> stage_options::kinds() const {
    std::vector<aabb::strategy_kind> all;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        if (info_of(kind).stage == stage_) all.push_back(kind);
    return all;
}

void require_no_mesh(const std::string& out, const std::vector<std::string>& meshes) {
    std::vector<std::string> names;
    for (const std::string& name : meshes) names.emplace_back(name_without_order(name));
    std::vector<std::string> files = names;
    for (const std::string& name : names) files.push_back((data_folder() / name).string());
    require_other_file(out, files);
    // A file of that name here would from now on hide the one in the data folder.
    for (const std::string& name : names)
        if (std::filesystem::weakly_canonical(name) == std::filesystem::weakly_canonical(out))
            throw aabb::input_error(out + " is the name of a mesh that this command reads from the data folder");
}

void note_left_out(const std::vector<std::string>& names, const std::filesystem::path& folder) {
    const std::vector<std::string> endings = mesh_endings();
    for (const std::string& name : std::set(names.begin(), names.end()))
        if (std::ranges::find(endings, mesh_ending_of(name_without_order(name, folder))) != endings.end())
            if (const std::string left_out = make_mesh(name, folder).report.left_out(); !left_out.empty())
                note(name + ": " + left_out);
}

std::vector<aabb::mesh> read_meshes(const std::vector<std::string>& names) {
    std::vector<aabb::mesh> meshes;
    for (const std::string& name : names) {
        loaded_mesh loaded = make_mesh(name);
        if (const std::string report = loaded.report.text(); !report.empty()) note(name + ": " + report);
        meshes.push_back(std::move(loaded.mesh));
    }
    return meshes;
}

}  // namespace aabblab
