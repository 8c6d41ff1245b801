module;
// In a partition with Eigen's headers, clang 19 does not see the one of aabb.std.
#include <tuple>

module aabblab.scenes:dropped;

import aabblab.files;
import :dropped_world;
import :posed_meshes;

namespace aabblab {

/// Balls that fall on a floor and on each other, integrated by semi-implicit Euler: the contacts of each frame
/// determine the motion to the next. The first mesh is the floor, the second the ball.
class dropped final : public generated_meshes {
public:
    static constexpr std::string_view name = "dropped";
    static constexpr std::string_view summary =
        "balls dropped on a floor and on each other, pushed apart by the detected contacts";
    static constexpr std::array<std::string_view, 2> default_meshes = {"square", "icosphere:triangles=80"};
    static constexpr std::size_t most_meshes = 2;

    struct config : dropped_config {
        std::uint32_t frames = 1000;
        double step = 0.001;
        scaling normalise = scaling::yes;
    };
    static constexpr std::tuple parameters{
        aabb::integer_parameter{"balls", &config::balls, 0U, 0x7ffffffeU, "how many balls"},
        frames_parameter<config>(),
        aabb::number_parameter{"step", &config::step, 0.0, 1e6, "of time between frames, in seconds"},
        aabb::number_parameter{"height", &config::height, 0.0, 1e6, "of the lowest ball above the floor, in extents",
                               true},
        aabb::number_parameter{"speed", &config::speed, 0.0, 1e6, "initial, downwards, in m/s", true},
        aabb::number_parameter{"depth", &config::depth, 0.0, 1.0,
                               "to which its weight presses a ball into the floor, in extents"},
        aabb::number_parameter{"loss", &config::loss, 0.0, 1e6, "damping over critical damping", true},
        normalise_parameter<config>("scale the ball to a longest extent of 1")};

    /// Places the balls above the floor; contacts that the tested method reports push them away from each other. The
    /// floor keeps its size; the ball is scaled to extent 1 unless the configuration says otherwise.
    dropped(const config& c, std::vector<aabb::mesh> models, std::uint64_t seed)
        : generated_meshes(c.frames, std::move(models), scaling::no), step_(c.step) {
        if (meshes.size() != 2) throw aabb::input_error("dropped needs two meshes: a floor and a ball");
        // Nine numbers per ball: position, velocity and acceleration.
        require_memory("dropped with " + std::to_string(c.balls) + " balls",
                       c.balls * (sizeof(body) + sizeof(aabb::pose) + 9 * sizeof(double) + sizeof(std::uint32_t)));
        if (c.normalise == scaling::yes) normalise(meshes[1]);
        world_ = dropped_world(c, meshes, seed);
        dynamics_.emplace(world_);
        state_ = world_.start();
        rates_.fit(state_);
        mesh_of = world_.mesh_of();
    }

    [[nodiscard]] bool reacts() const override { return true; }

    void take_contacts(std::span<const aabb::contact> contacts) override {
        dynamics_->accelerate(state_, contacts, rates_);
        // The first step uses the initial velocity, which contacts of the first frame do not change.
        if (frames_run() == 1) return;
        for (std::size_t i = 0; i < state_.velocity.size(); ++i) state_.velocity[i] += step_ * rates_.acceleration[i];
    }

private:
    void advance() override {
        for (std::size_t i = 0; i < state_.position.size(); ++i) state_.position[i] += step_ * state_.velocity[i];
    }
    void place(std::size_t, std::vector<aabb::pose>& poses) override { world_.place(state_, poses); }

    double step_;
    stepped_world world_;
    std::optional<dynamics> dynamics_;  // of the world, once it is known
    motion_state state_;
    motion_rates rates_;
};

}  // namespace aabblab
