module;
#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

module aabb.registry;

import aabb;
import aabb.composed;

namespace aabb {

// Defined in the generated catalog.cpp.
namespace registry {
std::vector<composed::global_row> all_global_rows();
std::vector<composed::local_row> all_local_rows();
std::vector<strategy_info> catalog(strategy_kind kind);
void check_settings(strategy_kind kind, const strategy_choice& choice);
bool is_exact(strategy_kind kind, const strategy_choice& choice);
std::unique_ptr<triangle_test> triangle_test_named(const strategy_choice& choice);
}  // namespace registry

std::string_view name_of(strategy_kind kind) {
    constexpr std::array<std::string_view, 5> names = {"sort", "partition", "sweep", "tree", "triangle"};
    return names[static_cast<std::size_t>(kind)];
}

std::span<const strategy_info> strategies(strategy_kind kind) {
    static const std::array<std::vector<strategy_info>, 5> all = {
        registry::catalog(strategy_kind::sort), registry::catalog(strategy_kind::partition),
        registry::catalog(strategy_kind::sweep), registry::catalog(strategy_kind::tree),
        registry::catalog(strategy_kind::triangle)};
    return all[static_cast<std::size_t>(kind)];
}

std::vector<std::string> strategy_names(strategy_kind kind) {
    std::vector<std::string> names;
    for (const strategy_info& info : strategies(kind)) names.push_back(info.name);
    return names;
}

void require_known(strategy_kind kind, const strategy_choice& choice) {
    const std::vector<std::string> names = strategy_names(kind);
    if (std::ranges::find(names, choice.name) == names.end())
        throw input_error(unknown_name(name_of(kind), choice.name, names));
    std::set<std::string_view> seen;
    for (const setting& s : choice.settings)
        if (!seen.insert(s.name).second) throw input_error(choice.name + ": " + s.name + " is given twice");
    registry::check_settings(kind, choice);
}

std::string split_large_text(const global_composition& c) {
    if (!c.split_large) return "off";
    std::array<char, 32> text{};
    return {text.data(), std::to_chars(text.data(), text.data() + text.size(), *c.split_large).ptr};
}

std::string to_text(const global_composition& c) {
    const std::string split = c.split_large ? " + split_large=" + split_large_text(c) : "";
    return to_text(c.sort) + " + " + to_text(c.partition) + " + " + to_text(c.sweep) + split;
}

std::string to_text(const local_composition& c) {
    return to_text(c.tree) + " + " + to_text(c.triangle);
}

namespace {

const composed::global_row& row_for(const global_composition& c) {
    require_known(strategy_kind::sort, c.sort);
    require_known(strategy_kind::partition, c.partition);
    require_known(strategy_kind::sweep, c.sweep);
    static const std::vector<composed::global_row> rows = registry::all_global_rows();
    return *std::ranges::find_if(rows, [&](const composed::global_row& row) {
        return row.sort == c.sort.name && row.partition == c.partition.name && row.sweep == c.sweep.name;
    });
}

const composed::local_row& row_for(const local_composition& c) {
    require_known(strategy_kind::tree, c.tree);
    require_known(strategy_kind::triangle, c.triangle);
    static const std::vector<composed::local_row> rows = registry::all_local_rows();
    return *std::ranges::find_if(rows, [&](const composed::local_row& row) {
        return row.tree == c.tree.name && row.triangle == c.triangle.name;
    });
}

bool is_exact(strategy_kind kind, const strategy_choice& choice) {
    require_known(kind, choice);
    return registry::is_exact(kind, choice);
}

}  // namespace

std::string_view refusal_of(const global_composition& c) {
    return row_for(c).refusal;
}

std::string_view refusal_of(const local_composition& c) {
    return row_for(c).refusal;
}

bool is_exact(const global_composition& c) {
    return is_exact(strategy_kind::sort, c.sort) && is_exact(strategy_kind::partition, c.partition) &&
           is_exact(strategy_kind::sweep, c.sweep);
}

bool is_exact(const local_composition& c) {
    return is_exact(strategy_kind::tree, c.tree) && is_exact(strategy_kind::triangle, c.triangle);
}

std::unique_ptr<global_stage> compose(const global_composition& c, instrumentation counted) {
    const composed::global_row& row = row_for(c);
    if (!row.make) throw input_error(to_text(c) + ": " + std::string(row.refusal));
    std::unique_ptr<global_stage> search = row.make(c.sort, c.partition, c.sweep, counted);
    if (!c.split_large) return search;
    return std::make_unique<split_large_stage>(std::move(search), *c.split_large, counted);
}

std::unique_ptr<local_stage> compose(const local_composition& c, instrumentation counted) {
    const composed::local_row& row = row_for(c);
    if (!row.make) throw input_error(to_text(c) + ": " + std::string(row.refusal));
    return row.make(c.tree, c.triangle, counted);
}

std::unique_ptr<triangle_test> make_triangle_test(const strategy_choice& choice) {
    require_known(strategy_kind::triangle, choice);
    return registry::triangle_test_named(choice);
}

}  // namespace aabb
