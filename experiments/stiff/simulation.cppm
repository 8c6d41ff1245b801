module aabblab.stiff:simulation;

import aabb.pipeline;
import aabb.std;
import aabblab.stepping;
import aabblab.stiff;
import aabblab.trials;
import aabblab.stopwatch;

namespace aabblab {

/// The integrators with which a setting lets a study run.
[[nodiscard]] std::vector<integrator_info> integrators_of(const stiff_setting& setting) {
    std::vector<integrator_info> chosen;
    std::ranges::copy_if(integrators(), std::back_inserter(chosen), [&](const integrator_info& i) {
        return setting.integrators.empty() ||
               std::ranges::find(setting.integrators, i.name) != setting.integrators.end();
    });
    return chosen;
}

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
    /// Times detections from now on. Reading the clocks takes as long as detecting the contacts of a few bodies.
    void time_detections() { is_timed_ = true; }
    /// The processor time of those that were timed.
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

    /// Moves the scene's bodies to where they are in a state, and detects their sorted contacts by both phases.
    std::span<const aabb::contact> detect_at(const motion_state& state) {
        bodies_->move_to(state);
        detected_ = state;
        frames_.next();
        std::optional<stopwatch> watch;
        if (is_timed_) watch.emplace();
        runner_.update();
        runner_.search();
        runner_.detect();
        if (watch) detection_ms_ += watch->lap().cpu_ms;
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
    bool is_timed_ = false;
    double detection_ms_ = 0;
};

}  // namespace aabblab
