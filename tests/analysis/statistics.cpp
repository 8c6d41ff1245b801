#include <random>

#include "../testing.hpp"

import aabblab.statistics;

using aabblab::cells;
using aabblab::difference_of;
using aabblab::estimate;
using aabblab::evidence;
using aabblab::outcome;
using aabblab::support;
using aabblab::verdict_kind;

namespace {

constexpr std::size_t processes = 3;
constexpr std::size_t seeds = 5;

/// Measurements of a true ratio with random effects of processes, seeds and repeats.
cells measured(double log_ratio, double by_process, double by_seed, double by_repeat, std::mt19937& random) {
    std::normal_distribution<double> normal;
    cells data(processes, seeds);
    std::vector<double> of_seed(seeds);
    for (double& effect : of_seed) effect = by_seed * normal(random);
    for (std::size_t process = 0; process < processes; ++process) {
        const double of_process = by_process * normal(random);
        for (std::size_t seed = 0; seed < seeds; ++seed)
            for (int repeat = 0; repeat < 3; ++repeat)
                data.add(process, seed, log_ratio + of_process + of_seed[seed] + by_repeat * normal(random));
    }
    return data;
}

outcome outcome_at(double ratio, double noise) {
    std::mt19937 random(1);
    return decide(evidence_of(bootstrap(measured(std::log(ratio), 0, noise, noise, random))));
}

}  // namespace

TEST_CASE("Quartiles are interpolated") {
    const aabblab::quartiles q = aabblab::quartiles_of({4, 1, 2, 3});
    REQUIRE(q.low == 1.75);
    REQUIRE(q.median == 2.5);
    REQUIRE(q.high == 3.25);
    REQUIRE(aabblab::quartiles_of({7}).low == 7);
}

TEST_CASE("A bootstrap interval covers the true ratio at its nominal level under any random effects") {
    struct disturbance {
        double by_process, by_seed, by_repeat;
    };
    for (const disturbance d : {disturbance{0, 0, 0.1}, {0, 0.1, 0}, {0.1, 0, 0}, {0, 0.1, 0.1}, {0.05, 0.05, 0.1}}) {
        std::mt19937 random(7);
        int covered = 0;
        constexpr int experiments = 400;
        for (int i = 0; i < experiments; ++i) {
            const auto range = bootstrap(measured(0.3, d.by_process, d.by_seed, d.by_repeat, random)).range();
            covered += range.low <= 0.3 && 0.3 <= range.high;
        }
        CAPTURE(d.by_process, d.by_seed, d.by_repeat, covered);
        CHECK(covered >= 0.92 * experiments);
    }
}

TEST_CASE("Variance between processes and seeds widens an interval") {
    const auto width = [](double by_process, double by_seed) {
        std::mt19937 random(3);
        const auto range = bootstrap(measured(0, by_process, by_seed, 0.01, random)).range();
        return range.high - range.low;
    };
    CHECK(width(0, 0) < 0.02);
    CHECK(width(0, 0.1) > 5 * width(0, 0));
    CHECK(width(0.1, 0) > 5 * width(0, 0));
    // With three processes and five seeds, Student's t has fewer degrees of freedom for processes.
    CHECK(width(0.1, 0) > width(0, 0.1));
}

TEST_CASE("The same data give the same estimate") {
    std::mt19937 random(5);
    const cells data = measured(0.1, 0.01, 0.01, 0.1, random);
    REQUIRE(bootstrap(data).value == bootstrap(data).value);
    REQUIRE(bootstrap(data).error == bootstrap(data).error);
    REQUIRE(bootstrap(data).degrees == bootstrap(data).degrees);
}

TEST_CASE("One slow repeat does not change a ratio") {
    cells data(processes, seeds);
    for (std::size_t process = 0; process < processes; ++process)
        for (std::size_t seed = 0; seed < seeds; ++seed)
            for (int repeat = 0; repeat < 3; ++repeat) data.add(process, seed, repeat == 0 && seed == 0 ? 5 : 0.25);
    REQUIRE(bootstrap(data).value == 0.25);
}

