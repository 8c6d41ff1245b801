module aabblab.statistics;

namespace aabblab {

namespace {

/// The p-values of the two statements about the margin of a claim: that it is favoured, and that it is not.
struct margin_test {
    double favoured, refuted;
};
margin_test test_margin(expectation expected, const tails& p) {
    return expected == expectation::less ? margin_test{p.less, p.not_less} : margin_test{p.not_more, p.more};
}

/// The lesser of both stands for the claim in Holm's rule.
double least_p_value(const tested& t) {
    const auto [favoured, refuted] = test_margin(t.expected, t.p);
    return std::min(favoured, refuted);
}

/// The levels of tests by Holm's step-down rule (1979) for many tests: the k-th least of n p-values is compared with
/// 1/(n - k + 1) of the level. From the first that exceeds it on, levels are 0.
/// @param p_of returns the p-value of a test
template <class Tested, class P>
std::vector<double> holm_levels(std::span<const Tested> family, P p_of) {
    std::vector<std::size_t> order(family.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(std::invoke(p_of, family[i]), i); });
    std::vector<double> levels(family.size(), 0);
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        const double level = one_sided / static_cast<double>(order.size() - rank);
        if (std::invoke(p_of, family[order[rank]]) > level) break;
        levels[order[rank]] = level;
    }
    return levels;
}

}  // namespace

/// Tests whether a ratio is below, within or above the equivalence band around 1, and returns the outcome with the
/// least p-value: the probability of the estimate if another outcome were true. The ratio is within the band if two
/// one-sided tests show that it is neither above nor below; the greater p-value counts.
evidence evidence_of(const estimate& log_ratio) {
    const double high = std::log1p(equivalence_band);
    const double low = -high;
    const evidence more{outcome::more, log_ratio.p_if_below(high)};
    const evidence same{outcome::same, std::max(log_ratio.p_if_above(high), log_ratio.p_if_below(low))};
    const evidence less{outcome::less, log_ratio.p_if_above(low)};
    const std::array<evidence, 3> outcomes{less, same, more};
    return *std::ranges::min_element(outcomes, {}, &evidence::p);
}

outcome decide(const evidence& e) {
    return e.p <= one_sided ? e.nearest : outcome::undecided;
}

std::vector<outcome> decide_together(std::span<const evidence> family) {
    const std::vector<double> levels = holm_levels(family, &evidence::p);
    std::vector<outcome> outcomes;
    for (std::size_t i = 0; i < family.size(); ++i)
        outcomes.push_back(levels[i] > 0 ? family[i].nearest : outcome::undecided);
    return outcomes;
}

tails tails_of(const estimate& log_ratio, double band) {
    const double high = std::log1p(band);
    return {log_ratio.p_if_above(-high), log_ratio.p_if_below(-high), log_ratio.p_if_above(high),
            log_ratio.p_if_below(high)};
}

outcome direction_of(const tails& p, double level) {
    if (p.less <= level) return outcome::less;
    if (p.more <= level) return outcome::more;
    return p.same() <= level ? outcome::same : outcome::undecided;
}

/// Whether measurements support a claim about a ratio. That a refuted claim of less shows no difference needs a second
/// test, at the same level: it is only asked once the first is decided (a fixed sequence of tests).
/// @param expected the claim: it is less than 1, or not more
/// @param p the p-values of statements about the ratio
/// @param level at which a statement is significant
support support_of(expectation expected, const tails& p, double level) {
    const auto [favoured, refuted] = test_margin(expected, p);
    if (favoured <= level) return support::favours;
    if (refuted > level) return support::undecided;
    return expected == expectation::less && p.not_more <= level ? support::no_difference : support::contradicts;
}

std::vector<double> levels_together(std::span<const tested> family) {
    return holm_levels(family, least_p_value);
}

/// Judges a claim by its primary endpoints; only an undecided verdict can change with more measurements.
verdict_kind verdict_of(std::span<const support> primary, verdict_rule rule) {
    const auto any_is = [&](support s) { return std::ranges::find(primary, s) != primary.end(); };
    const bool any_favours = any_is(support::favours);
    const bool any_otherwise = any_is(support::contradicts) || any_is(support::no_difference);  // not as claimed
    if (rule == verdict_rule::every && (any_is(support::contradicts) || (any_favours && any_otherwise)))
        return verdict_kind::does_not_hold;
    if (any_favours && any_otherwise) return verdict_kind::in_part;
    if (primary.empty() || any_is(support::undecided)) return verdict_kind::undecided;
    if (!any_otherwise) return verdict_kind::holds;
    // None favours the claim.
    return any_is(support::contradicts) ? verdict_kind::does_not_hold : verdict_kind::no_difference;
}

std::string text_of(support verdict) {
    constexpr std::array names{"for", "no difference", "against", "undecided"};
    return names[static_cast<std::size_t>(verdict)];
}

std::string text_of(verdict_kind verdict) {
    constexpr std::array names{"holds", "holds in part", "no difference", "does not hold", "undecided"};
    return names[static_cast<std::size_t>(verdict)];
}

}  // namespace aabblab
