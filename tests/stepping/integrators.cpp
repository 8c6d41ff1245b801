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
    REQUIRE(aabblab::integrators().size() + aabblab::left_out_integrators().size() == 5);
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
