module;
#include <boost/numeric/odeint/stepper/euler.hpp>

module aabblab.stepping;

import :first_order;

namespace aabblab {

namespace {

class explicit_euler final : public integrator {
public:
    void advance(const equations_of_motion& equations, motion_state& state, double step) override {
        first_order_system system(equations, state);
        stepper_.do_step(system, system.values(), state.time, step);
        system.store(state);
        state.time += step;
    }

private:
    boost::numeric::odeint::euler<std::vector<double>> stepper_;
};

}  // namespace

integrator_info explicit_euler_integrator() {
    return {.name = "explicit_euler",
            .summary = "a step with velocity and force at its start: every oscillation grows (Boost.odeint)",
            .order = 1,
            .half_period_error = std::numbers::pi / 2,  // π times the error z²/2 of a step over |z|²
            .stable_below = 0,
            .energy_factor = [](double y) { return 1 + y * y; },  // |1 + iy|²
            .make = [](double) -> std::unique_ptr<integrator> { return std::make_unique<explicit_euler>(); }};
}

}  // namespace aabblab
