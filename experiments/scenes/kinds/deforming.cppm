module;
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

module aabblab.scenes:deforming;

import aabb.geometry;
import aabb.pipeline;
import aabb.policy;
import :circle;
import :random;
import :rotation;

namespace aabblab {

/// Two meshes that overlap: the first is rigid and turns, through the second a wave runs, so that every vertex of it
/// moves in every frame and its tree must be fitted anew. Rotations, offset and wave come from the seed.
class deforming final : public aabb::mesh_scene {
public:
    static constexpr std::string_view name = "deforming";
    static constexpr std::string_view summary = "a rigid mesh turns in another, through which a wave runs";
    static constexpr std::array<std::string_view, 2> default_meshes = {"torus_knot", "noise_sphere"};
    static constexpr std::size_t most_meshes = 2;

    struct config {
        std::uint32_t frames = 20;
        /// Between the centres, over the mean of the boxes' longest extents.
        double distance = 0.3;
        /// Of the wave, over the longest extent of the mesh that it runs through.
        double amplitude = 0.05;
        scaling normalise = scaling::yes;
    };
    static constexpr std::tuple parameters{
        aabb::integer_parameter{"frames", &config::frames, 0U, 0x7ffffffeU, "frames after the first one"},
        aabb::number_parameter{"distance", &config::distance, 0.0, 1e6,
                               "between the meshes' centres, over their mean extent"},
        aabb::number_parameter{"amplitude", &config::amplitude, 0.0, 1e6,
                               "of the wave, over the extent of the mesh that it runs through"},
        aabb::choice_parameter{"normalise", &config::normalise, std::array<std::string_view, 2>{"yes", "no"},
                               "scale each mesh to a longest extent of 1"}};

    deforming(const config& c, std::vector<aabb::mesh> given, std::uint64_t seed) : frames_(std::size_t{c.frames} + 1) {
        meshes = std::move(given);
        // Alone, a mesh meets a copy of itself.
        if (meshes.size() == 1) meshes.push_back(meshes.front());
        if (c.normalise == scaling::yes)
            for (aabb::mesh& m : meshes) normalise(m);
        mesh_of = {0, 1};
        const aabb::box rigid = aabb::bounds_of(meshes[0]);
        const aabb::box waving = aabb::bounds_of(meshes[1]);
        extent_ = longest_extent(waving);
        amplitude_ = c.amplitude * extent_;
        random_source random(seed);
        rotation_ = random_rotation(random);
        turn_ = turn(random.direction(), 0.1);
        centre_ = centre_of(rigid);
        place_ = random.direction();
        for (double& coordinate : place_.at) coordinate *= c.distance * (longest_extent(rigid) + extent_) / 2;
        standing_ = placed(centre_of(waving), random_rotation(random), {0, 0, 0});
        along_ = random.direction();
        push_ = random.direction();
        rest_ = meshes[1].vertices;
    }

    [[nodiscard]] std::size_t frames() const override { return frames_; }
    [[nodiscard]] bool deforms(std::uint32_t mesh) const override { return mesh == 1; }

    bool next(std::vector<aabb::pose>& poses) override {
        if (frame_ == frames_) return false;
        if (frame_ > 0) rotation_ = composed(turn_, rotation_);
        wave(static_cast<double>(frame_) / 20);
        ++frame_;
        poses = {placed(centre_, rotation_, place_), standing_};
        return true;
    }

private:
    /// Two periods over the mesh's extent, after so many periods in time.
    void wave(double time) {
        for (std::size_t v = 0; v < rest_.size(); ++v) {
            const aabb::vec3d at{rest_[v][0], rest_[v][1], rest_[v][2]};
            const double by = amplitude_ * on_circle(2 * aabb::dot(along_, at) / extent_ + time).sin;
            for (int k = 0; k < 3; ++k) meshes[1].vertices[v][k] = static_cast<float>(at[k] + by * push_[k]);
        }
    }

    std::size_t frames_;
    std::size_t frame_ = 0;
    quaternion rotation_{};
    quaternion turn_{};
    aabb::vec3d centre_{};
    aabb::vec3d place_{};
    aabb::pose standing_;
    double extent_ = 0;
    double amplitude_ = 0;
    aabb::vec3d along_{};
    aabb::vec3d push_{};
    std::vector<aabb::vec3f> rest_;
};

}  // namespace aabblab
