module aabblab.stiff;

import :simulation;
import aabb.geometry;
import aabb.pipeline;
import aabblab.stepping;
import aabblab.stopwatch;

namespace aabblab {

/// A scene that has a frame wherever an integrator looks.
class simulation::posed_bodies final : public aabb::mesh_scene {
public:
    explicit posed_bodies(const stepped_world& world) : world_(world) {
        meshes = world.meshes;
        mesh_of = world.mesh_of();
        position_ = world.start().position;
    }

    void look_at(std::span<const double> position) { position_.assign(position.begin(), position.end()); }

    [[nodiscard]] std::size_t frames() const override { return std::numeric_limits<std::size_t>::max(); }
    bool next(std::vector<aabb::pose>& poses) override {
        world_.place(position_, poses);
        return true;
    }

private:
    const stepped_world& world_;
    std::vector<double> position_;
};

simulation::simulation(const stepped_world& world, const contender& who, const integrator_info& stepping,
                       double tolerance)
    : world_(world),
      poses_(new posed_bodies(world)),
      play_(std::unique_ptr<aabb::mesh_scene>(poses_)),
      player_(who, play_, aabb::instrumentation::none),
      dynamics_(world),
      integrator_(stepping.make(tolerance)),
      state_(world.start()),
      ignored_(state_.position.size()) {
    acceleration_ = [this](const std::vector<double>& position, const std::vector<double>& velocity,
                           std::vector<double>& acceleration) {
        dynamics_.accelerate(position, velocity, find(position), acceleration);
    };
}

void simulation::advance(double step) {
    integrator_->advance(acceleration_, state_, step);
}

std::span<const aabb::contact> simulation::find(std::span<const double> position) {
    poses_->look_at(position);
    looked_at_.assign(position.begin(), position.end());
    play_.next();
    detection_ms_ += milliseconds_of([&] {
        player_.update();
        player_.search();
        player_.detect();
    });
    ++detections_;
    return player_.sorted_contacts();
}

std::span<const aabb::contact> simulation::contacts() {
    return looked_at_ == state_.position ? std::span<const aabb::contact>(player_.sorted_contacts())
                                         : find(state_.position);
}

double simulation::energy() {
    dynamics_.accelerate(state_.position, state_.velocity, contacts(), ignored_);
    return dynamics_.mechanical_energy(state_) + dynamics_.spring_energy();
}

}  // namespace aabblab
