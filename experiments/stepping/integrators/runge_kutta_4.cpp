module;
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>

module aabblab.stepping;

import :first_order;

namespace aabblab {

namespace {

class runge_kutta_4 final : public integrator {
public:
    void advance(const equations_of_motion& equations, motion_state& state, double step) override {
        first_order_system system(equations, state);
        stepper_.do_step(system, system.values(), state.time, step);
        system.store(state);
        state.time += step;
    }

private:
    boost::numeric::odeint::runge_kutta4<std::vector<double>> stepper_;
};

}  // namespace

integrator_info runge_kutta_4_integrator() {
    return {.name = "runge_kutta_4",
            .summary = "the classical Runge-Kutta method of order 4, by Kutta 1901 (Boost.odeint)",
            .order = 4,
            .half_period_error = std::numbers::pi / 120,  // π times the error z^5/120 of a step over |z|^5
            .stable_below = std::sqrt(8.0),               // dt·ω, where the energy factor is 1
            .energy_factor =                              // |1 + z + z²/2 + z³/6 + z⁴/24|² for z = iy
            [](double y) { return 1 - std::pow(y, 6) / 72 + std::pow(y, 8) / 576; },
            .make = [](double) -> std::unique_ptr<integrator> { return std::make_unique<runge_kutta_4>(); }};
}

}  // namespace aabblab
