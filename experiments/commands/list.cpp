#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "command_parser.hpp"
#include "commands.hpp"
#include "output.hpp"

import aabb.base;
import aabb.policy;
import aabb.registry;
import aabb.validation;
import aabblab.metrics;
import aabblab.scenes;
import aabblab.stepping;

namespace aabblab {

namespace {

const metric_group_info& group_of(const metric& m) {
    return metric_groups[static_cast<std::size_t>(m.group)];
}

nlohmann::ordered_json to_json(std::span<const aabb::parameter_info> parameters) {
    auto all = nlohmann::ordered_json::array();
    for (const auto& p : parameters) {
        all.push_back({{"name", p.name}, {"expected", to_text(p.values)}, {"default", p.fallback}, {"help", p.help}});
        if (p.fallback.empty()) all.back()["default"] = nullptr;
    }
    return all;
}

nlohmann::ordered_json everything() {
    nlohmann::ordered_json all;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        auto& of_kind = all["strategies"][std::string(aabb::name_of(kind))];
        for (const auto& s : aabb::strategies(kind))
            of_kind.push_back(
                {{"name", s.name}, {"summary", s.summary}, {"exact", s.exact}, {"parameters", to_json(s.parameters)}});
    }
    for (const auto& e : aabb::engines())
        all["engines"].push_back({{"name", e.name},
                                  {"summary", e.summary},
                                  {"searches_boxes", e.searches_boxes},
                                  {"collides_meshes", e.collides_meshes},
                                  {"exact", e.exact}});
    all["engines_left_out"] = nlohmann::ordered_json::array();
    for (const auto& e : aabb::left_out_engines())
        all["engines_left_out"].push_back({{"name", e.name}, {"not_found", e.library}});
    for (const auto& t : aabb::library_tests())
        all["library_tests"].push_back({{"name", t.name},
                                        {"summary", t.summary},
                                        {"engine", t.engine},
                                        {"exact", t.exact},
                                        {"parameters", to_json(t.parameters)}});
    for (const integrator_info& i : integrators())
        all["integrators"].push_back(
            {{"name", i.name}, {"summary", i.summary}, {"order", i.order}, {"adaptive", i.adaptive}});
    for (const auto& s : scene_kinds())
        all["scenes"].push_back({{"name", s.name},
                                 {"summary", s.summary},
                                 {"has_meshes", s.has_meshes},
                                 {"has_seed", !s.plays_file},
                                 {"parameters", to_json(s.parameters)}});
    for (const auto& s : shapes())
        all["shapes"].push_back({{"name", s.name}, {"summary", s.summary}, {"parameters", to_json(s.parameters)}});
    for (const auto& c : pair_classes()) all["pairs"].push_back({{"name", c.name}, {"summary", c.summary}});
    for (const metric_group_info& group : metric_groups)
        all["recorded"].push_back({{"name", group.name}, {"summary", group.summary}});
    for (const metric& m : metrics())
        all["metrics"].push_back({{"name", m.name},
                                  {"summary", m.summary},
                                  {"unit", m.unit},
                                  {"recorded", group_of(m).name},
                                  {"better", m.direction == better::less   ? "less"
                                             : m.direction == better::more ? "more"
                                                                           : "neither"}});
    return all;
}

void print_entry(std::string_view name, std::string_view text) {
    print(entry(fmt::format("  {}", name), text));
}

void print_parameters(std::span<const aabb::parameter_info> parameters) {
    for (const auto& p : parameters)
        print(entry(
            fmt::format("    {}={}", p.name, p.fallback.empty() ? "…" : p.fallback),
            fmt::format("{}: {}{}", p.help, to_text(p.values), p.fallback.empty() ? ", which must be given" : "")));
}

/// With their parameters.
template <class Infos>
void print_infos(const Infos& infos) {
    for (const auto& info : infos) {
        print_entry(info.name, info.summary);
        print_parameters(info.parameters);
    }
}

std::string scope_of(const aabb::engine_info& engine) {
    const std::string scope = !engine.collides_meshes ? "boxes" : engine.searches_boxes ? "boxes and meshes" : "meshes";
    return engine.exact ? scope + ", exact" : scope;
}

void print_engines() {
    for (const auto& e : aabb::engines()) print_entry(e.name, e.summary + " (" + scope_of(e) + ")");
    for (const auto& e : aabb::left_out_engines())
        print_entry(e.name, "left out: " + e.library + " was not found when this was built");
}

void print_integrators() {
    for (const integrator_info& i : integrators()) print_entry(i.name, i.summary);
    for (const std::string_view name : left_out_integrators())
        print_entry(name,
                    "left out: its library was not found when this was built; ./aabblab validate stiff installs it");
}

void print_pair_classes() {
    for (const auto& c : pair_classes()) print_entry(c.name, c.summary);
}

void print_metric_groups() {
    for (const metric_group_info& group : metric_groups) print_entry(group.name, group.summary);
}

void print_metrics() {
    for (const metric& m : metrics())
        print_entry(m.name, fmt::format("{} ({}{})", m.summary, m.unit.empty() ? "" : m.unit + ", ", group_of(m).name));
}

/// A part of the list, with the names that `list` takes and JSON has.
struct section {
    std::string name;
    std::string heading;  ///< what is said behind the name
    std::function<void()> print_entries;
};

std::vector<section> sections() {
    std::vector<section> all;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds)
        all.push_back({std::string(name_of(kind)), "", [kind] { print_infos(aabb::strategies(kind)); }});
    all.push_back({"engines", "", print_engines});
    all.push_back({"library_tests", ", triangle tests of engines' libraries, for classify and errors",
                   [] { print_infos(aabb::library_tests()); }});
    all.push_back({"integrators", ", of validate stiff", print_integrators});
    all.push_back({"scenes", "", [] { print_infos(scene_kinds()); }});
    all.push_back({"shapes", ", in place of a mesh file", [] { print_infos(shapes()); }});
    all.push_back({"pairs", " of triangles, for errors", print_pair_classes});
    all.push_back({"recorded", ", for metrics of each", print_metric_groups});
    all.push_back({"metrics", "", print_metrics});
    return all;
}

