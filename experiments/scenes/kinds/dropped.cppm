module;
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

module aabblab.scenes:dropped;

import aabb.base;
import aabb.geometry;
import aabb.pipeline;
import aabb.policy;
import aabblab.files;
import aabblab.stepping;
import :dropped_world;
import :rotation;

namespace aabblab {

/// Balls that fall on a floor and on each other, stepped in time by semi-implicit Euler: what is found in one frame
/// moves them to the next. The first mesh is the floor, the second the ball.
class dropped final : public aabb::mesh_scene {
public:
    static constexpr std::string_view name = "dropped";
    static constexpr std::string_view summary =
        "balls dropped on a floor and on each other, pushed apart by the contacts that are found";
    static constexpr std::array<std::string_view, 2> default_meshes = {"square", "icosphere:triangles=80"};
    static constexpr std::size_t most_meshes = 2;

    struct config {
        std::uint32_t balls = 216;
        std::uint32_t frames = 1000;
        double step = 0.001;
        double height = 0.5;
        double speed = 0;
        double depth = 0.001;
        double loss = 0;
        scaling normalise = scaling::yes;
    };
    static constexpr std::tuple parameters{
        aabb::integer_parameter{"balls", &config::balls, 0U, 0x7ffffffeU, "how many balls"},
        aabb::integer_parameter{"frames", &config::frames, 0U, 0x7ffffffeU, "frames after the first one"},
        aabb::number_parameter{"step", &config::step, 0.0, 1e6, "of time from frame to frame, in seconds"},
        aabb::number_parameter{"height", &config::height, 0.0, 1e6, "of the lowest ball above the floor, in extents",
                               true},
        aabb::number_parameter{"speed", &config::speed, 0.0, 1e6, "downwards at the beginning, in m/s", true},
        aabb::number_parameter{"depth", &config::depth, 0.0, 1.0,
                               "to which one ball's weight presses it into the floor, in extents"},
        aabb::number_parameter{"loss", &config::loss, 0.0, 1e6, "damping over the critical one", true},
        aabb::choice_parameter{"normalise", &config::normalise, std::array<std::string_view, 2>{"yes", "no"},
                               "scale the ball to a longest extent of 1"}};

    dropped(const config& c, std::vector<aabb::mesh> given, std::uint64_t seed)
        : frames_(std::size_t{c.frames} + 1), step_(c.step) {
        if (given.size() != 2) throw aabb::input_error("dropped needs two meshes: a floor and a ball");
        require_memory("dropped with " + std::to_string(c.balls) + " balls",
                       c.balls * (sizeof(body) + sizeof(aabb::pose) + 9 * sizeof(double) + sizeof(std::uint32_t)));
        if (c.normalise == scaling::yes) normalise(given[1]);
        world_ = dropped_world({c.balls, c.height, c.speed, c.depth, c.loss}, std::move(given), seed);
        state_ = world_.start();
        acceleration_.resize(state_.position.size());
        meshes = world_.meshes;
        mesh_of = world_.mesh_of();
    }

    [[nodiscard]] std::size_t frames() const override { return frames_; }

    bool next(std::vector<aabb::pose>& poses) override {
        if (frame_ == frames_) return false;
        if (frame_++ > 0)
            for (std::size_t i = 0; i < state_.position.size(); ++i) state_.position[i] += step_ * state_.velocity[i];
        world_.place(state_.position, poses);
        return true;
    }

    [[nodiscard]] bool reacts() const override { return true; }

    void take_contacts(std::span<const aabb::contact> contacts) override {
        dynamics_.accelerate(state_.position, state_.velocity, contacts, acceleration_);
        // The first frame is where they begin; the first step is with the velocity there.
        if (frame_ == 1) return;
        for (std::size_t i = 0; i < state_.velocity.size(); ++i) state_.velocity[i] += step_ * acceleration_[i];
    }

private:
    std::size_t frames_;
    std::size_t frame_ = 0;
    double step_;
    stepped_world world_;
    dynamics dynamics_{world_};
    motion_state state_;
    std::vector<double> acceleration_;
};

}  // namespace aabblab
