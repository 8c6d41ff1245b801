#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

import aabb;
import aabb.registry;

/// The values that tests give a parameter: every name of several, every one of a few whole numbers; else the default
/// and 3.
inline std::vector<std::string> values_of(const aabb::parameter_info& parameter) {
    std::vector<std::string> values;
    if (parameter.expected.starts_with("one of ")) {
        const std::string names = parameter.expected.substr(7);
        for (std::size_t from = 0, to = 0; to != std::string::npos; from = to + 2) {
            to = names.find(", ", from);
            values.push_back(names.substr(from, to == std::string::npos ? to : to - from));
        }
    } else if (parameter.expected == "a whole number from 1 to 3") {
        values = {"1", "2", "3"};
    } else {
        values = {parameter.fallback, "3"};
    }
    return values;
}

/// Every strategy of a kind with every combination of these values.
inline std::vector<aabb::strategy_choice> all_choices(aabb::strategy_kind kind) {
    std::vector<aabb::strategy_choice> all;
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
        all.insert(all.end(), choices.begin(), choices.end());
    }
    return all;
}

/// Every combination of sort, partition and sweep that makes sense, without and with splitting of large objects.
inline std::vector<aabb::global_composition> all_global_compositions() {
    std::vector<aabb::global_composition> all;
    for (const auto& sort : all_choices(aabb::strategy_kind::sort))
        for (const auto& partition : all_choices(aabb::strategy_kind::partition))
            for (const auto& sweep : all_choices(aabb::strategy_kind::sweep))
                for (const std::optional<double> split_large : {std::optional<double>(), std::optional(1.5)})
                    if (const aabb::global_composition c{sort, partition, sweep, split_large}; refusal_of(c).empty())
                        all.push_back(c);
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
