export module aabb.policy:strategy;

import aabb.std;

export namespace aabb {

/// The configuration of a strategy without parameters.
struct no_config {};

namespace detail {
template <class S>
typename S::config config_in(int);
template <class S>
no_config config_in(...);
}  // namespace detail

/// The `config` struct of a strategy; `no_config` if it has none.
template <class S>
using config_of = decltype(detail::config_in<S>(0));

/// A type with a name and a summary that can be configured by text. If it has parameters, it contains an aggregate
/// `config` and a tuple `parameters` that binds names to its fields.
template <class S>
concept Configurable = requires {
    { S::name } -> std::convertible_to<std::string_view>;
    { S::summary } -> std::convertible_to<std::string_view>;
} && (std::same_as<config_of<S>, no_config> || requires { S::parameters; });

/// A strategy is configurable and, if it has parameters, constructible from its configuration.
template <class S>
concept Strategy =
    Configurable<S> && (std::same_as<config_of<S>, no_config> || requires(config_of<S> config) { S{config}; });

template <Strategy S>
[[nodiscard]] S make_strategy(const config_of<S>& config) {
    if constexpr (std::same_as<config_of<S>, no_config>)
        return S{};
    else
        return S{config};
}

/// Whether a strategy yields exact results. One that approximates declares `static constexpr bool exact = false`.
template <Strategy S>
inline constexpr bool strategy_is_exact = [] {
    if constexpr (requires { S::exact; })
        return S::exact;
    else
        return true;
}();

/// The same with a configuration: if exactness depends on a parameter, `config` has a member `is_exact()`.
template <Strategy S>
[[nodiscard]] constexpr bool is_exact_as(const config_of<S>& config) {
    if constexpr (requires { config.is_exact(); })
        return config.is_exact();
    else
        return strategy_is_exact<S>;
}

/// A list of types, for registries.
template <class... Types>
struct type_list {};

}  // namespace aabb

namespace aabb::detail {

template <class Policy, class... Others>
constexpr std::string_view rejection_by() {
    if constexpr (requires { Policy::template rejects<Others...>(); })
        return Policy::template rejects<Others...>();
    else
        return {};
}

}  // namespace aabb::detail

export namespace aabb {

/// Why a combination of policies is rejected, in the words of the rejecting policy; empty if it is accepted. A policy
/// rejects by a member `template <class... All> static constexpr std::string_view rejects()`.
template <class... Policies>
[[nodiscard]] constexpr std::string_view rejection() {
    std::string_view reason;
    ((reason = reason.empty() ? detail::rejection_by<Policies, Policies...>() : reason), ...);
    return reason;
}

/// A sentence as a template argument, so that the compiler prints it if a `static_assert` of `is_accepted` fails.
template <std::size_t N>
struct sentence {
    char text[N + 1]{};
};

/// The reason of a rejection as such an argument.
template <class... Policies>
[[nodiscard]] constexpr auto sentence_of() {
    sentence<rejection<Policies...>().size()> copy;
    std::ranges::copy(rejection<Policies...>(), copy.text);
    return copy;
}

/// Whether a combination is accepted: `static_assert(aabb::is_accepted<sentence_of<Sort, Sweep>()>)`. Clang prints the
/// sentence only if the name is qualified.
template <sentence Reason>
inline constexpr bool is_accepted = Reason.text[0] == '\0';

}  // namespace aabb
