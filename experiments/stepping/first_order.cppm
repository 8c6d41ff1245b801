/// The motion as a system of first order, twice as large: displacements since the start, then velocities. Displacements
/// keep precision: solvers perturb values relatively, and a contact's depth can be a billionth of a position.
module aabblab.stepping:first_order;

import :dynamics;

namespace aabblab {

class first_order_system {
public:
    first_order_system(const acceleration_of& acceleration, const motion_state& state)
        : acceleration_(acceleration),
          start_(state.position),
          values_(state.position.size(), 0.0),
          position_(state.position),
          velocity_(state.velocity),
          accelerations_(state.position.size()) {
        values_.insert(values_.end(), state.velocity.begin(), state.velocity.end());
    }

    /// The derivative of the values, for solvers: the values are displacements since the start, then velocities, so
    /// their derivative is velocities, then accelerations a(x, v).
    void operator()(const std::vector<double>& values, std::vector<double>& derivative, double /*time*/) {
        const auto half = static_cast<std::ptrdiff_t>(position_.size());
        std::transform(values.begin(), values.begin() + half, start_.begin(), position_.begin(), std::plus());
        std::copy(values.begin() + half, values.end(), velocity_.begin());
        acceleration_(position_, velocity_, accelerations_);
        std::ranges::copy(velocity_, derivative.begin());
        std::ranges::copy(accelerations_, derivative.begin() + half);
    }

    [[nodiscard]] std::vector<double>& values() { return values_; }

    void store(motion_state& state) const {
        const auto half = static_cast<std::ptrdiff_t>(position_.size());
        std::transform(values_.begin(), values_.begin() + half, start_.begin(), state.position.begin(), std::plus());
        std::copy(values_.begin() + half, values_.end(), state.velocity.begin());
    }

private:
    const acceleration_of& acceleration_;
    std::vector<double> start_;
    std::vector<double> values_;
    std::vector<double> position_;
    std::vector<double> velocity_;
    std::vector<double> accelerations_;
};

}  // namespace aabblab
