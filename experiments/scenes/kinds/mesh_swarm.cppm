module;
#include <Eigen/Geometry>

module aabblab.scenes:mesh_swarm;

import aabblab.files;
import :posed_meshes;

namespace aabblab {

/// Many meshes that drift and rotate in a cube; object i is mesh i modulo the number of meshes. By default, each mesh
/// is scaled to a longest extent of 1, since models have different units. Huge objects come first and use the first
/// mesh; the others alternate between the other meshes, or use the same if there is only one.
class mesh_swarm final : public generated_meshes {
public:
    static constexpr std::string_view name = "mesh_swarm";
    static constexpr std::string_view summary =
        "meshes, each scaled to extent 1, that drift and rotate in a cube with reflecting walls";
    static constexpr std::array<std::string_view, 3> default_meshes = {"icosphere", "torus_knot", "noise_sphere"};
    static constexpr std::size_t most_meshes = std::numeric_limits<std::uint32_t>::max();

    struct config {
        std::uint32_t objects = 200;
        std::uint32_t frames = 20;
        double density = 0.5;
        double displacement = 0.05;
        scaling normalise = scaling::yes;
        std::uint32_t huge = 0;
        double span = 0.5;
    };
    static constexpr auto parameters = std::tuple_cat(
        size_parameters<config>("how many objects"),
        std::tuple{
            aabb::number_parameter{"density", &config::density, 1e-30, 1e6,
                                   "volume of cubes with the extents of the objects over that of the world"},
            aabb::number_parameter{
                "displacement", &config::displacement, 0.0, 1e6,
                "greatest displacement of an object per frame, in mean extents, and greatest rotation, in radians"},
            normalise_parameter<config>("scale each mesh to a longest extent of 1"),
            aabb::integer_parameter{"huge", &config::huge, 0U, 0x7fffffffU, "how many objects are huge"},
            aabb::number_parameter{"span", &config::span, 0.0, 1.0,
                                   "longest extent of a huge object over the side of the world"}});

    /// The density gives the world's side: the volume of the objects not huge, as cubes of their extents, over that of
    /// the world. The huge mesh is scaled to `span` of the side. Points, steps and rotations are random.
    mesh_swarm(const config& c, std::vector<aabb::mesh> models, std::uint64_t seed)
        : generated_meshes(c.frames, std::move(models), c.normalise), random_(seed) {
        require_memory(
            "a mesh_swarm of " + std::to_string(c.objects) + " objects",
            c.objects * (drifting_points::bytes_each + sizeof(spin) + sizeof(aabb::pose) + sizeof(std::uint32_t)));
        const std::uint32_t huge = std::min(c.huge, c.objects);
        const std::uint32_t others = c.objects - huge;
        const extent_sums sums = assign_meshes(huge, others);
        mean_extent_ = others == 0 ? 0 : sums.extents / others;
        // If all are huge, each counts as a unit cube.
        const double side = cube_root((others == 0 ? huge : sums.volumes) / c.density);
        if (huge > 0) normalise(meshes[0], c.span * side);
        for (const aabb::mesh& m : meshes) centres_.push_back(centre_of(m));
        huge_extent_ = c.span * side;
        const double mean_of_all = c.objects == 0 ? 0 : (sums.extents + huge * huge_extent_) / c.objects;
        const step_range steps = {0, c.displacement * mean_of_all};
        // The space of a centre is the world without half an extent at each wall.
        points_ = {others, /*axes=*/3, side - mean_extent_, steps, random_};
        huge_ = {huge, /*axes=*/3, side - huge_extent_, steps, random_};
        spins_.reserve(c.objects);
        for (std::uint32_t i = 0; i < c.objects; ++i) {
            const Eigen::Quaterniond rotation = random_rotation(random_);
            const Eigen::Vector3d axis = random_.direction();
            spins_.push_back({rotation, turn(axis, random_.unit() * c.displacement)});
        }
    }

private:
    /// Sums over the objects that are not huge.
    struct extent_sums {
        double extents = 0;
        double volumes = 0;  ///< of cubes with the extents
    };

    /// Sets the meshes: the huge objects, which come first, have mesh 0; the others alternate between the other meshes,
    /// also mesh 0 if none is huge, or have a copy of mesh 0 if there is no other.
    extent_sums assign_meshes(std::uint32_t huge, std::uint32_t others) {
        const std::uint32_t first_other_mesh = huge > 0 ? 1 : 0;
        if (meshes.size() == first_other_mesh) meshes.push_back(meshes[0]);
        std::vector<double> extents;
        for (const aabb::mesh& m : meshes) extents.push_back(longest_extent(m));
        mesh_of.assign(huge, 0);
        extent_sums sums;
        for (std::uint32_t i = 0; i < others; ++i) {
            mesh_of.push_back(first_other_mesh + static_cast<std::uint32_t>(i % (meshes.size() - first_other_mesh)));
            const double extent = extents[mesh_of.back()];
            sums.extents += extent;
            sums.volumes += extent * extent * extent;
        }
        return sums;
    }

    void advance() override {
        points_.advance(random_);
        huge_.advance(random_);
        for (spin& s : spins_) s.rotation = composed(s.rotation_per_frame, s.rotation);
    }

    /// Rotates each object about the centre of its mesh, and moves it to its point.
    void place(std::size_t, std::vector<aabb::pose>& poses) override {
        poses.resize(spins_.size());
        for (std::size_t i = 0; i < poses.size(); ++i) {
            // The world begins at the origin, and centres keep half an extent from its walls.
            const bool is_huge = i < huge_.size();
            const Eigen::Vector3d& point = is_huge ? huge_[i] : points_[i - huge_.size()];
            const double margin = (is_huge ? huge_extent_ : mean_extent_) / 2;
            poses[i] = placed(centres_[mesh_of[i]], spins_[i].rotation, point + Eigen::Vector3d::Constant(margin));
        }
    }

    struct spin {
        Eigen::Quaterniond rotation;
        Eigen::Quaterniond rotation_per_frame;
    };

    random_source random_;
    double mean_extent_ = 0;  // of objects that are not huge
    double huge_extent_ = 0;
    std::vector<Eigen::Vector3d> centres_;  // by mesh
    drifting_points points_;
    drifting_points huge_;
    std::vector<spin> spins_;
};

}  // namespace aabblab
