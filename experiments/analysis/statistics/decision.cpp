module;
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <span>
#include <utility>
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

evidence evidence_of(const estimate& log_ratio, expectation expected) {
    const double high = std::log1p(equivalence_band);
    const double low = -high;
    const evidence more{outcome::more, log_ratio.chance_below(high)};
    const evidence same{outcome::same, expected == expectation::not_more
                                           ? log_ratio.chance_above(high)
                                           : std::max(log_ratio.chance_above(high), log_ratio.chance_below(low))};
    const evidence less{outcome::less, log_ratio.chance_above(low)};
    const std::array<evidence, 3> all{less, same, more};
    return *std::ranges::min_element(all, {}, &evidence::p);
}

outcome decide(const evidence& e) {
    return e.p <= one_sided ? e.nearest : outcome::undecided;
}

std::vector<outcome> decide_together(std::span<const evidence> all) {
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(all[i].p, i); });
    std::vector<outcome> outcomes(all.size(), outcome::undecided);
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
        case outcome::undecided: break;
    }
    return support::undecided;
}

verdict_kind verdict_of(support primary, std::span<const support> secondary) {
    if (primary == support::undecided) return verdict_kind::undecided;
    if (primary == support::favours) {
        const bool everywhere = std::ranges::all_of(secondary, [](support s) { return s == support::favours; });
        return everywhere ? verdict_kind::holds : verdict_kind::holds_when;
    }
    if (any_is(secondary, support::favours)) return verdict_kind::holds_when;
    return primary == support::contradicts ? verdict_kind::does_not_hold : verdict_kind::no_difference;
}

}  // namespace aabblab
