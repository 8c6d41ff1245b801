module aabblab.stiff;

import :oscillator;

namespace aabblab {

double oscillator::depth(double speed, double time) const {
    const double damped = frequency * std::sqrt(1 - damping * damping);
    return speed / damped * std::exp(-damping * frequency * time) * std::sin(damped * time);
}

double oscillator::sinking(double speed, double time) const {
    const double damped = frequency * std::sqrt(1 - damping * damping);
    return speed * std::exp(-damping * frequency * time) *
           (std::cos(damped * time) - damping * frequency / damped * std::sin(damped * time));
}

double oscillator::contact_time() const {
    return std::numbers::pi / (frequency * std::sqrt(1 - damping * damping));
}

double oscillator::restitution() const {
    return std::exp(-std::numbers::pi * damping / std::sqrt(1 - damping * damping));
}

double oscillator::damping_for(double restitution) {
    const double logarithm = std::log(restitution);
    return -logarithm / std::hypot(std::numbers::pi, logarithm);
}

}  // namespace aabblab
