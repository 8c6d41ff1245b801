module aabblab.stepping;

namespace aabblab {

namespace {

class symplectic_euler final : public integrator {
public:
    /// Moves and turns the bodies by the old velocity, then changes the velocity by the force at the new position.
    void advance(const equations_of_motion& equations, motion_state& state, double step) override {
        for (std::size_t i = 0; i < state.position.size(); ++i) state.position[i] += step * state.velocity[i];
        turn_all_freely(equations.rotors, state, step);
        rates_.fit(state);
        // Forces see the velocity at the start.
        equations.rates(state, rates_);
        for (std::size_t i = 0; i < state.velocity.size(); ++i) state.velocity[i] += step * rates_.acceleration[i];
        for (std::size_t i = 0; i < state.angular_momentum.size(); ++i)
            state.angular_momentum[i] += step * rates_.torque[i];
        state.time += step;
    }

private:
    motion_rates rates_;
};

}  // namespace

integrator_info symplectic_euler_integrator() {
    return {.name = "symplectic_euler",
            .summary = "semi-implicit Euler: a step with the old velocity, then the force there",
            .order = 1,
            .half_period_error = 0.5,  // the velocity stands for the middle of the step
            .velocity_lag = 0.5,
            .stable_below = 2,  // dt·ω
            .make = [](double) -> std::unique_ptr<integrator> { return std::make_unique<symplectic_euler>(); }};
}

}  // namespace aabblab
