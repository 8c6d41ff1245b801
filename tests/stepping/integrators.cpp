#include <catch2/matchers/catch_matchers.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>

#include "../testing.hpp"

import aabblab.stepping;

namespace {

/// x'' = -4 x from (1, 0): cos 2t.
double error_after_a_second(const aabblab::integrator_info& info, double step) {
    const auto stepper = info.make(1e-10);
    aabblab::motion_state state{{1}, {0}, 0};
    const aabblab::equations_of_motion spring{
        [](const auto& s, auto& rates) { rates.acceleration[0] = -4 * s.position[0]; }};
    for (int i = 0; i < std::lround(1 / step); ++i) stepper->advance(spring, state, step);
    REQUIRE(std::abs(state.time - 1) < 1e-12);
    return std::hypot(state.position[0] - std::cos(2.0), state.velocity[0] / 2 + std::sin(2.0));
}

}  // namespace

TEST_CASE("every integrator has its stated order or keeps its tolerance") {
    REQUIRE(aabblab::integrators().size() + aabblab::left_out_integrators().size() == 8);
    for (const aabblab::integrator_info& info : aabblab::integrators()) {
        INFO(info.name);
        REQUIRE(aabblab::integrator_named(info.name) == &info);
        const double coarse = error_after_a_second(info, 0.05);
        if (info.adaptive) {
            REQUIRE(coarse < 1e-6);
            continue;
        }
        const double order = std::log2(coarse / error_after_a_second(info, 0.025));
        REQUIRE(std::abs(order - info.order) < 0.2);
    }
    REQUIRE(aabblab::integrator_named("euler") == nullptr);
}

TEST_CASE("integrators pass velocities to forces") {
    // x'' = -3 v from v = 1: v = exp(-3t).
    for (const aabblab::integrator_info& info : aabblab::integrators()) {
        INFO(info.name);
        const auto stepper = info.make(1e-10);
        aabblab::motion_state state{{0}, {1}, 0};
        const aabblab::equations_of_motion drag{
            [](const auto& s, auto& rates) { rates.acceleration[0] = -3 * s.velocity[0]; }};
        for (int i = 0; i < 1000; ++i) stepper->advance(drag, state, 0.001);
        REQUIRE(std::abs(state.velocity[0] - std::exp(-3.0)) < 0.002);
    }
}

namespace {

/// An undamped oscillation of angular frequency 1 from (0, 1), after each step.
std::vector<aabblab::motion_state> oscillation(const aabblab::integrator_info& info, double step, int steps) {
    const auto stepper = info.make(0);
    const aabblab::equations_of_motion spring{
        [](const auto& s, auto& rates) { rates.acceleration[0] = -s.position[0]; }};
    std::vector<aabblab::motion_state> states{{{0}, {1}, 0}};
    for (int i = 0; i < steps; ++i) {
        states.push_back(states.back());
        stepper->advance(spring, states.back(), step);
    }
    return states;
}

double energy_of(const aabblab::motion_state& s) {
    return (s.position[0] * s.position[0] + s.velocity[0] * s.velocity[0]) / 2;
}

/// The equations of springs between masses of 1 kg in a row, and to walls at both ends.
aabblab::equations_of_motion chain(std::vector<double> stiffness) {
    return {[stiffness = std::move(stiffness)](const auto& s, auto& rates) {
        const std::size_t n = s.position.size();
        for (std::size_t i = 0; i < n; ++i) {
            const double before = i == 0 ? 0 : s.position[i - 1], after = i + 1 == n ? 0 : s.position[i + 1];
            rates.acceleration[i] =
                stiffness[i] * (before - s.position[i]) + stiffness[i + 1] * (after - s.position[i]);
        }
    }};
}

}  // namespace

