module;
#include <Eigen/Geometry>

module aabblab.scenes:deforming;

import :circle;
import :posed_meshes;

namespace aabblab {

/// Two overlapping meshes: the first is rigid and rotates; a wave runs through the second, so that all of its vertices
/// move in every frame and its tree must be refitted. Rotations, offset and wave depend on the seed.
class deforming final : public generated_meshes {
public:
    static constexpr std::string_view name = "deforming";
    static constexpr std::string_view summary = "a rigid mesh rotates inside another one, which a wave deforms";
    static constexpr std::array<std::string_view, 2> default_meshes = {"torus_knot", "noise_sphere"};
    static constexpr std::size_t most_meshes = 2;

    struct config {
        std::uint32_t frames = 20;
        double distance = 0.3;
        double amplitude = 0.05;
        scaling normalise = scaling::yes;
    };
    static constexpr std::tuple parameters{
        frames_parameter<config>(),
        aabb::number_parameter{"distance", &config::distance, 0.0, 1e6,
                               "between the centres of the meshes, over their mean extent"},
        aabb::number_parameter{"amplitude", &config::amplitude, 0.0, 1e6,
                               "of the wave, over the extent of the mesh that it deforms"},
        normalise_parameter<config>("scale each mesh to a longest extent of 1")};

    /// Chooses at random both rotations, the place of the rigid mesh beside the waving one, and the wave's directions.
    deforming(const config& c, std::vector<aabb::mesh> models, std::uint64_t seed)
        : generated_meshes(c.frames, std::move(models), c.normalise) {
        // A single mesh is paired with a copy of itself.
        if (meshes.size() == 1) meshes.push_back(meshes.front());
        mesh_of = {0, 1};
        // The wave moves vertices in float, so double coordinates of a file are dropped.
        set_floats(meshes[1], [](const Eigen::Vector3d& v) { return v; });
        waving_extent_ = longest_extent(meshes[1]);
        amplitude_ = c.amplitude * waving_extent_;
        random_source random(seed);
        rigid_rotation_ = random_rotation(random);
        rotation_per_frame_ = turn(random.direction(), /*angle=*/0.1);
        rigid_centre_ = centre_of(meshes[0]);
        rigid_place_ = random.direction() * (c.distance * (longest_extent(meshes[0]) + waving_extent_) / 2);
        waving_pose_ = placed(centre_of(meshes[1]), random_rotation(random), Eigen::Vector3d::Zero());
        wave_direction_ = random.direction();
        offset_direction_ = random.direction();
        rest_vertices_ = meshes[1].vertices;
    }

    [[nodiscard]] bool deforms(std::uint32_t mesh) const override { return mesh == 1; }

private:
    void advance() override { rigid_rotation_ = composed(rotation_per_frame_, rigid_rotation_); }

    void place(std::size_t frame, std::vector<aabb::pose>& poses) override {
        wave(static_cast<double>(frame) / 20);
        poses = {placed(rigid_centre_, rigid_rotation_, rigid_place_), waving_pose_};
    }

    /// Applies a wave of two periods over the extent of the mesh; time is in periods.
    void wave(double time) {
        for (std::size_t v = 0; v < rest_vertices_.size(); ++v) {
            const Eigen::Vector3d at = in_eigen(rest_vertices_[v]);
            const double offset = amplitude_ * on_circle(2 * dot(wave_direction_, at) / waving_extent_ + time).sin;
            meshes[1].vertices[v] = in_float(at + offset_direction_ * offset);
        }
    }

    Eigen::Quaterniond rigid_rotation_;
    Eigen::Quaterniond rotation_per_frame_;
    Eigen::Vector3d rigid_centre_;
    Eigen::Vector3d rigid_place_;
    aabb::pose waving_pose_;
    double waving_extent_ = 0;
    double amplitude_ = 0;
    Eigen::Vector3d wave_direction_;
    Eigen::Vector3d offset_direction_;
    std::vector<aabb::vec3f> rest_vertices_;
};

}  // namespace aabblab
