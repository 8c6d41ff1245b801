module;
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

export module aabb:policy;

import :error;

// What every kind of strategy has in common: a name, a summary, and parameters that text can set.
export namespace aabb {

/// A list of types, for registries.
template <class... Types>
struct type_list {};

/// One setting as the user wrote it: `gaps=ciura` on the command line, `gaps = "ciura"` in TOML.
struct setting {
    std::string name;
    std::string value;

    friend bool operator==(const setting&, const setting&) = default;
};

/// A strategy by name, with the settings that differ from its defaults.
struct strategy_choice {
    std::string name;
    std::vector<setting> settings;

    friend bool operator==(const strategy_choice&, const strategy_choice&) = default;
};

/// The choice as the command line takes it: `shell:gaps=ciura,other=2`.
[[nodiscard]] inline std::string to_text(const strategy_choice& choice) {
    std::string text = choice.name;
    for (const setting& s : choice.settings)
        text += (&s == choice.settings.data() ? ":" : ",") + s.name + "=" + s.value;
    return text;
}

/// The inverse of `to_text`.
/// @throws input_error on a setting without "=".
[[nodiscard]] inline strategy_choice parse_strategy(std::string_view text) {
    const std::size_t colon = text.find(':');
    strategy_choice choice{std::string(text.substr(0, colon)), {}};
    if (colon == std::string_view::npos) return choice;
    text.remove_prefix(colon + 1);
    while (true) {
        const std::string_view one = text.substr(0, text.find(','));
        const std::size_t equals = one.find('=');
        if (equals == std::string_view::npos || equals == 0)
            throw input_error("'" + std::string(one) + "' after '" + choice.name + ":' is not of the form name=value");
        choice.settings.push_back({std::string(one.substr(0, equals)), std::string(one.substr(equals + 1))});
        if (one.size() == text.size()) return choice;
        text.remove_prefix(one.size() + 1);
    }
}

/// Edit distance (insert, delete, replace, swap of neighbours count 1 each).
[[nodiscard]] inline std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (a[i - 1] != b[j - 1])});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        std::swap(before, above);
        std::swap(above, row);
    }
    return above[b.size()];
}

/// The known name closest to an unknown one; the first of equals. A name that holds the unknown one whole ("grid" in
/// "uniform_grid") is as near as a single slip. `known` must not be empty.
[[nodiscard]] inline std::string nearest_name(std::string_view unknown, std::span<const std::string> known) {
    return *std::ranges::min_element(known, {}, [&](const std::string& name) {
        const bool holds = unknown.size() > 2 && name.find(unknown) != std::string::npos;
        return holds ? std::size_t{1} : edit_distance(unknown, name);
    });
}

/// The sentence for a name nobody knows: what it was meant to be, and which name is nearest.
[[nodiscard]] inline std::string unknown_name(std::string_view what, std::string_view name,
                                              std::span<const std::string> known) {
    std::string text = "unknown " + std::string(what) + " '" + std::string(name) + "'";
    if (!known.empty()) text += "; did you mean '" + nearest_name(name, known) + "'?";
    return text;
}

/// A real number in (above, at_most], as text; with `or_auto`, "auto" too, which leaves the optional empty.
template <class Config, class Value>
struct number_parameter {
    std::string_view name;
    Value Config::* field;
    double above;
    double at_most;
    std::string_view help;

    static constexpr bool or_auto = std::same_as<Value, std::optional<double>>;

    [[nodiscard]] std::string expected() const {
        std::string text = "a number above " + shortest(above);
        if (at_most < std::numeric_limits<double>::max()) text += " and at most " + shortest(at_most);
        return text + (or_auto ? " or auto" : "");
    }

    [[nodiscard]] std::string show(const Config& config) const {
        if constexpr (or_auto)
            return config.*field ? shortest(*(config.*field)) : "auto";
        else
            return shortest(static_cast<double>(config.*field));
    }

    [[nodiscard]] bool set(Config& config, std::string_view text) const {
        if constexpr (or_auto)
            if (text == "auto") {
                config.*field = std::nullopt;
                return true;
            }
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc{} || end != text.data() + text.size() || !(value > above && value <= at_most))
            return false;
        config.*field = value;
        return true;
    }

private:
    [[nodiscard]] static std::string shortest(double value) {
        std::array<char, 32> text{};
        return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
    }
};

/// A whole number in [least, most], as text; with `or_auto`, "auto" too, which leaves the optional empty.
template <class Config, class Value, std::integral Whole>
struct integer_parameter {
    std::string_view name;
    Value Config::* field;
    Whole least;
    Whole most;
    std::string_view help;

    static constexpr bool or_auto = std::same_as<Value, std::optional<Whole>>;
    static_assert(or_auto || std::same_as<Value, Whole>);

    [[nodiscard]] std::string expected() const {
        return "a whole number from " + std::to_string(least) + " to " + std::to_string(most) +
               (or_auto ? " or auto" : "");
    }

    [[nodiscard]] std::string show(const Config& config) const {
        if constexpr (or_auto)
            return config.*field ? std::to_string(*(config.*field)) : "auto";
        else
            return std::to_string(config.*field);
    }

    [[nodiscard]] bool set(Config& config, std::string_view text) const {
        if constexpr (or_auto)
            if (text == "auto") {
                config.*field = std::nullopt;
                return true;
            }
        Whole value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc{} || end != text.data() + text.size() || value < least || value > most) return false;
        config.*field = value;
        return true;
    }
};

