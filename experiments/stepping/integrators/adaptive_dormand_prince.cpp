module;
#include <boost/numeric/odeint/integrate/integrate_adaptive.hpp>
#include <boost/numeric/odeint/stepper/controlled_runge_kutta.hpp>
#include <boost/numeric/odeint/stepper/generation.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>
#include <boost/numeric/odeint/util/odeint_error.hpp>

module aabblab.stepping;

import :first_order;
import aabb.base;

namespace aabblab {

namespace {

class adaptive_dormand_prince final : public integrator {
public:
    explicit adaptive_dormand_prince(double tolerance) : tolerance_(tolerance) {}

    /// Advances the state by `step`, in own steps so short that the estimated error of each is within the tolerance.
    void advance(const equations_of_motion& equations, motion_state& state, double step) override {
        namespace odeint = boost::numeric::odeint;
        using stepper = odeint::runge_kutta_dopri5<std::vector<double>>;
        first_order_system system(equations, state);
        try {
            odeint::integrate_adaptive(odeint::make_controlled<stepper>(tolerance_, tolerance_), system,
                                       system.values(), state.time, state.time + step, step);
        } catch (const odeint::odeint_error& error) {
            throw aabb::input_error("adaptive_dormand_prince gives up after " + std::to_string(state.time) +
                                    " s: " + error.what());
        }
        system.store(state);
        state.time += step;
    }

private:
    double tolerance_;
};

}  // namespace

/// The entry of lists of integrators. "The same" refers to dormand_prince, which precedes it there.
integrator_info adaptive_dormand_prince_integrator() {
    return {.name = "adaptive_dormand_prince",
            .summary = "the same with adaptive steps, controlled by a tolerance (Boost.odeint)",
            .adaptive = true,
            .order = 5,
            .make = [](double tolerance) -> std::unique_ptr<integrator> {
                return std::make_unique<adaptive_dormand_prince>(tolerance);
            }};
}

}  // namespace aabblab
