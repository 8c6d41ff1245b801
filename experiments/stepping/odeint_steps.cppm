/// Steps of one size by a stepper of Boost.odeint, for integrators that differ in the stepper only.
module aabblab.stepping:odeint_steps;

import :first_order;

namespace aabblab {

template <class Stepper>
class odeint_steps final : public integrator {
public:
    void advance(const equations_of_motion& equations, motion_state& state, double step) override {
        first_order_system system(equations, state);
        stepper_.do_step(system, system.values(), state.time, step);
        system.store(state);
        state.time += step;
    }

private:
    Stepper stepper_;
};

}  // namespace aabblab
