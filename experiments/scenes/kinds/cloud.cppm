module;
#include <Eigen/Core>

module aabblab.scenes:cloud;

import :boxes;

namespace aabblab {

/// Cubes with independent parameters of number, motion, density, sizes and clustering, for maps of the fastest
/// strategies. They drift within clouds of equal width in the cells of a lattice; object i lies in cloud i modulo their
/// number. The first cubes may be parked: they rest in an additional cloud.
class cloud final : public drifting_boxes {
public:
    static constexpr std::string_view name = "cloud";
    static constexpr std::string_view summary =
        "cubes that drift in one cloud or in several distant ones, with independent density, sizes and clustering";

    struct config : motion_config {
        double moving = 1;
        double density = 0.1;
        double ratio = 1;
        std::uint32_t clouds = 1;
        double apart = 4;
        /// The share of parked cubes, which imitate objects that games keep out of sight until they need them.
        double parked = 0;
    };
    static constexpr auto parameters = std::tuple_cat(
        motion_parameters,
        std::tuple{
            aabb::number_parameter{"moving", &config::moving, 0.0, 1.0, "share of the cubes that move", true},
            aabb::number_parameter{"density", &config::density, 1e-9, 1e6,
                                   "volume of the cubes over that of the clouds, which hold their least corners"},
            aabb::number_parameter{"ratio", &config::ratio, 1.0, 1e6,
                                   "edge of the largest cube over that of the smallest", true},
            aabb::integer_parameter{"clouds", &config::clouds, 1U, 1'000'000U, "how many clouds"},
            aabb::number_parameter{"apart", &config::apart, 1.0, 1e6,
                                   "edge of the lattice cell of a cloud over that of the cloud", true},
            aabb::number_parameter{"parked", &config::parked, 0.0, 1.0,
                                   "share of the cubes that rest in a cloud of their own", true}});

    /// Places the clouds, whose width follows from the density: the volume of all cubes over that of all clouds. The
    /// first cubes rest; of them, the first `parked_` rest in an additional cloud, the last one.
    cloud(const config& c, std::uint64_t seed)
        : drifting_boxes(name, c, seed, sizeof(double) + sizeof(Eigen::Vector3d)),
          edges_(spread_edges(c.objects, c.ratio)),
          clouds_(c.clouds),
          parked_(static_cast<std::uint32_t>(c.parked * c.objects)) {
        const std::uint32_t clouds = c.clouds + (c.parked > 0 ? 1 : 0);
        double sum_of_edges = 0;
        double volume = 0;
        for (const double e : edges_) {
            sum_of_edges += e;
            volume += e * e * e;
        }
        const double width = cube_root(volume / c.density / clouds);
        place_clouds(clouds, width, width * c.apart);
        const double mean_edge = sum_of_edges / std::max(c.objects, 1U);
        // A displacement in spacings refers to the spacing within clouds, so the gaps between clouds do not count.
        const double side_without_gaps = width * cube_root(clouds);
        drift(c, width, mean_edge, side_without_gaps);
        const auto resting = std::max(static_cast<std::uint32_t>((1 - c.moving) * c.objects), parked_);
        for (std::uint32_t i = 0; i < resting; ++i) resting_.push_back(points_[i]);
        // Shuffled, so that the size of an object does not depend on its index.
        for (std::size_t i = edges_.size(); i > 1; --i)
            std::swap(edges_[i - 1], edges_[random_.below(static_cast<std::uint32_t>(i))]);
    }

private:
    /// Places each cloud at a random position in its cell of the smallest sufficient lattice.
    void place_clouds(std::uint32_t clouds, double width, double cell) {
        const std::uint32_t side = lattice_side(clouds);
        for (std::uint32_t i = 0; i < clouds; ++i)
            corners_.emplace_back(lattice_cell(i, side) * cell + random_.point(cell - width));
    }

    [[nodiscard]] aabb::box box_at(const Eigen::Vector3d& point, std::size_t i) const override {
        const Eigen::Vector3d& corner = corners_[i < parked_ ? clouds_ : i % clouds_];
        return cube_at(corner + (i < resting_.size() ? resting_[i] : point), edges_[i]);
    }

    std::vector<double> edges_;
    std::uint32_t clouds_;                  // of cubes that are not parked
    std::uint32_t parked_;                  // the first objects
    std::vector<Eigen::Vector3d> corners_;  // by cloud
    std::vector<Eigen::Vector3d> resting_;  // of the first objects, in their cloud
};

}  // namespace aabblab
