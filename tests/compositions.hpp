#pragma once

#include <cstdlib>
#include <stdexcept>

#include "testing.hpp"

import aabb;
import aabb.registry;

/// The values that tests give a parameter: all names, or all of a few integers, and auto if it is allowed; of more than
/// three integers the ends and the default; else the default and 3. Not 256 threads, which take much memory and many
/// allocations for little work: columns.cpp and trees.cpp test them.
inline std::vector<std::string> values_of(const aabb::parameter_info& parameter) {
    if (parameter.name == "threads") return {parameter.fallback, "3"};
    if (const auto* names = std::get_if<aabb::name_values>(&parameter.values)) return names->names;
    if (const auto* number = std::get_if<aabb::number_values>(&parameter.values))
        if (!number->or_equal && !number->or_auto) return {"1.5"};
    const auto* const whole = std::get_if<aabb::integer_values>(&parameter.values);
    if (whole && whole->most - whole->least < 3) {
        std::vector<std::string> values;
        for (std::uint64_t value = whole->least; value <= whole->most; ++value) values.push_back(std::to_string(value));
        if (whole->or_auto) values.emplace_back("auto");
        return values;
    }
    if (!whole || whole->or_auto) return {parameter.fallback, "3"};
    std::vector<std::string> values{std::to_string(whole->least), parameter.fallback, std::to_string(whole->most)};
    values.erase(std::ranges::unique(values).begin(), values.end());
    return values;
}

/// Every strategy of a kind with every combination of these values.
inline std::vector<aabb::strategy_choice> all_choices(aabb::strategy_kind kind) {
    std::vector<aabb::strategy_choice> result;
    for (const aabb::strategy_info& info : aabb::strategies(kind)) {
        std::vector<aabb::strategy_choice> choices{{info.name, {}}};
        for (const aabb::parameter_info& parameter : info.parameters) {
            std::vector<aabb::strategy_choice> multiplied;
            for (const aabb::strategy_choice& choice : choices)
                for (const std::string& value : values_of(parameter)) {
                    multiplied.push_back(choice);
                    if (value != parameter.fallback) multiplied.back().settings.push_back({parameter.name, value});
                }
            choices = std::move(multiplied);
        }
        result.insert(result.end(), choices.begin(), choices.end());
    }
    return result;
}

/// Every valid combination of a stage's strategies, exact or not.
inline std::vector<aabb::composition> all_compositions(aabb::stage stage) {
    std::vector<aabb::composition> result(1);
    for (const aabb::strategy_kind kind : kinds_of(stage)) {
        std::vector<aabb::composition> longer;
        for (const aabb::composition& c : result)
            for (const aabb::strategy_choice& choice : all_choices(kind)) longer.emplace_back(c)[kind] = choice;
        result = std::move(longer);
    }
    std::erase_if(result, [&](const aabb::composition& c) { return !rejection_of(c, stage).empty(); });
    return result;
}
/// Whether tests run every composition instead of a selection: AABBLAB_COMPOSITIONS=all.
inline bool wants_every_composition() {
    const char* const wanted = std::getenv("AABBLAB_COMPOSITIONS");
    if (wanted && std::string_view(wanted) != "all")
        throw std::invalid_argument("AABBLAB_COMPOSITIONS is '" + std::string(wanted) + "'; it must be all or unset");
    return wanted != nullptr;
}
// The address sanitizer looks for faults of memory, which hardly depend on combinations, and is slow.
#if __has_feature(address_sanitizer)
inline constexpr bool has_sanitizer = true;
#else
inline constexpr bool has_sanitizer = false;
#endif

