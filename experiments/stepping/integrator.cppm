export module aabblab.stepping:integrator;

import aabb.std;
import :dynamics;

export namespace aabblab {

/// x'' = a(x, v): takes position and velocity, sets the acceleration. Every call is one detection.
using acceleration_of = std::function<void(const std::vector<double>& position, const std::vector<double>& velocity,
                                           std::vector<double>& acceleration)>;

/// Follows one trajectory: after the first call the state is the one that it left, and the acceleration the same.
class integrator {
public:
    integrator() = default;
    integrator(const integrator&) = delete;
    integrator& operator=(const integrator&) = delete;
    virtual ~integrator() = default;

    /// From the state's time on by `step`, s; one that chooses its own steps takes as many as it needs.
    /// @throws aabb::input_error where it cannot.
    virtual void advance(const acceleration_of& acceleration, motion_state& state, double step) = 0;
};

/// An integrator of this build.
struct integrator_info {
    std::string_view name;
    std::string_view summary;
    bool adaptive;  ///< it chooses its own steps, after a tolerance
    int order;
    /// The greatest step times angular frequency with which an undamped oscillation does not grow; infinite for one
    /// that chooses its own steps.
    double stable_below;
    std::unique_ptr<integrator> (*make)(double tolerance);  ///< the tolerance is of adaptive ones
};

[[nodiscard]] std::span<const integrator_info> integrators();
/// Those that this build lacks, because their library was not there.
[[nodiscard]] std::span<const std::string_view> left_out_integrators();
/// Null where this build has none of this name.
[[nodiscard]] const integrator_info* integrator_named(std::string_view name);

}  // namespace aabblab