TEST_CASE("Missing measurements are ignored") {
    cells data(processes, seeds);
    data.add(0, 0, 0.5);
    REQUIRE(bootstrap(data).value == 0.5);
    REQUIRE(bootstrap(data).is_known());
    REQUIRE_FALSE(bootstrap(cells(processes, seeds)).is_known());
    REQUIRE(cells(processes, seeds).empty());
    REQUIRE_FALSE(data.empty());
}

TEST_CASE("An interval is based on Student's t, with two degrees of freedom for three processes") {
    cells data(processes, 1);
    for (std::size_t process = 0; process < processes; ++process) data.add(process, 0, static_cast<double>(process));
    const estimate e = bootstrap(data);
    CHECK(e.value == 1);
    CHECK(std::abs(e.degrees - 2) < 1e-9);
    // The standard error of 0, 1, 2 is 1 / sqrt(3); 4.303 is the table's value at 97.5 %.
    CHECK(std::abs(e.error - 0.577) < 0.03);
    CHECK(std::abs(e.range().high - (1 + 4.303 * e.error)) < 1e-3);
    CHECK(std::abs(e.p_if_below(1) - 0.5) < 1e-12);
}

TEST_CASE("The difference of two estimates has the errors of both") {
    const estimate both = difference_of({2, 0.3, 10}, {0.5, 0.4, 10});
    CHECK(both.value == 1.5);
    CHECK(std::abs(both.error - 0.5) < 1e-12);
    CHECK_BETWEEN(10, both.degrees, 20);
    CHECK(difference_of({2, 0, 1}, {1, 0, 1}).range().low == 1);
}

TEST_CASE("The outcome depends on where the interval lies relative to the band") {
    CHECK(outcome_at(0.5, 0.05) == outcome::less);
    CHECK(outcome_at(2, 0.05) == outcome::more);
    CHECK(outcome_at(1, 0.005) == outcome::same);
    CHECK(outcome_at(1, 0.3) == outcome::undecided);
    // Less than 1, but not shown to be less than the band.
    CHECK(outcome_at(0.96, 0.05) == outcome::undecided);
    // Counts do not vary: the value alone decides.
    CHECK(outcome_at(0.94, 0) == outcome::less);
    CHECK(outcome_at(0.96, 0) == outcome::same);
    CHECK(outcome_at(1.06, 0) == outcome::more);
}

TEST_CASE("A ratio has a direction only if its whole interval lies below, within or above the band") {
    const auto direction = [](double ratio, double error) {
        return direction_of(aabblab::tails_of({std::log(ratio), error, 50}));
    };
    CHECK(direction(0.9, 0.02) == outcome::less);
    CHECK(direction(1.12, 0.02) == outcome::more);
    CHECK(direction(0.98, 0.005) == outcome::same);
    CHECK(direction(0.98, 0.1) == outcome::undecided);
    // Below 1, from 0.931 to 0.969, but perhaps within the band.
    CHECK(direction(0.95, 0.01) == outcome::undecided);
    // Within the band, but perhaps beyond it.
    CHECK(direction(0.97, 0.012) == outcome::undecided);
    CHECK(direction(1.03, 0.012) == outcome::undecided);
    // Without a band no outcome is the same.
    CHECK(direction_of(aabblab::tails_of({std::log(0.98), 0.005, 50}, 0)) == outcome::less);
    CHECK(direction_of(aabblab::tails_of({0, 0, 1}, 0)) == outcome::undecided);
    CHECK(direction_of(aabblab::tails_of({std::log(0.9), 0.01, 50}, 0.2)) == outcome::same);
    // Counts do not vary.
    CHECK(direction_of(aabblab::tails_of({0, 0, 1})) == outcome::same);
    CHECK(direction_of(aabblab::tails_of({0.5, 0, 1})) == outcome::more);
}

