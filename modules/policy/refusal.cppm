export module aabb.policy:refusal;

import aabb.std;

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
