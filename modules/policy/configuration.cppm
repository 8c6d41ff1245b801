export module aabb.policy:configuration;

import aabb.base;
import aabb.std;
import :nearest_name;
import :parameter_values;
import :strategy;
import :strategy_choice;

export namespace aabb {

/// A parameter as `aabblab list` shows it.
struct parameter_info {
    std::string name;
    parameter_values values;
    std::string fallback;  ///< the default; empty where there is none and the parameter must be set
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
                (infos.push_back({std::string(p.name), p.values(), p.show(defaults), std::string(p.help)}), ...);
            },
            S::parameters);
    }
    return infos;
}

/// The configuration that the settings describe.
/// @throws input_error on an unknown parameter, a value that is not one, or a parameter without a default that is not
/// set.
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
                    throw input_error(std::string(S::name) + ": " + s.name + " must be " + to_text(parameter.values()) +
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
    if constexpr (!std::same_as<config_of<S>, no_config>) {
        const auto require = [&](const auto& parameter) {
            if (parameter.show(config).empty())
                throw input_error(std::string(S::name) + ": " + std::string(parameter.name) + " must be given, " +
                                  to_text(parameter.values()));
        };
        std::apply([&](const auto&... parameter) { (require(parameter), ...); }, S::parameters);
    }
    return config;
}

}  // namespace aabb
