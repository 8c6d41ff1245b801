export module aabb.policy:configuration;

import aabb.std;
import :nearest_name;
import :parameters;
import :strategy;
import :strategy_choice;

export namespace aabb {

/// A parameter as shown by `aabblab list`.
struct parameter_info {
    std::string name;
    parameter_values values;
    std::string fallback;  ///< the default; empty if the parameter must be set
    std::string help;
};

/// Calls `take` with each parameter of a strategy or a scene, in the order of their declaration.
template <Configurable S, class Take>
constexpr void for_each_parameter(const Take& take) {
    if constexpr (!std::same_as<config_of<S>, no_config>)
        std::apply([&](const auto&... parameter) { (take(parameter), ...); }, S::parameters);
}

/// The parameters of a strategy or a scene: name, valid values, default and help, in the order of their declaration.
template <Configurable S>
[[nodiscard]] std::vector<parameter_info> parameters_of() {
    std::vector<parameter_info> infos;
    const auto add = [&](const auto& p) {
        infos.push_back({std::string(p.name), p.values(), p.show(config_of<S>{}), std::string(p.help)});
    };
    for_each_parameter<S>(add);
    return infos;
}

/// The configuration of a strategy or a scene: the defaults of its parameters, changed by the settings of the user.
/// @throws input_error on an unknown parameter, an invalid value, or a missing parameter without a default
template <Configurable S>
[[nodiscard]] config_of<S> configured(std::span<const setting> settings) {
    config_of<S> config{};
    for (const setting& s : settings) {
        bool known = false;
        for_each_parameter<S>([&](const auto& parameter) {
            if (parameter.name != s.name) return;
            known = true;
            if (!parameter.set(config, s.value))
                throw input_error(std::string(S::name) + ": " + s.name + " must be " + to_text(parameter.values()) +
                                  ", not '" + s.value + "'");
        });
        if (known) continue;
        std::vector<std::string> names;
        for_each_parameter<S>([&](const auto& parameter) { names.emplace_back(parameter.name); });
        if (names.empty())
            throw input_error(std::string(S::name) + " takes no parameters, but '" + s.name + "' is set");
        throw input_error(unknown_name("parameter of " + std::string(S::name), s.name, names));
    }
    // A parameter without a default is still empty if no setting gave it.
    for_each_parameter<S>([&](const auto& parameter) {
        if (parameter.show(config).empty())
            throw input_error(std::string(S::name) + ": " + std::string(parameter.name) + " must be given, " +
                              to_text(parameter.values()));
    });
    return config;
}

}  // namespace aabb
