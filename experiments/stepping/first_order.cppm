/// The motion as a system of first order: displacements since the start, then velocities. Displacements keep precision:
/// solvers perturb values relatively, and a contact's depth can be a billionth of a position.
module aabblab.stepping:first_order;

import :dynamics;

namespace aabblab {

/// The values are, in this order: displacements of positions, those of the quaternions of bodies that turn, velocities,
/// and angular momenta. Derivatives do not depend on where displacements start: Dormand and Prince's last stage serves
/// the next step too.
class first_order_system {
public:
    first_order_system(const equations_of_motion& equations, const motion_state& state)
        : equations_(equations), start_(state), current_(state) {
        rates_.fit(state);
        values_.assign(state.position.size() + state.orientation.size(), 0.0);
        values_.insert(values_.end(), state.velocity.begin(), state.velocity.end());
        values_.insert(values_.end(), state.angular_momentum.begin(), state.angular_momentum.end());
    }

    /// The derivative of the values, for solvers: velocities, the rates of quaternions, accelerations, and torques.
    void operator()(const std::vector<double>& values, std::vector<double>& derivative, double /*time*/) {
        take(values);
        equations_.rates(current_, rates_);
        auto to = std::ranges::copy(current_.velocity, derivative.begin()).out;
        for (std::size_t i = 0; i < current_.turning_bodies(); ++i) {
            const aabb::vec3d turning =
                angular_velocity_of(equations_.rotors[i], current_.orientation_of(i), current_.momentum_of(i));
            to = std::ranges::copy(rate_of(quaternion_of_values(values, i), turning), to).out;
        }
        to = std::ranges::copy(rates_.acceleration, to).out;
        std::ranges::copy(rates_.torque, to);
    }

    [[nodiscard]] std::vector<double>& values() { return values_; }

    void store(motion_state& state) {
        take(values_);
        state.position = current_.position;
        state.velocity = current_.velocity;
        state.orientation = current_.orientation;
        state.angular_momentum = current_.angular_momentum;
    }

private:
    /// The orientation of a body, whose length need not be 1.
    [[nodiscard]] std::array<double, 4> quaternion_of_values(const std::vector<double>& values,
                                                             std::size_t turning) const {
        const double* const p = &values[start_.position.size() + 4 * turning];
        const std::span<const double, 4> q = start_.orientation_of(turning);
        return {q[0] + p[0], q[1] + p[1], q[2] + p[2], q[3] + p[3]};
    }

    /// Sets the current state to these values.
    void take(const std::vector<double>& values) {
        const std::span<const double> numbers = values;
        const std::size_t positions = start_.position.size(), orientations = start_.orientation.size();
        std::ranges::transform(numbers.first(positions), start_.position, current_.position.begin(), std::plus());
        for (std::size_t i = 0; i < start_.turning_bodies(); ++i)
            std::ranges::copy(of_length_1(quaternion_of_values(values, i)), &current_.orientation[4 * i]);
        std::ranges::copy(numbers.subspan(positions + orientations, positions), current_.velocity.begin());
        std::ranges::copy(numbers.subspan(2 * positions + orientations), current_.angular_momentum.begin());
    }

    const equations_of_motion& equations_;
    motion_state start_;
    motion_state current_;
    motion_rates rates_;
    std::vector<double> values_;
};

}  // namespace aabblab
