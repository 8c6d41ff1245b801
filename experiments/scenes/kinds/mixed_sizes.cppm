module;
#include <Eigen/Core>

module aabblab.scenes:mixed_sizes;

import :boxes;

namespace aabblab {

/// The width of the cube in which the centres of cubes with these edges lie if each overlaps two others on average.
/// Cubes of edges a and b overlap if their centres differ by (a + b) / 2 at most on every axis, so the centre of the
/// other lies in a volume of (a + b)^3, which is 2 a^3 + 6 a^2 b on average over all pairs.
[[nodiscard]] inline double width_for(const std::vector<double>& edges) {
    if (edges.empty()) return 0;
    const auto count = static_cast<double>(edges.size());
    double mean_edge = 0, mean_square = 0, mean_cube = 0;
    for (const double e : edges) {
        mean_edge += e / count;
        mean_square += e * e / count;
        mean_cube += e * e * e / count;
    }
    return cube_root(count * (2 * mean_cube + 6 * mean_square * mean_edge) / 2);
}

/// Cubes of very different sizes in geometric progression: equally many between 1 and 10 and between 10 and 100. Object
/// i is the i-th in size. The world is centred at the origin, where floats have the best resolution.
class mixed_sizes final : public drifting_boxes {
public:
    static constexpr std::string_view name = "mixed_sizes";
    static constexpr std::string_view summary =
        "cubes that drift in a cube, with edges in geometric progression from 1 to a ratio";

    struct config : motion_config {
        double ratio = 100;
    };
    static constexpr auto parameters = std::tuple_cat(
        motion_parameters, std::tuple{aabb::number_parameter{"ratio", &config::ratio, 1.0, 1e6,
                                                             "edge of the largest cube over that of the smallest"}});

    /// Lets the cubes drift in a world in which each overlaps two others on average.
    mixed_sizes(const config& c, std::uint64_t seed)
        : drifting_boxes(name, c, seed, sizeof(double)),
          edges_(spread_edges(c.objects, c.ratio)),
          width_(width_for(edges_)) {
        const double mean_edge = std::accumulate(edges_.begin(), edges_.end(), 0.0) / std::max(c.objects, 1U);
        drift(c, width_, mean_edge, /*side=*/width_ + c.ratio);
    }

private:
    [[nodiscard]] aabb::box box_at(const Eigen::Vector3d& centre, std::size_t i) const override {
        return cube_at(centre + Eigen::Vector3d::Constant(-(width_ + edges_[i]) / 2), edges_[i]);
    }

    std::vector<double> edges_;
    double width_;
};

}  // namespace aabblab
