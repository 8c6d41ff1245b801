module;
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

module aabblab.extreme;

import aabb.extreme;
import aabb.validation;
import aabblab.tables;

namespace aabblab {

namespace {

constexpr std::array<std::string_view, 3> group_names = {"boxes", "meshes", "cases"};
constexpr std::array<std::string_view, 3> role_names = {"composition", "engine", "triangle_test"};

template <class Enum>
std::string name_in(const std::array<std::string_view, 3>& names, Enum value) {
    return std::string(names[static_cast<std::size_t>(value)]);
}

}  // namespace

table extreme_rows(std::span<const extreme_row> rows) {
    table t;
    for (const char* name : {"group", "scene", "class", "contender", "role", "must_be_exact", "answer", "as_expected",
                             "missing", "invented"})
        t.columns.push_back({name});
    for (const char* what : {"missing_", "invented_"})
        for (const std::string_view name : aabb::difference_class_names)
            t.columns.push_back({what + std::string(name)});
    for (const char* name : {"bytes", "reason", "about"}) t.columns.push_back({name});
    const auto yes = [](bool value) { return std::string(value ? "yes" : "no"); };
    for (const extreme_row& row : rows) {
        std::vector<std::string> cells{name_in(group_names, row.group),
                                       row.scene,
                                       row.kind,
                                       row.contender,
                                       name_in(role_names, row.role),
                                       yes(row.must_be_exact),
                                       name_in(aabb::verdict_names, row.made.said),
                                       yes(row.as_expected),
                                       std::to_string(row.made.missing),
                                       std::to_string(row.made.invented)};
        for (const auto* counts : {&row.made.classes.missing, &row.made.classes.invented})
            for (const std::size_t count : *counts) cells.push_back(std::to_string(count));
        cells.insert(cells.end(), {std::to_string(row.made.bytes), row.made.reason, row.about});
        t.rows.push_back(std::move(cells));
    }
    return t;
}

std::vector<std::string> refusals_in(std::span<const extreme_row> rows) {
    std::vector<std::pair<std::string, std::vector<std::string>>> scenes_of;  // by sentence
    for (const extreme_row& row : rows) {
        if (row.made.said != aabb::verdict::refused) continue;
        auto found = std::ranges::find_if(scenes_of, [&](const auto& one) { return one.first == row.made.reason; });
        if (found == scenes_of.end()) found = scenes_of.insert(scenes_of.end(), {row.made.reason, {}});
        if (std::ranges::find(found->second, row.scene) == found->second.end()) found->second.push_back(row.scene);
    }
    std::vector<std::string> all;
    for (const auto& [sentence, scenes] : scenes_of) {
        std::string text;
        for (const std::string& scene : scenes) text += (text.empty() ? "" : ", ") + scene;
        all.push_back(text + ": " + sentence);
    }
    return all;
}

std::vector<std::string> failures_in(std::span<const extreme_row> rows) {
    std::vector<std::string> all;
    for (const extreme_row& row : rows)
        if (!row.as_expected)
            all.push_back(row.contender + " on " + row.scene + ": " +
                          (row.made.said == aabb::verdict::refused ? "refuses: " : "") + row.made.reason);
    return all;
}

}  // namespace aabblab
