module;
#include <boost/numeric/odeint/stepper/runge_kutta4.hpp>

module aabblab.stepping;

import :odeint_steps;

namespace aabblab {

using runge_kutta_4 = odeint_steps<boost::numeric::odeint::runge_kutta4<std::vector<double>>>;

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