TEST_CASE("A claim is decided by the side of its margin on which the interval lies") {
    using aabblab::expectation;
    const auto support_for = [](expectation expected, double ratio, double error, double band = 0.05) {
        return support_of(expected, aabblab::tails_of({std::log(ratio), error, 50}, band));
    };
    CHECK(support_for(expectation::less, 0.8, 0.01) == support::favours);
    CHECK(support_for(expectation::less, 1, 0.01) == support::no_difference);
    CHECK(support_for(expectation::less, 1.2, 0.01) == support::contradicts);
    CHECK(support_for(expectation::less, 0.96, 0.03) == support::undecided);
    // 0.96, from 0.937 to 0.983: less than 1, by more than the margin or not.
    CHECK(support_for(expectation::less, 0.96, 0.012) == support::undecided);
    CHECK(support_for(expectation::less, 0.96, 0.001) == support::no_difference);
    CHECK(support_for(expectation::less, 0.945, 0.012) == support::undecided);
    CHECK(support_for(expectation::less, 0.92, 0.012) == support::favours);
    // 1.03, from 0.98 to 1.08: within the band or above it, but not less than the margin.
    CHECK(support_for(expectation::less, 1.03, 0.025) == support::contradicts);
    // An interval wider than the band is no evidence that there is no difference.
    CHECK(support_for(expectation::less, 1, 0.06) == support::undecided);
    CHECK(support_for(expectation::not_more, 1, 0.01) == support::favours);
    CHECK(support_for(expectation::not_more, 1.2, 0.01) == support::contradicts);
    // 0.96, from 0.90 to 1.02, is not above 1.05, whether or not it is less than 1.
    CHECK(support_for(expectation::not_more, 0.96, 0.03) == support::favours);
    CHECK(support_for(expectation::not_more, 1.02, 0.03) == support::undecided);
    CHECK(support_for(expectation::not_more, 1.08, 0.03) == support::undecided);
    // Without a band the margin is 1, for both.
    CHECK(support_for(expectation::less, 0.98, 0.005, 0) == support::favours);
    CHECK(support_for(expectation::less, 1.02, 0.005, 0) == support::contradicts);
    CHECK(support_for(expectation::not_more, 1.02, 0.005, 0) == support::contradicts);
}

TEST_CASE("Where the true ratio is at the margin, a claim is decided in one of twenty cases") {
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    constexpr int trials = 4000;
    constexpr double error = 0.03, degrees = 1e6;
    for (const auto expected : {aabblab::expectation::less, aabblab::expectation::not_more}) {
        const double margin = std::log(1.05) * (expected == aabblab::expectation::less ? -1 : 1);
        std::map<support, int> counts;
        for (int i = 0; i < trials; ++i)
            ++counts[support_of(expected, aabblab::tails_of({margin + error * normal(random), error, degrees}))];
        // Of each side 2.5 %, with a standard error of 0.25 %.
        CHECK_BETWEEN(0.015 * trials, counts[support::favours], 0.035 * trials);
        CHECK_BETWEEN(0.015 * trials, counts[support::contradicts] + counts[support::no_difference], 0.035 * trials);
    }
}

TEST_CASE("Several outcomes or claims are decided by the step-down procedure of Holm") {
    struct family {
        std::vector<double> chances;
        std::vector<bool> decided;
    };
    // Holm, 1979: the k-th smallest of m p-values is compared with 0.025 / (m - k + 1).
    for (const auto& [chances, decided] : {family{{0.02}, {true}},
                                           {{0.02, 0.02}, {false, false}},
                                           {{0.02, 0.01}, {true, true}},
                                           {{0.024, 0.001, 0.012}, {true, true, true}},
                                           {{0.024, 0.001, 0.013}, {false, true, false}},
                                           // A p-value of 0 stays decided next to an undecided one.
                                           {{0, 0.5}, {true, false}},
                                           {{}, {}}}) {
        CAPTURE(chances);
        std::vector<evidence> outcomes;
        std::vector<aabblab::tested> claims;
        for (const double p : chances) {
            outcomes.push_back({outcome::less, p});
            claims.push_back({aabblab::expectation::less, {p, 1 - p, 1, 1}});
        }
        std::vector<bool> is_less;
        for (const outcome o : decide_together(outcomes)) is_less.push_back(o == outcome::less);
        CHECK(is_less == decided);
        is_less.clear();
        for (std::size_t i = 0; const double level : levels_together(claims))
            is_less.push_back(direction_of(claims[i++].p, level) == outcome::less);
        CHECK(is_less == decided);
    }
}

