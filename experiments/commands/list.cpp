#include <nlohmann/json.hpp>

#include "command_parser.hpp"

import aabb.policy;
import aabb.registry;
import aabb.validation;
import aabblab.metrics;
import aabblab.scenes;
import aabblab.stepping;

namespace aabblab {

namespace {

using json = nlohmann::ordered_json;

struct list_request {
    std::optional<std::string> kind;
    bool json = false;
};

/// Something that has a name, for people and as JSON.
struct listed {
    std::string name;
    std::string said;
    std::span<const aabb::parameter_info> parameters;
    json members;
};

/// A part of the list, with the names that `list` takes and JSON has.
struct section {
    std::string name;
    std::string heading;  ///< what is said behind the name
    std::vector<listed> entries;
    std::vector<listed> left_out = {};  ///< of this build
};

json json_of(std::span<const aabb::parameter_info> parameters) {
    json all = json::array();
    for (const aabb::parameter_info& p : parameters) {
        all.push_back({{"name", p.name}, {"expected", to_text(p.values)}, {"default", p.fallback}, {"help", p.help}});
        if (p.fallback.empty()) all.back()["default"] = nullptr;
    }
    return all;
}

std::string_view group_of(const metric& m) {
    return metric_groups[static_cast<std::size_t>(m.group)].name;
}

std::string said_of(const auto& info) {
    return std::string(info.summary);
}
std::string said_of(const aabb::engine_info& e) {
    const char* scope = !e.collides_meshes ? "boxes" : e.searches_boxes ? "boxes and meshes" : "meshes";
    return fmt::format("{} ({}{})", e.summary, scope, e.exact ? ", exact" : "");
}
std::string said_of(const metric& m) {
    return fmt::format("{} ({}{})", m.summary, m.unit.empty() ? "" : m.unit + ", ", group_of(m));
}

/// What scripts may want to know, of what has it.
listed listed_of(const auto& info) {
    listed one{std::string(info.name), said_of(info), {}, {{"name", info.name}, {"summary", info.summary}}};
    json& members = one.members;
    if constexpr (requires { info.engine; }) members["engine"] = info.engine;
    if constexpr (requires { info.searches_boxes; }) members["searches_boxes"] = info.searches_boxes;
    if constexpr (requires { info.collides_meshes; }) members["collides_meshes"] = info.collides_meshes;
    if constexpr (requires { info.exact; }) members["exact"] = info.exact;
    if constexpr (requires { info.order; }) members["order"] = info.order;
    if constexpr (requires { info.adaptive; }) members["adaptive"] = info.adaptive;
    if constexpr (requires { info.has_meshes; }) members["has_meshes"] = info.has_meshes;
    if constexpr (requires { info.plays_file; }) members["has_seed"] = !info.plays_file;
    if constexpr (requires { info.unit; }) members["unit"] = info.unit;
    if constexpr (requires { info.group; }) members["recorded"] = group_of(info);
    if constexpr (requires { info.direction; })
        members["better"] = info.direction == better::less   ? "less"
                            : info.direction == better::more ? "more"
                                                             : "neither";
    if constexpr (requires { info.parameters; }) {
        one.parameters = info.parameters;
        members["parameters"] = json_of(one.parameters);
    }
    return one;
}

std::vector<listed> all_of(const auto& infos) {
    std::vector<listed> all;
    for (const auto& info : infos) all.push_back(listed_of(info));
    return all;
}

std::vector<section> sections() {
    std::vector<section> all;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        all.push_back({std::string(name_of(kind)), "", all_of(aabb::strategies(kind))});
    all.push_back({"engines", "", all_of(aabb::engines())});
    for (const auto& e : aabb::left_out_engines()) {
        const json members = {{"name", e.name}, {"not_found", e.library}};
        const std::string said = "left out: " + e.library + " was not found when this was built";
        all.back().left_out.push_back({e.name, said, {}, members});
    }
    all.push_back({"library_tests", ", triangle tests of engines' libraries, for classify and errors",
                   all_of(aabb::library_tests())});
    all.push_back({"integrators", ", of validate stiff", all_of(integrators())});
    for (const std::string_view name : left_out_integrators()) {
        const char* said =
            "left out: its library was not found when this was built; ./aabblab validate stiff installs it";
        all.back().left_out.push_back({std::string(name), said, {}, {}});
    }
    all.push_back({"scenes", "", all_of(scene_kinds())});
    all.push_back({"shapes", ", in place of a mesh file", all_of(shapes())});
    all.push_back({"pairs", " of triangles, for errors", all_of(pair_classes())});
    all.push_back({"recorded", ", for metrics of each", all_of(metric_groups)});
    all.push_back({"metrics", "", all_of(metrics())});
    return all;
}

std::vector<std::string> section_names() {
    std::vector<std::string> names;
    for (const section& one : sections()) names.push_back(one.name);
    return names;
}

void print_text(const section& one) {
    print(one.name + one.heading + "\n");
    for (const std::vector<listed>& part : {one.entries, one.left_out})
        for (const listed& l : part) {
            print(entry("  " + l.name, l.said));
            for (const aabb::parameter_info& p : l.parameters)
                print(entry(fmt::format("    {}={}", p.name, p.fallback.empty() ? "…" : p.fallback),
                            fmt::format("{}: {}{}", p.help, to_text(p.values),
                                        p.fallback.empty() ? ", which must be given" : "")));
        }
}

json json_of(const std::vector<listed>& entries) {
    json all = json::array();
    for (const listed& one : entries) all.push_back(one.members);
    return all;
}

json json_of(const std::vector<section>& sections) {
    json all;
    for (const section& one : sections) {
        const auto is_it = [&](aabb::strategy_kind kind) { return name_of(kind) == one.name; };
        const bool is_kind = std::ranges::any_of(aabb::strategy_kinds, is_it);
        (is_kind ? all["strategies"] : all)[one.name] = json_of(one.entries);
        if (one.name == "engines") all["engines_left_out"] = json_of(one.left_out);
    }
    return all;
}

void list(const list_request& request) {
    std::vector<section> all = sections();
    if (request.kind) {
        const std::vector<std::string> names = section_names();
        if (std::ranges::find(names, *request.kind) == names.end())
            throw aabb::input_error("list: " + aabb::unknown_name("kind", *request.kind, names, "aabblab list --help"));
        std::erase_if(all, [&](const section& one) { return one.name != *request.kind; });
    }
    if (request.json) return print(json_of(all).dump(2) + "\n");
    for (const section& one : all) print_text(one);
}

}  // namespace

void add_list(const command_parser& program) {
    const command_parser command =
        program.add_command("list", "Strategies with their parameters, engines, scenes and metrics");
    auto& request = command.calls(list);
    command.optional_argument("KIND", &request.kind,
                              fmt::format("List these only: one of {}", fmt::join(section_names(), ", ")));
    command.flag("--json", &request.json, "Print it as JSON");
}

}  // namespace aabblab
