/// A linear spring and dashpot under a mass, in closed form.
module aabblab.stiff:oscillator;

namespace aabblab {

/// Mass 1 kg on a spring: x'' = -ω² x - 2ζω x'.
struct oscillator {
    double frequency;  ///< ω, 1/s
    double damping;    ///< ζ

    /// How deep a mass is that touches at time 0 with this speed, m. Underdamped.
    [[nodiscard]] double depth(double speed, double time) const;
    /// The rate at which this depth grows, m/s.
    [[nodiscard]] double sinking(double speed, double time) const;
    /// Until it is back where it touched, s.
    [[nodiscard]] double contact_time() const;
    /// Speed when it is back there, over the one with which it came.
    [[nodiscard]] double restitution() const;
    /// ζ with which the restitution is this.
    [[nodiscard]] static double damping_for(double restitution);
};

}  // namespace aabblab
