module;
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

module aabblab.scenes:mesh_swarm;

import aabb.geometry;
import aabb.pipeline;
import aabb.policy;
import aabblab.files;
import :drift;
import :random;
import :rotation;

namespace aabblab {

/// Many meshes that drift and turn in a cube; object i is mesh i modulo the number of meshes. Unless told otherwise,
/// each mesh is scaled to a longest extent of 1, since models come in units of their own.
class mesh_swarm final : public aabb::mesh_scene {
public:
    static constexpr std::string_view name = "mesh_swarm";
    static constexpr std::string_view summary =
        "meshes, each scaled to extent 1, that drift and turn in a cube with reflecting walls";
    static constexpr std::array<std::string_view, 3> default_meshes = {"icosphere", "torus_knot", "noise_sphere"};
    static constexpr std::size_t most_meshes = std::numeric_limits<std::uint32_t>::max();

    struct config {
        std::uint32_t objects = 200;
        std::uint32_t frames = 20;
        /// Volume of cubes as long as the objects over the volume of the world.
        double density = 0.5;
        /// The longest way of an object in a frame, in mean extents; it turns by up to as many radians.
        double displacement = 0.05;
        scaling normalise = scaling::yes;
    };
    static constexpr std::tuple parameters{
        aabb::integer_parameter{"objects", &config::objects, 0U, 0x7fffffffU, "how many objects"},
        aabb::integer_parameter{"frames", &config::frames, 0U, 0x7ffffffeU, "frames after the first one"},
        aabb::number_parameter{"density", &config::density, 1e-30, 1e6,
                               "volume of cubes as long as the objects over that of the world"},
        aabb::number_parameter{"displacement", &config::displacement, 0.0, 1e6,
                               "the longest way of an object in a frame, in mean extents (and radians it turns)"},
        aabb::choice_parameter{"normalise", &config::normalise, std::array<std::string_view, 2>{"yes", "no"},
                               "scale each mesh to a longest extent of 1"}};

    mesh_swarm(const config& c, std::vector<aabb::mesh> given, std::uint64_t seed)
        : frames_(std::size_t{c.frames} + 1), random_(seed) {
        require_memory(
            "a mesh_swarm of " + std::to_string(c.objects) + " objects",
            c.objects * (drifting_points::bytes_each + sizeof(spin) + sizeof(aabb::pose) + sizeof(std::uint32_t)));
        meshes = std::move(given);
        std::vector<double> extents;
        for (aabb::mesh& m : meshes) {
            if (c.normalise == scaling::yes) normalise(m);
            const aabb::box bounds = aabb::bounds_of(m);
            centres_.push_back(centre_of(bounds));
            extents.push_back(longest_extent(bounds));
        }
        double sum = 0;
        double volume = 0;
        for (std::uint32_t i = 0; i < c.objects; ++i) {
            mesh_of.push_back(static_cast<std::uint32_t>(i % meshes.size()));
            const double extent = extents[mesh_of.back()];
            sum += extent;
            volume += extent * extent * extent;
        }
        extent_ = c.objects == 0 ? 0 : sum / c.objects;
        points_.emplace(c.objects, cube_root(volume / c.density) - extent_, c.displacement * extent_, random_);
        spins_.reserve(c.objects);
        for (std::uint32_t i = 0; i < c.objects; ++i) {
            const quaternion at = random_rotation(random_);
            const aabb::vec3d axis = random_.direction();
            spins_.push_back({at, turn(axis, random_.unit() * c.displacement)});
        }
    }

    [[nodiscard]] std::size_t frames() const override { return frames_; }

    bool next(std::vector<aabb::pose>& poses) override {
        if (frame_ == frames_) return false;
        if (frame_++ > 0) {
            points_->advance(random_);
            for (spin& s : spins_) s.at = composed(s.by, s.at);
        }
        poses.resize(spins_.size());
        for (std::size_t i = 0; i < poses.size(); ++i) {
            // The centre keeps half an extent from the walls of the world, which begins at the origin.
            aabb::vec3d place = (*points_)[i];
            for (double& coordinate : place.at) coordinate += extent_ / 2;
            poses[i] = placed(centres_[mesh_of[i]], spins_[i].at, place);
        }
        return true;
    }

private:
    struct spin {
        quaternion at;
        quaternion by;  // a frame
    };
    std::size_t frames_;
    std::size_t frame_ = 0;
    random_source random_;
    double extent_ = 0;                 // mean, of the objects
    std::vector<aabb::vec3d> centres_;  // by mesh
    std::optional<drifting_points> points_;
    std::vector<spin> spins_;
};

}  // namespace aabblab
