module;
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

module aabblab.stepping;

import :first_order;

namespace aabblab {

namespace {

using stepper = boost::numeric::odeint::runge_kutta_dopri5<std::vector<double>>;

class fixed_dormand_prince final : public integrator {
public:
    void advance(const acceleration_of& acceleration, motion_state& state, double step) override {
        first_order_system system(acceleration, state);
        // Its first stage is the last one of the step before, from which nothing has moved the state.
        stepper_.do_step(system, system.both(), state.time, step);
        system.store(state);
        state.time += step;
    }

private:
    stepper stepper_;
};

class adaptive_dormand_prince final : public integrator {
public:
    explicit adaptive_dormand_prince(double tolerance) : tolerance_(tolerance) {}

    void advance(const acceleration_of& acceleration, motion_state& state, double step) override {
        namespace odeint = boost::numeric::odeint;
        first_order_system system(acceleration, state);
        odeint::integrate_adaptive(odeint::make_controlled<stepper>(tolerance_, tolerance_), system, system.both(),
                                   state.time, state.time + step, step);
        system.store(state);
        state.time += step;
    }

private:
    double tolerance_;
};

}  // namespace

integrator_info dormand_prince_integrator() {
    // On the imaginary axis 1 + z + … + z^5/120 + z^6/600 leaves the unit circle where y² is the root of
    // w³ - 25 w² + 225 w - 200.
    return {"dormand_prince", "the Runge-Kutta pair of orders 5 and 4, with steps of one size (Boost.odeint)", false, 5,
            0.99720,
            [](double) -> std::unique_ptr<integrator> { return std::make_unique<fixed_dormand_prince>(); }};
}

integrator_info adaptive_dormand_prince_integrator() {
    return {"dormand_prince_adaptive", "the same with steps of its own choice, after a tolerance (Boost.odeint)", true, 5,
            std::numeric_limits<double>::infinity(), [](double tolerance) -> std::unique_ptr<integrator> {
                return std::make_unique<adaptive_dormand_prince>(tolerance);
            }};
}

}  // namespace aabblab
