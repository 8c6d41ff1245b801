module;
#include <Eigen/Geometry>

module aabblab.scenes:mesh_pair;

import :posed_meshes;

namespace aabblab {

/// Two meshes: the first rests with its centre at the origin; the second passes through it on a straight line, while it
/// rotates about its own centre. With distance and turn 0 it rests too. Line, axis and rotation depend on the seed.
class mesh_pair final : public generated_meshes {
public:
    static constexpr std::string_view name = "mesh_pair";
    static constexpr std::string_view summary = "one mesh rests; another passes through it and rotates";
    static constexpr std::array<std::string_view, 2> default_meshes = {"torus_knot", "noise_sphere"};
    static constexpr std::size_t most_meshes = 2;

    struct config {
        std::uint32_t frames = 20;
        double distance = 0.5;
        double turn = 0.1;
        scaling normalise = scaling::yes;
    };
    static constexpr std::tuple parameters{
        frames_parameter<config>(),
        aabb::number_parameter{"distance", &config::distance, 0.0, 1e6,
                               "of the centres at both ends of the path, over the mean extent of the meshes", true},
        aabb::number_parameter{"turn", &config::turn, 0.0, 1e6, "of the second mesh per frame, in radians", true},
        normalise_parameter<config>("scale each mesh to a longest extent of 1")};

    /// Chooses the second mesh's path, axis and first rotation at random. A single mesh is paired with itself.
    mesh_pair(const config& c, std::vector<aabb::mesh> models, std::uint64_t seed)
        : generated_meshes(c.frames, std::move(models), c.normalise), is_turning_(c.turn > 0) {
        mesh_of = {0, static_cast<std::uint32_t>(meshes.size() - 1)};
        const aabb::mesh& first = meshes.front();
        const aabb::mesh& second = meshes.back();
        first_pose_ = placed(centre_of(first), Eigen::Quaterniond::Identity(), Eigen::Vector3d::Zero());
        second_centre_ = centre_of(second);
        random_source random(seed);
        second_rotation_ = random_rotation(random);
        rotation_per_frame_ = turn(random.direction(), c.turn);
        path_start_ = random.direction() * (c.distance * (longest_extent(first) + longest_extent(second)) / 2);
    }

private:
    void advance() override {
        if (is_turning_) second_rotation_ = composed(rotation_per_frame_, second_rotation_);
    }

    void place(std::size_t frame, std::vector<aabb::pose>& poses) override {
        // The path leads from the start through the origin to the mirror image of the start.
        const double share = frames() > 1 ? 1 - 2 * static_cast<double>(frame) / static_cast<double>(frames() - 1) : 1;
        poses = {first_pose_, placed(second_centre_, second_rotation_, path_start_ * share)};
    }

    aabb::pose first_pose_;
    Eigen::Vector3d second_centre_;
    Eigen::Vector3d path_start_;
    Eigen::Quaterniond second_rotation_;
    bool is_turning_;
    Eigen::Quaterniond rotation_per_frame_;
};

}  // namespace aabblab