TEST_CASE("Of many true margins together, any is decided in one of twenty families") {
    std::normal_distribution<double> normal;
    constexpr int trials = 2000;
    // The part of the variance that groups of four ratios share, as ratios to the same baseline do.
    for (const double shared : {0.0, 0.5}) {
        CAPTURE(shared);
        std::mt19937 random(5);
        int wrong = 0;
        for (int i = 0; i < trials; ++i) {
            std::vector<aabblab::tested> family;
            double of_group = 0;
            for (int k = 0; k < 20; ++k) {
                if (k % 4 == 0) of_group = normal(random);
                const double noise = std::sqrt(shared) * of_group + std::sqrt(1 - shared) * normal(random);
                family.push_back(
                    {aabblab::expectation::less, aabblab::tails_of({-std::log(1.05) + 0.03 * noise, 0.03, 1e6})});
            }
            const std::vector<double> levels = levels_together(family);
            bool any_decided = false;
            for (std::size_t k = 0; k < family.size(); ++k)
                any_decided |= support_of(family[k].expected, family[k].p, levels[k]) != support::undecided;
            wrong += any_decided ? 1 : 0;
        }
        // 5 % of the families, with a standard error of 0.5 %, fewer if they share; without a correction, 64 %.
        CHECK_BETWEEN(0.03 * trials, wrong, 0.065 * trials);
    }
}

TEST_CASE("Machines that disagree give a wide interval, and those that agree a narrow one") {
    const estimate single{0.5, 0.01, 20};
    const estimate alone[] = {single};
    CHECK(aabblab::mean_of(alone).range().low == single.range().low);
    const estimate agree[] = {single, {0.502, 0.01, 20}, {0.498, 0.01, 20}};
    const estimate differ[] = {single, {0.9, 0.01, 20}, {0.1, 0.01, 20}};
    CHECK(std::abs(aabblab::mean_of(agree).value - 0.5) < 1e-12);
    const auto width = [](const estimate& e) { return e.range().high - e.range().low; };
    CHECK(width(aabblab::mean_of(agree)) < width(single));
    // Two degrees of freedom: 4.303 standard errors of 0.4 / sqrt(3) on either side.
    CHECK(std::abs(width(aabblab::mean_of(differ)) - 2 * 4.303 * 0.4 / std::sqrt(3.0)) < 0.01);
}

TEST_CASE("A verdict is undecided if its undecided endpoints could change it") {
    using enum support;
    using enum aabblab::verdict_rule;
    const auto verdict = [](aabblab::verdict_rule rule, const std::vector<support>& primary) {
        return aabblab::verdict_of(primary, rule);
    };
    for (const auto rule : {every, cases}) {
        CHECK(verdict(rule, {favours}) == verdict_kind::holds);
        CHECK(verdict(rule, {favours, favours}) == verdict_kind::holds);
        CHECK(verdict(rule, {favours, undecided}) == verdict_kind::undecided);
        CHECK(verdict(rule, {no_difference, undecided}) == verdict_kind::undecided);
        CHECK(verdict(rule, {contradicts}) == verdict_kind::does_not_hold);
        CHECK(verdict(rule, {no_difference, contradicts}) == verdict_kind::does_not_hold);
        CHECK(verdict(rule, {no_difference, no_difference}) == verdict_kind::no_difference);
        CHECK(verdict(rule, {}) == verdict_kind::undecided);
    }
    CHECK(verdict(cases, {favours, contradicts}) == verdict_kind::in_part);
    CHECK(verdict(cases, {favours, no_difference}) == verdict_kind::in_part);
    CHECK(verdict(cases, {favours, contradicts, undecided}) == verdict_kind::in_part);
    CHECK(verdict(cases, {contradicts, undecided}) == verdict_kind::undecided);
    // A claim that speaks of all is refuted by one, whatever the others are.
    CHECK(verdict(every, {favours, contradicts}) == verdict_kind::does_not_hold);
    CHECK(verdict(every, {favours, no_difference}) == verdict_kind::does_not_hold);
    CHECK(verdict(every, {favours, contradicts, undecided}) == verdict_kind::does_not_hold);
    CHECK(verdict(every, {contradicts, undecided}) == verdict_kind::does_not_hold);
}
