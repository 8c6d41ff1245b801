export module aabb.policy:strategy;

import aabb.std;

export namespace aabb {

/// The configuration of a strategy that has no parameters.
struct no_config {};

namespace detail {
template <class S>
typename S::config config_in(int);
template <class S>
no_config config_in(...);
}  // namespace detail

/// The documented `config` struct of a strategy; `no_config` where it has none.
template <class S>
using config_of = decltype(detail::config_in<S>(0));

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

template <Strategy S>
[[nodiscard]] S make_strategy(const config_of<S>& config) {
    if constexpr (std::same_as<config_of<S>, no_config>)
        return S{};
    else
        return S{config};
}

/// Whether results with the strategy are exact. One that approximates says `static constexpr bool exact = false`.
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

/// A list of types, for registries.
template <class... Types>
struct type_list {};

}  // namespace aabb

namespace aabb::detail {

template <class Policy, class... Others>
constexpr std::string_view refusal_by() {
    if constexpr (requires { Policy::template refuses<Others...>(); })
        return Policy::template refuses<Others...>();
    else
        return {};
}

}  // namespace aabb::detail

export namespace aabb {

/// Why a combination of policies makes no sense, in the words of the policy that refuses it; empty where it makes
/// sense. A policy refuses with a member `template <class... All> static constexpr std::string_view refuses()`.
template <class... Policies>
[[nodiscard]] constexpr std::string_view refusal() {
    std::string_view reason;
    ((reason = reason.empty() ? detail::refusal_by<Policies, Policies...>() : reason), ...);
    return reason;
}

/// A sentence as a template argument, so that the compiler prints it where a `static_assert` of `is_accepted` fails.
template <std::size_t N>
struct sentence {
    char text[N + 1]{};
};

/// The refusal of a combination as such an argument.
template <class... Policies>
[[nodiscard]] constexpr auto sentence_of() {
    sentence<refusal<Policies...>().size()> copy;
    std::ranges::copy(refusal<Policies...>(), copy.text);
    return copy;
}

/// Whether the sentence refuses nothing: `static_assert(aabb::is_accepted<sentence_of<Sort, Sweep>()>)`. Clang prints
/// the sentence only where the name is qualified.
template <sentence Reason>
inline constexpr bool is_accepted = Reason.text[0] == '\0';

}  // namespace aabb
