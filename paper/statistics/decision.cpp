module;
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

module aabblab.statistics;

namespace aabblab {

namespace {

/// In each tail, as a 95 % interval has it.
constexpr double one_sided = 0.025;

bool any_is(std::span<const support> all, support what) {
    return std::ranges::find(all, what) != all.end();
}

}  // namespace

evidence evidence_of(const estimate& log_ratio) {
    const double high = std::log1p(equivalence_band);
    const double low = -high;
    const std::vector<double>& draws = log_ratio.draws;
    const auto chance = [&](std::size_t count) {
        return static_cast<double>(count + 1) / static_cast<double>(draws.size() + 1);
    };
    const auto below = [&](double limit) {
        return static_cast<std::size_t>(std::ranges::upper_bound(draws, limit) - draws.begin());
    };
    const auto above = [&](double limit) {
        return static_cast<std::size_t>(draws.end() - std::ranges::lower_bound(draws, limit));
    };
    const std::array<evidence, 3> all{{{outcome::less, chance(above(low))},
                                       {outcome::same, std::max(chance(above(high)), chance(below(low)))},
                                       {outcome::more, chance(below(high))}}};
    return *std::ranges::min_element(all, {}, &evidence::p);
}

outcome decide(const evidence& e) {
    return e.p <= one_sided ? e.nearest : outcome::open;
}

std::vector<outcome> decide_together(std::span<const evidence> all) {
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return all[i].p; });
    std::vector<outcome> outcomes(all.size(), outcome::open);
    for (std::size_t done = 0; done < order.size(); ++done) {
        const evidence& next = all[order[done]];
        if (next.p > one_sided / static_cast<double>(order.size() - done)) break;
        outcomes[order[done]] = next.nearest;
    }
    return outcomes;
}

support support_of(expectation expected, outcome found) {
    switch (found) {
        case outcome::less: return support::favours;
        case outcome::same: return expected == expectation::not_more ? support::favours : support::no_difference;
        case outcome::more: return support::contradicts;
        case outcome::open: break;
    }
    return support::open;
}

verdict_kind verdict_of(support primary, std::span<const support> secondary) {
    if (primary == support::open) return verdict_kind::undecided;
    if (primary == support::favours) {
        const bool otherwise = any_is(secondary, support::contradicts) || any_is(secondary, support::no_difference);
        return otherwise ? verdict_kind::holds_when : verdict_kind::holds;
    }
    if (any_is(secondary, support::favours)) return verdict_kind::holds_when;
    return primary == support::contradicts ? verdict_kind::does_not_hold : verdict_kind::no_difference;
}

}  // namespace aabblab