/// Exact compositions for scenes of boxes. The selection covers every valid combination of strategies of three kinds,
/// with their settings: hardly any fault needs four (Kuhn, Wallace, Gallo 2004). With a sanitizer, of two kinds.
inline std::vector<aabb::composition> global_compositions() {
    using combination = std::pair<std::size_t, std::string>;  ///< which kinds, and their strategies
    constexpr aabb::stage stage = aabb::stage::global_search;
    const std::vector<aabb::strategy_kind> kinds = kinds_of(stage);
    const std::size_t covered = has_sanitizer ? 2 : 3;
    std::vector<aabb::composition> exact = all_compositions(stage);
    std::erase_if(exact, [](const aabb::composition& c) { return !is_exact(c, stage) || !needs_meshes(c).empty(); });
    if (wants_every_composition()) return exact;
    std::vector<std::pair<aabb::composition, std::vector<combination>>> candidates;
    for (const aabb::composition& c : exact) {
        std::vector<combination>& covers = candidates.emplace_back(c, std::vector<combination>()).second;
        for (std::size_t chosen = 0; chosen < std::size_t{1} << kinds.size(); ++chosen) {
            if (static_cast<std::size_t>(std::popcount(chosen)) != covered) continue;
            aabb::composition of_chosen = c;
            for (std::size_t k = 0; k < kinds.size(); ++k)
                if ((chosen >> k & 1U) == 0) of_chosen[kinds[k]] = {};
            covers.emplace_back(chosen, to_text(of_chosen, stage));
        }
    }
    std::vector<aabb::composition> selection;
    std::set<combination> seen;
    // First those with the most new combinations.
    for (auto least_new = static_cast<std::ptrdiff_t>(candidates.front().second.size()); least_new > 0; --least_new)
        for (const auto& [composition, covers] : candidates) {
            if (std::ranges::count_if(covers, [&](const combination& c) { return !seen.contains(c); }) < least_new)
                continue;
            seen.insert(covers.begin(), covers.end());
            selection.push_back(composition);
        }
    return selection;
}
/// The selection combines every tree with the exact triangle test, and each default tree with the other tests: a test
/// does not depend on the tree that calls it. With a sanitizer, one strategy at most is not the default.
inline std::vector<aabb::composition> local_compositions() {
    std::vector<aabb::composition> compositions = all_compositions(aabb::stage::local_detection);
    if (wants_every_composition()) return compositions;
    std::erase_if(compositions, [](const aabb::composition& c) {
        if (has_sanitizer) {
            const aabb::composition defaults;
            return std::ranges::count_if(kinds_of(aabb::stage::local_detection), [&](aabb::strategy_kind kind) {
                       return to_text(c[kind]) != to_text(defaults[kind]);
                   }) > 1;
        }
        return c[aabb::strategy_kind::triangle].name != "exact" && !c[aabb::strategy_kind::tree].settings.empty();
    });
    return compositions;
}
inline bool is_exact_locally(const aabb::composition& c) {
    return is_exact(c, aabb::stage::local_detection);
}
inline std::vector<aabb::composition> exact_local_compositions() {
    std::vector<aabb::composition> compositions = local_compositions();
    std::erase_if(compositions, [](const aabb::composition& c) { return !is_exact_locally(c); });
    return compositions;
}

/// The default narrow phase with each tree, for what does not depend on the triangle test.
inline std::vector<aabb::composition> compositions_of_every_tree() {
    std::vector<aabb::composition> compositions;
    for (const aabb::strategy_choice& tree : all_choices(aabb::strategy_kind::tree))
        compositions.emplace_back()[aabb::strategy_kind::tree] = tree;
    std::erase_if(compositions, [](const aabb::composition& c) { return !is_exact_locally(c); });
    return compositions;
}

/// These strategies, as on the command line, and those that complete them: `composed({{kind::sort, "shell"}})`.
inline aabb::composition composed(std::initializer_list<std::pair<aabb::strategy_kind, const char*>> choices) {
    aabb::named_strategies named;
    for (const auto& [kind, text] : choices) named[kind] = aabb::parse_strategy(text);
    return aabb::composition(named);
}

/// Whether pairs of leaves are kept from query to query.
inline bool keeps_fronts(const aabb::composition& c) {
    return std::ranges::count(c[aabb::strategy_kind::tree].settings, aabb::setting{"front", "kept"}) > 0;
}

inline std::string text_of_global(const aabb::composition& c) {
    return to_text(c, aabb::stage::global_search);
}
inline std::string text_of_local(const aabb::composition& c) {
    return to_text(c, aabb::stage::local_detection);
}
inline auto global_of(const aabb::composition& c, aabb::instrumentation counted = aabb::instrumentation::none) {
    return aabb::compose_global_search(c, counted);
}
inline auto local_of(const aabb::composition& c, aabb::instrumentation counted = aabb::instrumentation::none) {
    return aabb::compose_local_detection(c, counted);
}
