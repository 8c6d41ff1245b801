module aabblab.stiff:simulation;

import aabb.pipeline;
import aabb.std;
import aabblab.trials;
import aabblab.stepping;
import aabblab.stopwatch;

namespace aabblab {

/// A scene with one frame for each position at which an integrator evaluates forces.
class posed_bodies final : public aabb::mesh_scene {
public:
    explicit posed_bodies(const stepped_world& world) : world_(world) {
        meshes = world.meshes;
        mesh_of = world.mesh_of();
        position_ = world.start().position;
    }

    void move_to(std::span<const double> position) { position_.assign(position.begin(), position.end()); }

    [[nodiscard]] std::size_t frames() const override { return std::numeric_limits<std::size_t>::max(); }
    bool next(std::vector<aabb::pose>& poses) override {
        world_.place(position_, poses);
        return true;
    }

private:
    const stepped_world& world_;
    std::vector<double> position_;
};

/// A world that is advanced by an integrator, with contacts found by a candidate.
class simulation {
public:
    /// @param world must outlive this
    /// @param tolerance of an adaptive integrator
    simulation(const stepped_world& world, const candidate& tested, const integrator_info& stepping,
               double tolerance = 0)
        : bodies_(new posed_bodies(world)),
          frames_(std::unique_ptr<aabb::mesh_scene>(bodies_)),
          runner_(tested, frames_, aabb::instrumentation::none),
          dynamics_(world),
          integrator_(stepping.make(tolerance)),
          state_(world.start()),
          ignored_(state_.position.size()) {
        acceleration_ = [this](const std::vector<double>& position, const std::vector<double>& velocity,
                               std::vector<double>& acceleration) {
            dynamics_.accelerate(position, velocity, detect_at(position), acceleration);
        };
    }

    void advance(double step) { integrator_->advance(acceleration_, state_, step); }

    [[nodiscard]] const motion_state& state() const { return state_; }
    [[nodiscard]] std::uint64_t detections() const { return detections_; }
    [[nodiscard]] double detection_ms() const { return detection_ms_; }

    /// The sorted contacts at the current positions; detects them only if the integrator did not evaluate these last.
    [[nodiscard]] std::span<const aabb::contact> contacts() {
        return detected_position_ == state_.position ? std::span<const aabb::contact>(runner_.sorted_contacts())
                                                     : detect_at(state_.position);
    }
    /// Kinetic, potential and spring energy, J; without the energy of a shared volume.
    [[nodiscard]] double energy() {
        dynamics_.accelerate(state_.position, state_.velocity, contacts(), ignored_);
        return dynamics_.mechanical_energy(state_) + dynamics_.spring_energy();
    }

private:
    /// Moves the scene's bodies to these positions, and detects their sorted contacts by both phases, which it times.
    std::span<const aabb::contact> detect_at(std::span<const double> position) {
        bodies_->move_to(position);
        detected_position_.assign(position.begin(), position.end());
        frames_.next();
        const wall_stopwatch watch;
        runner_.update();
        runner_.search();
        runner_.detect();
        detection_ms_ += watch.ms();
        ++detections_;
        return runner_.sorted_contacts();
    }

    posed_bodies* bodies_;  // owned by frames_
    scene_frames frames_;
    stage_runner runner_;
    dynamics dynamics_;
    std::unique_ptr<integrator> integrator_;
    acceleration_of acceleration_;
    motion_state state_;
    std::vector<double> ignored_;
    std::vector<double> detected_position_;  // of the last detection
    std::uint64_t detections_ = 0;
    double detection_ms_ = 0;
};

}  // namespace aabblab
