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

struct list_item {
    std::string name, summary;
    std::span<const aabb::parameter_info> parameters;
    json members;
};

/// A part of the list, with its name as the argument of `list` and as the key in JSON.
struct section {
    std::string name;
    std::string heading;  ///< follows the name in text
    std::vector<list_item> entries;
    std::vector<list_item> left_out = {};  ///< items that this build lacks
};

/// The parameters of a strategy, scene or shape; one that must be given has the default null.
json json_of(std::span<const aabb::parameter_info> parameters) {
    json array = json::array();
    for (const aabb::parameter_info& p : parameters) {
        array.push_back({{"name", p.name}, {"expected", to_text(p.values)}, {"default", p.fallback}, {"help", p.help}});
        if (p.fallback.empty()) array.back()["default"] = nullptr;
    }
    return array;
}

std::string_view group_of(const metric& m) {
    return metric_groups[static_cast<std::size_t>(m.group)].name;
}

std::string summary_of(const auto& info) {
    return std::string(info.summary);
}
std::string summary_of(const aabb::engine_info& e) {
    const char* scope = !e.collides_meshes ? "boxes" : e.searches_boxes ? "boxes and meshes" : "meshes";
    return fmt::format("{} ({}{})", e.summary, scope, e.exact ? ", exact" : "");
}
std::string summary_of(const metric& m) {
    return fmt::format("{} ({}{})", m.summary, m.unit.empty() ? "" : m.unit + ", ", group_of(m));
}

/// An item of the list, from the description of a strategy, engine, scene, metric and so on.
list_item item_of(const auto& info) {
    list_item item{
        std::string(info.name), summary_of(info), /*parameters=*/{}, {{"name", info.name}, {"summary", info.summary}}};
    json& members = item.members;
    if constexpr (requires { info.engine; }) members["engine"] = info.engine;
    if constexpr (requires { info.searches_boxes; }) members["searches_boxes"] = info.searches_boxes;
    if constexpr (requires { info.collides_meshes; }) members["collides_meshes"] = info.collides_meshes;
    if constexpr (requires { info.exact; }) members["exact"] = info.exact;
    if constexpr (requires { info.order; }) members["order"] = info.order;
    if constexpr (requires { info.adaptive; }) members["adaptive"] = info.adaptive;
    if constexpr (requires { info.has_meshes; }) members["has_meshes"] = info.has_meshes;
    if constexpr (requires { info.reads_file; }) members["has_seed"] = !info.reads_file;
    if constexpr (requires { info.unit; }) members["unit"] = info.unit;
    if constexpr (requires { info.group; }) members["recorded"] = group_of(info);
    if constexpr (requires { info.direction; })
        members["better"] = info.direction == better::less   ? "less"
                            : info.direction == better::more ? "more"
                                                             : "neither";
    if constexpr (requires { info.parameters; }) {
        item.parameters = info.parameters;
        members["parameters"] = json_of(item.parameters);
    }
    return item;
}

std::vector<list_item> items_of(const auto& infos) {
    std::vector<list_item> items;
    for (const auto& info : infos) items.push_back(item_of(info));
    return items;
}

/// All parts of the list in the order of its text; what this build lacks is listed as left out.
std::vector<section> sections() {
    std::vector<section> list;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        list.push_back({std::string(name_of(kind)), "", items_of(aabb::strategies(kind))});
    list.push_back({"engines", "", items_of(aabb::engines())});
    for (const auto& e : aabb::left_out_engines()) {
        const std::string summary = "left out: " + e.library + " was not found when this was built";
        list.back().left_out.push_back(
            {e.name, summary, /*parameters=*/{}, {{"name", e.name}, {"not_found", e.library}}});
    }
    list.push_back({"library_tests", ", triangle tests of engines' libraries, for classify and errors",
                    items_of(aabb::library_tests())});
    list.push_back({"integrators", ", of validate stiff", items_of(integrators())});
    for (const std::string_view name : left_out_integrators()) {
        const char* summary =
            "left out: its library was not found when this was built; ./aabblab validate stiff installs it";
        list.back().left_out.push_back({std::string(name), summary, /*parameters=*/{}, /*members=*/{}});
    }
    list.push_back({"scenes", "", items_of(scene_kinds())});
    list.push_back({"shapes", ", in place of a mesh file", items_of(shapes())});
    list.push_back({"pairs", " of triangles, for errors", items_of(pair_classes())});
    list.push_back({"recorded", ", groups of columns in results.csv", items_of(metric_groups)});
    list.push_back({"metrics", "", items_of(metrics())});
    return list;
}

std::vector<std::string> section_names() {
    std::vector<std::string> names;
    for (const section& part : sections()) names.push_back(part.name);
    return names;
}

/// Prints a part of the list: a line per item, and below it a line per parameter, "name=default".
void print_text(const section& part) {
    print(part.name + part.heading + "\n");
    for (const std::vector<list_item>& items : {part.entries, part.left_out})
        for (const list_item& item : items) {
            print(entry("  " + item.name, item.summary));
            for (const aabb::parameter_info& p : item.parameters)
                print(entry(fmt::format("    {}={}", p.name, p.fallback.empty() ? "…" : p.fallback),
                            fmt::format("{}: {}{}", p.help, to_text(p.values),
                                        p.fallback.empty() ? ", which must be given" : "")));
        }
}

json json_of(const std::vector<list_item>& entries) {
    json array = json::array();
    for (const list_item& item : entries) array.push_back(item.members);
    return array;
}

/// One key per part of the list; those of strategy kinds are grouped under "strategies".
json json_of(const std::vector<section>& sections) {
    json root;
    for (const section& part : sections) {
        const auto has_name = [&](aabb::strategy_kind kind) { return name_of(kind) == part.name; };
        const bool is_kind = std::ranges::any_of(aabb::strategy_kinds, has_name);
        (is_kind ? root["strategies"] : root)[part.name] = json_of(part.entries);
        if (part.name == "engines") root["engines_left_out"] = json_of(part.left_out);
    }
    return root;
}

/// Prints the whole list, or the part of one kind, as text or JSON.
void list(const list_request& request) {
    std::vector<section> shown = sections();
    if (request.kind) {
        const std::vector<std::string> names = section_names();
        if (std::ranges::find(names, *request.kind) == names.end())
            throw aabb::input_error("list: " + aabb::unknown_name("kind", *request.kind, names, "aabblab list --help"));
        std::erase_if(shown, [&](const section& part) { return part.name != *request.kind; });
    }
    if (request.json) return print(json_of(shown).dump(2) + "\n");
    for (const section& part : shown) print_text(part);
}

}  // namespace

void add_list(const command_parser& program) {
    const command_parser command =
        program.add_command("list", "List strategies with their parameters, engines, scenes and metrics");
    auto& request = command.set_action(list);
    command.optional_argument("KIND", &request.kind,
                              fmt::format("List only this kind: one of {}", fmt::join(section_names(), ", ")));
    command.flag("--json", &request.json, "Print the list as JSON");
    command.footer(
        "prepare … sweep: strategies of the broad phase\nbuild … triangle: strategies of the narrow phase\n"
        "engines: other libraries, and brute force\nlibrary_tests: triangle tests of engines, for classify and errors\n"
        "integrators: time integration methods of validate stiff\nscenes: generated or recorded scenes\n"
        "shapes: generated meshes\npairs: classes of generated triangle pairs, for errors\n"
        "recorded: groups of columns in results.csv\nmetrics: quantities computed from these columns");
}

}  // namespace aabblab
