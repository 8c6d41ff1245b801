module;
#include <boost/numeric/odeint/stepper/symplectic_euler.hpp>

module aabblab.stepping;

namespace aabblab {

namespace {

class symplectic_euler final : public integrator {
public:
    /// Moves the bodies by the old velocity, then changes the velocity by the force at the new position.
    void advance(const acceleration_of& acceleration, motion_state& state, double step) override {
        // The stepper changes the velocity only after this call, so forces see the velocity at the start.
        const auto force = [&](const std::vector<double>& position, std::vector<double>& change) {
            acceleration(position, state.velocity, change);
        };
        stepper_.do_step(force, std::pair(std::ref(state.position), std::ref(state.velocity)), state.time, step);
        state.time += step;
    }

private:
    boost::numeric::odeint::symplectic_euler<std::vector<double>> stepper_;
};

}  // namespace

integrator_info symplectic_euler_integrator() {
    return {.name = "symplectic_euler",
            .summary = "semi-implicit Euler: a step with the old velocity, then the force there (Boost.odeint)",
            .order = 1,
            .stable_below = 2,  // dt·ω
            .make = [](double) -> std::unique_ptr<integrator> { return std::make_unique<symplectic_euler>(); }};
}

}  // namespace aabblab