TEST_CASE("an oscillation has the stated error after half a period, and the stated energy after a step") {
    for (const aabblab::integrator_info& info : aabblab::integrators()) {
        if (info.adaptive) continue;
        INFO(info.name);
        constexpr int steps = 200;
        const double step = std::numbers::pi / steps;
        double greatest = 0;
        for (const auto& s : oscillation(info, step, steps))
            greatest =
                std::max(greatest, std::hypot(s.position[0] - std::sin(s.time), s.velocity[0] - std::cos(s.time)));
        REQUIRE(std::abs(greatest / (info.half_period_error * std::pow(step, info.order)) - 1) < 0.03);
        REQUIRE(info.is_symplectic() == (info.energy_factor == nullptr));
        for (const double y : {0.1, 0.7, 1.5})
            if (info.energy_factor) {
                const double measured = energy_of(oscillation(info, y, 1)[1]) / 0.5;
                REQUIRE(std::abs(measured - info.energy_factor(y)) < 1e-12);
            }
        // At the limit of stability, the energy of a step is kept.
        if (info.energy_factor && info.stable_below > 0)
            REQUIRE(std::abs(info.energy_factor(info.stable_below) - 1) < 1e-4);
    }
}

TEST_CASE("the implicit midpoint keeps the energy of oscillations of any stiffness") {
    const aabblab::integrator_info& info = *aabblab::integrator_named("implicit_midpoint");
    const auto states = oscillation(info, 1e3, 100);
    REQUIRE(std::abs(energy_of(states.back()) / energy_of(states.front()) - 1) < 1e-9);
    // Coupled springs of very different stiffness.
    std::vector<double> stiffness;
    for (int i = 0; i <= 8; ++i) stiffness.push_back(std::pow(10.0, i));
    const aabblab::equations_of_motion springs = chain(stiffness);
    aabblab::motion_state state{std::vector(8, 0.0), std::vector(8, 1.0), 0};
    const auto energy = [&] {
        double sum = 0;
        for (std::size_t i = 0; i <= 8; ++i) {
            const double stretched = (i == 8 ? 0 : state.position[i]) - (i == 0 ? 0 : state.position[i - 1]);
            sum += stiffness[i] * stretched * stretched / 2;
            if (i < 8) sum += state.velocity[i] * state.velocity[i] / 2;
        }
        return sum;
    };
    const auto stepper = info.make(0);
    for (int i = 0; i < 200; ++i) stepper->advance(springs, state, 0.01);
    REQUIRE(std::abs(energy() / 4 - 1) < 1e-6);
}

TEST_CASE("the implicit midpoint reports a step that has no solution") {
    // A force that jumps against the motion: neither side of the jump has a solution.
    const aabblab::equations_of_motion jump{
        [](const auto& s, auto& rates) { rates.acceleration[0] = s.position[0] > 0 ? -1 : 1; }};
    aabblab::motion_state state{{0}, {0}, 0};
    REQUIRE_THROWS_WITH(aabblab::integrator_named("implicit_midpoint")->make(0)->advance(jump, state, 1),
                        Catch::Matchers::StartsWith("implicit_midpoint gives up after 0.000000 s"));
}

TEST_CASE("bdf keeps its tolerance with many values, whose linear systems it solves without a matrix") {
    const aabblab::integrator_info* const info = aabblab::integrator_named("bdf");
    if (info == nullptr) SKIP("the integrator bdf is left out of this build");
    aabblab::motion_state state{std::vector(90, 1.0), std::vector(90, 0.0), 0};
    const aabblab::equations_of_motion springs{[](const auto& s, auto& rates) {
        for (std::size_t i = 0; i < s.position.size(); ++i)
            rates.acceleration[i] = -(1.0 + static_cast<double>(i)) * s.position[i];
    }};
    info->make(1e-9)->advance(springs, state, 1);
    for (std::size_t i = 0; i < state.position.size(); ++i)
        REQUIRE(std::abs(state.position[i] - std::cos(std::sqrt(1.0 + static_cast<double>(i)))) < 1e-5);
}