/// One of several names; the field is an enumeration numbered from 0 in the order of the names.
template <class Config, class Enum, std::size_t N>
struct choice_parameter {
    std::string_view name;
    Enum Config::* field;
    std::array<std::string_view, N> names;
    std::string_view help;

    [[nodiscard]] std::string expected() const {
        std::string text = "one of ";
        for (std::size_t i = 0; i < N; ++i) text += (i ? ", " : "") + std::string(names[i]);
        return text;
    }

    [[nodiscard]] std::string show(const Config& config) const {
        return std::string(names[static_cast<std::size_t>(config.*field)]);
    }

    [[nodiscard]] bool set(Config& config, std::string_view text) const {
        const auto found = std::ranges::find(names, text);
        if (found == names.end()) return false;
        config.*field = static_cast<Enum>(found - names.begin());
        return true;
    }
};

/// The configuration of a strategy that has no parameters.
struct no_config {};

namespace detail {
template <class S>
struct config_of {
    using type = no_config;
};
template <class S>
    requires requires { typename S::config; }
struct config_of<S> {
    using type = typename S::config;
};
}  // namespace detail

/// The documented `config` struct of a strategy; `no_config` where it has none.
template <class S>
using config_of = typename detail::config_of<S>::type;

/// A thing with a name and one sentence about itself, that text can configure. Where it has parameters it holds an
/// aggregate `config` and a tuple `parameters` that binds names to the fields.
template <class S>
concept Configurable = requires {
    { S::name } -> std::convertible_to<std::string_view>;
    { S::summary } -> std::convertible_to<std::string_view>;
} && (std::same_as<config_of<S>, no_config> || requires { S::parameters; });

/// What every strategy is: configurable and, where it has parameters, made from its configuration.
template <class S>
concept Strategy =
    Configurable<S> && (std::same_as<config_of<S>, no_config> || requires(config_of<S> config) { S{config}; });

/// Whether results made with the strategy are exact. One that only approximates says `static constexpr bool exact =
/// false`.
template <Strategy S>
inline constexpr bool strategy_is_exact = [] {
    if constexpr (requires { S::exact; })
        return S::exact;
    else
        return true;
}();

/// The same, as configured: where exactness depends on a parameter the `config` has a member `is_exact()`.
template <Strategy S>
[[nodiscard]] constexpr bool is_exact_as(const config_of<S>& config) {
    if constexpr (requires { config.is_exact(); })
        return config.is_exact();
    else
        return strategy_is_exact<S>;
}

/// A strategy made from its configuration.
template <Strategy S>
[[nodiscard]] S make_strategy(const config_of<S>& config) {
    if constexpr (std::same_as<config_of<S>, no_config>)
        return S{};
    else
        return S{config};
}

/// A parameter as `aabblab list` shows it.
struct parameter_info {
    std::string name;
    std::string expected;
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
                (infos.push_back({std::string(p.name), p.expected(), p.show(defaults), std::string(p.help)}), ...);
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
    if constexpr (!std::same_as<config_of<S>, no_config>) {
        const auto require = [&](const auto& parameter) {
            if (parameter.show(config).empty())
                throw input_error(std::string(S::name) + ": " + std::string(parameter.name) + " must be given, " +
                                  parameter.expected());
        };
        std::apply([&](const auto&... parameter) { (require(parameter), ...); }, S::parameters);
    }
    return config;
}

/// Heap bytes a strategy holds; 0 for one that holds none and so need not say.
template <class S>
[[nodiscard]] constexpr std::size_t bytes_of(const S& strategy) {
    if constexpr (requires { strategy.bytes(); })
        return strategy.bytes();
    else
        return 0;
}

/// Heap bytes behind a vector.
template <class T>
[[nodiscard]] constexpr std::size_t bytes_of(const std::vector<T>& v) {
    return v.capacity() * sizeof(T);
}

/// Empties a vector and gives its memory back.
template <class T>
constexpr void release(std::vector<T>& v) {
    std::vector<T>().swap(v);
}

namespace detail {
template <class Policy, class... Others>
constexpr std::string_view refusal_by() {
    if constexpr (requires { Policy::template refuses<Others...>(); })
        return Policy::template refuses<Others...>();
    else
        return {};
}
}  // namespace detail

/// Why a combination of policies makes no sense, in the words of the policy that refuses it; empty where it makes
/// sense. A policy refuses with a member `template <class... All> static constexpr std::string_view refuses()`.
template <class... Policies>
[[nodiscard]] constexpr std::string_view refusal() {
    std::string_view reason;
    ((reason = reason.empty() ? detail::refusal_by<Policies, Policies...>() : reason), ...);
    return reason;
}

namespace detail {
/// A sentence as a template argument, so that the compiler prints it.
template <std::size_t N>
struct sentence {
    char text[N + 1]{};
};
template <class... Policies>
constexpr auto sentence_of() {
    sentence<refusal<Policies...>().size()> copy;
    std::ranges::copy(refusal<Policies...>(), copy.text);
    return copy;
}
template <sentence Reason>
inline constexpr bool is_accepted = Reason.text[0] == '\0';
}  // namespace detail

}  // namespace aabb