std::vector<std::string> section_names() {
    std::vector<std::string> names;
    for (const section& one : sections()) names.push_back(one.name);
    return names;
}

void require_section(const std::string& name) {
    const std::vector<std::string> names = section_names();
    if (std::ranges::find(names, name) == names.end())
        throw aabb::input_error("list: " + aabb::unknown_name("kind", name, names, "aabblab list --help"));
}

/// @param name of the only section; none for all
void print_text(const std::optional<std::string>& name) {
    for (const section& one : sections()) {
        if (name && one.name != *name) continue;
        print(one.name + one.heading + "\n");
        one.print_entries();
    }
}

/// What stands in `everything` about one section alone.
nlohmann::ordered_json part_of(const nlohmann::ordered_json& whole, const std::string& name) {
    if (whole["strategies"].contains(name)) return {{"strategies", {{name, whole["strategies"][name]}}}};
    nlohmann::ordered_json part{{name, whole[name]}};
    if (name == "engines") part["engines_left_out"] = whole["engines_left_out"];
    return part;
}

}  // namespace

void add_list(const command_parser& program, int&) {
    const command_parser command =
        program.add_command("list", "Strategies with their parameters, engines, scenes and metrics");
    auto kind = std::make_shared<std::optional<std::string>>();
    auto json = std::make_shared<bool>(false);
    std::string names;
    for (const std::string& name : section_names()) names += (names.empty() ? "" : ", ") + name;
    command.add_option("KIND", *kind, "List these only: one of " + names).type_name("");
    command.add_flag("--json", *json, "Print it as JSON");
    command.callback([kind, json] {
        if (*kind) require_section(**kind);
        if (*json)
            print((*kind ? part_of(everything(), **kind) : everything()).dump(2) + "\n");
        else
            print_text(*kind);
    });
}

}  // namespace aabblab
