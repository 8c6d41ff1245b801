module aabblab.stiff:simulation;

import aabb.pipeline;
import aabb.std;
import aabblab.stepping;
import aabblab.stiff;
import aabblab.trials;
import aabblab.stopwatch;

namespace aabblab {

/// A scene with one frame for each position at which an integrator evaluates forces.
class posed_bodies final : public aabb::mesh_scene {
public:
    explicit posed_bodies(const stepped_world& world) : world_(world) {
        meshes = world.meshes;
        mesh_of = world.mesh_of();
        state_ = world.start();
    }

    void move_to(const motion_state& state) { state_ = state; }

    [[nodiscard]] std::size_t frames() const override { return std::numeric_limits<std::size_t>::max(); }
    bool next(std::vector<aabb::pose>& poses) override {
        world_.place(state_, poses);
        return true;
    }

private:
    const stepped_world& world_;
    motion_state state_;
};

/// A world that is advanced by an integrator, with contacts found by a candidate.
class simulation {
public:
    /// @param tolerance of an adaptive integrator
    simulation(const stepped_world& world, const candidate& tested, const integrator_info& stepping,
               double tolerance = 0, const stiff_fault& fault = {})
        : world_(with_friction(world, fault.friction)),
          bodies_(new posed_bodies(world_)),
          frames_(std::unique_ptr<aabb::mesh_scene>(bodies_)),
          runner_(tested, frames_, aabb::instrumentation::none),
          dynamics_(world_),
          integrator_(stepping.make(tolerance)),
          state_(world_.start()),
          equations_{[this, fault](const motion_state& state, motion_rates& rates) {
                         dynamics_.accelerate(state, detect_at(state), rates);
                         for (double& torque : rates.torque) torque *= fault.torque;
                     },
                     world_.rotors()} {
        ignored_.fit(state_);
    }
    /// Simulates with the candidate and the fault of a setting.
    simulation(const stepped_world& world, const stiff_setting& setting, const integrator_info& stepping,
               double tolerance = 0)
        : simulation(world, setting.tested, stepping, tolerance, setting.fault) {}

    void advance(double step) { integrator_->advance(equations_, state_, step); }

    [[nodiscard]] const motion_state& state() const { return state_; }
    [[nodiscard]] std::uint64_t detections() const { return detections_; }
    [[nodiscard]] double detection_ms() const { return detection_ms_; }

    /// The sorted contacts at the current positions; detects them only if the integrator did not evaluate these last.
    [[nodiscard]] std::span<const aabb::contact> contacts() {
        return detected_.position == state_.position && detected_.orientation == state_.orientation
                   ? std::span<const aabb::contact>(runner_.sorted_contacts())
                   : detect_at(state_);
    }
    /// The angular velocity of a body in the world's axes, rad/s.
    [[nodiscard]] aabb::vec3d angular_velocity(std::size_t body) const {
        return dynamics_.angular_velocity(state_, body);
    }
    /// Kinetic, potential and spring energy, J; without the energy of a shared volume.
    [[nodiscard]] double energy() {
        dynamics_.accelerate(state_, contacts(), ignored_);
        return dynamics_.mechanical_energy(state_) + dynamics_.spring_energy();
    }

private:
    static stepped_world with_friction(stepped_world world, double factor) {
        world.law.friction *= factor;
        return world;
    }

    /// Moves the scene's bodies to where they are in a state, and detects their sorted contacts by both phases, which
    /// it times.
    std::span<const aabb::contact> detect_at(const motion_state& state) {
        bodies_->move_to(state);
        detected_ = state;
        frames_.next();
        stopwatch watch;
        runner_.update();
        runner_.search();
        runner_.detect();
        detection_ms_ += watch.lap().cpu_ms;
        ++detections_;
        return runner_.sorted_contacts();
    }

    stepped_world world_;
    posed_bodies* bodies_;  // owned by frames_
    scene_frames frames_;
    stage_runner runner_;
    dynamics dynamics_;
    std::unique_ptr<integrator> integrator_;
    motion_state state_;
    equations_of_motion equations_;
    motion_rates ignored_;
    motion_state detected_;  // at the last detection
    std::uint64_t detections_ = 0;
    double detection_ms_ = 0;
};

}  // namespace aabblab
