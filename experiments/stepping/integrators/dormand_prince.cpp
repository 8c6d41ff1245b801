module;
#include <boost/numeric/odeint/stepper/runge_kutta_dopri5.hpp>

module aabblab.stepping;

import :odeint_steps;

namespace aabblab {

// First same as last (Dormand and Prince 1980): the last stage of a step is the first of the next one.
using dormand_prince = odeint_steps<boost::numeric::odeint::runge_kutta_dopri5<std::vector<double>>>;

integrator_info dormand_prince_integrator() {
    // On the imaginary axis the stability polynomial 1 + z + … + z^5/120 + z^6/600 leaves the unit circle at z = iy
    // where w = y² is the root of w³ - 25 w² + 225 w - 200.
    return {.name = "dormand_prince",
            .summary = "the Runge-Kutta pair of orders 5 and 4, with steps of one size (Boost.odeint)",
            .order = 5,
            .half_period_error = std::numbers::pi / 3600,  // π times the error (1/600 - 1/720) z^6 of a step over |z|^6
            .stable_below = 0.99720,                       // dt·ω
            .energy_factor =
                [](double y) {
                    const double real = 1 - y * y / 2 + std::pow(y, 4) / 24 - std::pow(y, 6) / 600;
                    const double imaginary = y - std::pow(y, 3) / 6 + std::pow(y, 5) / 120;
                    return real * real + imaginary * imaginary;
                },
            .make = [](double) -> std::unique_ptr<integrator> { return std::make_unique<dormand_prince>(); }};
}

}  // namespace aabblab
