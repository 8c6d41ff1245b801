module;
#include <concepts>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

export module aabb.policy:configuration;

import aabb.base;
import :nearest_name;
import :strategy;
import :strategy_choice;

export namespace aabb {

/// A parameter as `aabblab list` shows it.
struct parameter_info {
    std::string name;
    std::string expected;
    std::string fallback;  ///< the default
    std::string help;
};

/// The parameters of a strategy or a scene, in the order in which it declares them.
template <Configurable S>
[[nodiscard]] std::vector<parameter_info> parameters_of() {
    std::vector<parameter_info> infos;
    if constexpr (!std::same_as<config_of<S>, no_config>) {
        const config_of<S> defaults{};
        std::apply(
            [&](const auto&... p) {
                (infos.push_back({std::string(p.name), p.expected(), p.show(defaults), std::string(p.help)}), ...);
            },
            S::parameters);
    }
    return infos;
}

/// The configuration that the settings describe.
/// @throws input_error on an unknown parameter or a value that is not one.
template <Configurable S>
[[nodiscard]] config_of<S> configured(std::span<const setting> settings) {
    config_of<S> config{};
    for (const setting& s : settings) {
        bool known = false;
        if constexpr (!std::same_as<config_of<S>, no_config>) {
            const auto take = [&](const auto& parameter) {
                if (parameter.name != s.name) return;
                known = true;
                if (!parameter.set(config, s.value))
                    throw input_error(std::string(S::name) + ": " + s.name + " must be " + parameter.expected() +
                                      ", not '" + s.value + "'");
            };
            std::apply([&](const auto&... parameter) { (take(parameter), ...); }, S::parameters);
        }
        if (known) continue;
        std::vector<std::string> names;
        for (const parameter_info& p : parameters_of<S>()) names.push_back(p.name);
        if (names.empty())
            throw input_error(std::string(S::name) + " takes no parameters, so not '" + s.name + "' either");
        throw input_error(unknown_name("parameter of " + std::string(S::name), s.name, names));
    }
    return config;
}

}  // namespace aabb
