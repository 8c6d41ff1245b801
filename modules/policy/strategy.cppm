export module aabb.policy:strategy;

import aabb.std;

export namespace aabb {

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

/// A strategy made from its configuration.
template <Strategy S>
[[nodiscard]] S make_strategy(const config_of<S>& config) {
    if constexpr (std::same_as<config_of<S>, no_config>)
        return S{};
    else
        return S{config};
}

}  // namespace aabb
