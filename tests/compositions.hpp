#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

import aabb;
import aabb.registry;

/// Every strategy of a kind: as it is by default, and once for each other value of a parameter that is one of several
/// names, or with 3 where it is a number.
inline std::vector<aabb::strategy_choice> all_choices(aabb::strategy_kind kind) {
    std::vector<aabb::strategy_choice> all;
    for (const aabb::strategy_info& info : aabb::strategies(kind)) {
        all.push_back({info.name, {}});
        for (const aabb::parameter_info& parameter : info.parameters) {
            std::string values = "3";
            if (parameter.expected.starts_with("one of ")) values = parameter.expected.substr(7);
            for (std::size_t from = 0, to = 0; to != std::string::npos; from = to + 2) {
                to = values.find(", ", from);
                const std::string value = values.substr(from, to == std::string::npos ? to : to - from);
                if (value != parameter.fallback) all.push_back({info.name, {{parameter.name, value}}});
            }
        }
    }
    return all;
}

/// Every combination of sort, partition and sweep that makes sense.
inline std::vector<aabb::global_composition> all_global_compositions() {
    std::vector<aabb::global_composition> all;
    for (const auto& sort : all_choices(aabb::strategy_kind::sort))
        for (const auto& partition : all_choices(aabb::strategy_kind::partition))
            for (const auto& sweep : all_choices(aabb::strategy_kind::sweep))
                if (const aabb::global_composition c{sort, partition, sweep}; refusal_of(c).empty()) all.push_back(c);
    return all;
}

/// Every combination of tree and triangle test that makes sense.
inline std::vector<aabb::local_composition> all_local_compositions() {
    std::vector<aabb::local_composition> all;
    for (const auto& tree : all_choices(aabb::strategy_kind::tree))
        for (const auto& triangle : all_choices(aabb::strategy_kind::triangle))
            if (const aabb::local_composition c{tree, triangle}; refusal_of(c).empty()) all.push_back(c);
    return all;
}
