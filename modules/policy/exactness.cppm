export module aabb.policy:exactness;

import :strategy;

export namespace aabb {

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

}  // namespace aabb
