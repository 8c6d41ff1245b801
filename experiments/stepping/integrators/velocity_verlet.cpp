module aabblab.stepping;

namespace aabblab {

namespace {

/// The integrator of Verlet 1967, in the velocity form of Swope et al. 1982. Bodies turn with the angular momentum of
/// the middle of the step (Dullweber, Leimkuhler and McLachlan 1997).
class velocity_verlet final : public integrator {
public:
    void advance(const equations_of_motion& equations, motion_state& state, double step) override {
        if (!std::exchange(has_rates_, true)) {
            before_.fit(state);
            equations.rates(state, before_);
        }
        for (std::size_t i = 0; i < state.position.size(); ++i)
            state.position[i] =
                state.position[i] + step * state.velocity[i] + 0.5 * step * step * before_.acceleration[i];
        const std::vector<double> momentum = state.angular_momentum;
        for (std::size_t i = 0; i < momentum.size(); ++i) state.angular_momentum[i] += 0.5 * step * before_.torque[i];
        turn_all_freely(equations.rotors, state, step);
        // Forces see the velocity and the angular momentum at the start.
        state.angular_momentum = momentum;
        after_.fit(state);
        equations.rates(state, after_);
        for (std::size_t i = 0; i < state.velocity.size(); ++i)
            state.velocity[i] =
                state.velocity[i] + 0.5 * step * before_.acceleration[i] + 0.5 * step * after_.acceleration[i];
        for (std::size_t i = 0; i < momentum.size(); ++i)
            state.angular_momentum[i] += 0.5 * step * (before_.torque[i] + after_.torque[i]);
        std::swap(before_, after_);
        state.time += step;
    }

private:
    bool has_rates_ = false;       // of the previous step's end
    motion_rates before_, after_;  // at the start and the end of a step
};

}  // namespace

integrator_info velocity_verlet_integrator() {
    return {.name = "velocity_verlet",
            .summary = "central differences; of first order if forces depend on velocity, which lags a step behind",
            .order = 2,
            // The frequency is (dt·ω)²/24 too high, the amplitude of the position (dt·ω)²/8 too great: this is the
            // maximum over half a period of the root of (sin φ/8 + φ cos φ/24)² + (φ sin φ/24)².
            .half_period_error = 0.14509,
            .velocity_lag = 1,
            .stable_below = 2,  // dt·ω
            .make = [](double) -> std::unique_ptr<integrator> { return std::make_unique<velocity_verlet>(); }};
}

}  // namespace aabblab
