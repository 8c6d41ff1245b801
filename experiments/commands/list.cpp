#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "command_parser.hpp"
#include "commands.hpp"
#include "output.hpp"

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
        all.push_back({{"name", p.name}, {"expected", p.expected}, {"default", p.fallback}, {"help", p.help}});
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

/// Lines of a heading's entries, the second column aligned.
class listing {
public:
    void heading(std::string_view text) { lines_.push_back({std::string(text), ""}); }
    void entry(std::string_view name, std::string_view text) {
        lines_.push_back({fmt::format("  {}", name), std::string(text)});
    }
    void parameters(std::span<const aabb::parameter_info> all) {
        for (const auto& p : all)
            lines_.push_back(
                {fmt::format("    {}={}", p.name, p.fallback.empty() ? "…" : p.fallback),
                 fmt::format("{}: {}{}", p.help, p.expected, p.fallback.empty() ? ", which must be given" : "")});
    }
    void print_all() const {
        std::size_t width = 0;
        for (const line& l : lines_)
            if (!l.right.empty()) width = std::max(width, l.left.size());
        for (const line& l : lines_)
            print(l.right.empty() ? l.left + "\n" : fmt::format("{:<{}}  {}\n", l.left, width, l.right));
    }

private:
    struct line {
        std::string left, right;
    };
    std::vector<line> lines_;
};

std::string scope_of(const aabb::engine_info& engine) {
    const std::string scope = !engine.collides_meshes ? "boxes" : engine.searches_boxes ? "boxes and meshes" : "meshes";
    return engine.exact ? scope + ", exact" : scope;
}

void print_text() {
    listing all;
    for (const aabb::strategy_kind kind : aabb::strategy_kinds) {
        all.heading(aabb::name_of(kind));
        for (const auto& s : aabb::strategies(kind)) {
            all.entry(s.name, s.summary);
            all.parameters(s.parameters);
        }
    }
    all.heading("engines");
    for (const auto& e : aabb::engines()) all.entry(e.name, e.summary + " (" + scope_of(e) + ")");
    for (const auto& e : aabb::left_out_engines())
        all.entry(e.name, "left out: " + e.library + " was not found when this was built");
    all.heading("triangle tests of engines' libraries, for classify and errors");
    for (const auto& t : aabb::library_tests()) {
        all.entry(t.name, t.summary);
        all.parameters(t.parameters);
    }
    all.heading("integrators, of validate stiff");
    for (const integrator_info& i : integrators()) all.entry(i.name, i.summary);
    for (const std::string_view name : left_out_integrators())
        all.entry(name, "left out: its library was not found when this was built; ./aabblab validate stiff installs it");
    all.heading("scenes");
    for (const auto& s : scene_kinds()) {
        all.entry(s.name, s.summary);
        all.parameters(s.parameters);
    }
    all.heading("shapes, in place of a mesh file");
    for (const auto& s : shapes()) {
        all.entry(s.name, s.summary);
        all.parameters(s.parameters);
    }
    all.heading("pairs of triangles, for errors");
    for (const auto& c : pair_classes()) all.entry(c.name, c.summary);
    all.heading("recorded, for metrics of each");
    for (const metric_group_info& group : metric_groups) all.entry(group.name, group.summary);
    all.heading("metrics");
    for (const metric& m : metrics())
        all.entry(m.name, fmt::format("{} ({}{})", m.summary, m.unit.empty() ? "" : m.unit + ", ", group_of(m).name));
    all.print_all();
}

}  // namespace

void add_list(const command_parser& program, int&) {
    const command_parser command =
        program.add_command("list", "Strategies with their parameters, engines, scenes and metrics");
    auto json = std::make_shared<bool>(false);
    command.add_flag("--json", *json, "Print it as JSON");
    command.callback([json] {
        if (*json)
            print(everything().dump(2) + "\n");
        else
            print_text();
    });
}

}  // namespace aabblab
