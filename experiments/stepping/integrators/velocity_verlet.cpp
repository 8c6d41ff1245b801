module;
#include <boost/numeric/odeint/stepper/velocity_verlet.hpp>

module aabblab.stepping;

namespace aabblab {

namespace {

/// The integrator of Verlet 1967, in the velocity form of Swope et al. 1982.
class velocity_verlet final : public integrator {
public:
    void advance(const acceleration_of& acceleration, motion_state& state, double step) override {
        const auto force = [&](const std::vector<double>& position, const std::vector<double>& velocity,
                               std::vector<double>& change, double) { acceleration(position, velocity, change); };
        stepper_.do_step(force, std::pair(std::ref(state.position), std::ref(state.velocity)), state.time, step);
        state.time += step;
    }

private:
    boost::numeric::odeint::velocity_verlet<std::vector<double>> stepper_;
};

}  // namespace

integrator_info velocity_verlet_integrator() {
    return {
        .name = "velocity_verlet",
        .summary =
            "central differences; of first order if forces depend on velocity, which lags a step behind (Boost.odeint)",
        .order = 2,
        .stable_below = 2,  // dt·ω
        .make = [](double) -> std::unique_ptr<integrator> { return std::make_unique<velocity_verlet>(); }};
}

}  // namespace aabblab
