module;
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

module aabblab.scenes:mesh_pair;

import aabb.geometry;
import aabb.pipeline;
import aabb.policy;
import :random;
import :rotation;

namespace aabblab {

/// Two meshes: the first stands still with its centre at the origin; the second passes through it on a straight line,
/// turning about its own centre. Line, axis and first rotation come from the seed. With distance and turn 0 it
/// stands still.
class mesh_pair final : public aabb::mesh_scene {
public:
    static constexpr std::string_view name = "mesh_pair";
    static constexpr std::string_view summary = "one mesh stands, another passes through it and turns";
    static constexpr std::array<std::string_view, 2> default_meshes = {"torus_knot", "noise_sphere"};
    static constexpr std::size_t most_meshes = 2;

    struct config {
        std::uint32_t frames = 20;
        /// Between the centres in the first and the last frame, over the mean of the boxes' longest extents.
        double distance = 0.5;
        /// Of the second mesh a frame, in radians (small ones; at most half a turn).
        double turn = 0.1;
        scaling normalise = scaling::yes;
    };
    static constexpr std::tuple parameters{
        aabb::integer_parameter{"frames", &config::frames, 0U, 0x7ffffffeU, "frames after the first one"},
        aabb::number_parameter{"distance", &config::distance, 0.0, 1e6,
                               "of the centres at both ends of the path, over the meshes' mean extent", true},
        aabb::number_parameter{"turn", &config::turn, 0.0, 1e6, "of the second mesh in a frame, in radians", true},
        aabb::choice_parameter{"normalise", &config::normalise, std::array<std::string_view, 2>{"yes", "no"},
                               "scale each mesh to a longest extent of 1"}};

    mesh_pair(const config& c, std::vector<aabb::mesh> given, std::uint64_t seed) : frames_(std::size_t{c.frames} + 1) {
        meshes = std::move(given);
        if (c.normalise == scaling::yes)
            for (aabb::mesh& m : meshes) normalise(m);
        mesh_of = {0, static_cast<std::uint32_t>(meshes.size() - 1)};
        const aabb::box first = aabb::bounds_of(meshes.front());
        const aabb::box second = aabb::bounds_of(meshes.back());
        standing_ = placed(centre_of(first), {1, 0, 0, 0}, {0, 0, 0});
        centre_ = centre_of(second);
        random_source random(seed);
        rotation_ = random_rotation(random);
        turns_ = c.turn > 0;
        turn_ = turn(random.direction(), c.turn);
        start_ = random.direction();
        const double distance = c.distance * (longest_extent(first) + longest_extent(second)) / 2;
        for (double& coordinate : start_.at) coordinate *= distance;
    }

    [[nodiscard]] std::size_t frames() const override { return frames_; }

    bool next(std::vector<aabb::pose>& poses) override {
        if (frame_ == frames_) return false;
        if (frame_ > 0 && turns_) rotation_ = composed(turn_, rotation_);
        // From the start, through the origin, to its mirror image.
        const double left = frames_ > 1 ? 1 - 2 * static_cast<double>(frame_) / static_cast<double>(frames_ - 1) : 1;
        ++frame_;
        poses = {standing_, placed(centre_, rotation_, {left * start_[0], left * start_[1], left * start_[2]})};
        return true;
    }

private:
    std::size_t frames_;
    std::size_t frame_ = 0;
    aabb::pose standing_;
    aabb::vec3d centre_{};
    aabb::vec3d start_{};
    quaternion rotation_{};
    bool turns_ = true;
    quaternion turn_{};
};

}  // namespace aabblab
