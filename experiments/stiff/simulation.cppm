module aabblab.stiff:simulation;

import aabb.geometry;
import aabb.pipeline;
import aabb.std;
import aabblab.trials;
import aabblab.stepping;

namespace aabblab {

/// A world that one integrator steps and one contender finds the contacts of.
class simulation {
public:
    /// @param world must outlive this
    /// @param tolerance of an integrator that chooses its own steps
    simulation(const stepped_world& world, const contender& who, const integrator_info& stepping, double tolerance = 0);

    /// By so many seconds.
    void advance(double step);

    [[nodiscard]] const motion_state& state() const { return state_; }
    [[nodiscard]] std::uint64_t detections() const { return detections_; }
    [[nodiscard]] double detection_ms() const { return detection_ms_; }

    /// What is found where the bodies are now, sorted; looked for only where the integrator did not end there.
    [[nodiscard]] std::span<const aabb::contact> contacts();
    /// Of motion, height and springs, J; of a shared volume without its pressure.
    [[nodiscard]] double energy();

private:
    class posed_bodies;

    std::span<const aabb::contact> find(std::span<const double> position);

    const stepped_world& world_;
    posed_bodies* poses_;  // in play_
    scene_play play_;
    player player_;
    dynamics dynamics_;
    std::unique_ptr<integrator> integrator_;
    acceleration_of acceleration_;
    motion_state state_;
    std::vector<double> ignored_;
    std::vector<double> looked_at_;  // last
    std::uint64_t detections_ = 0;
    double detection_ms_ = 0;
};

}  // namespace aabblab
