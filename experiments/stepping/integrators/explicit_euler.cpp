module;
#include <boost/numeric/odeint/stepper/euler.hpp>

module aabblab.stepping;

import :odeint_steps;

namespace aabblab {

using explicit_euler = odeint_steps<boost::numeric::odeint::euler<std::vector<double>>>;

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
