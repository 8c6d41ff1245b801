module;
#include <Eigen/Core>

module aabblab.scenes:needles;

import :boxes;

namespace aabblab {

/// Boxes that are thin on two axes; object i is long on axis i modulo 3. No cell size of a grid fits all axes.
class needles final : public drifting_boxes {
public:
    static constexpr std::string_view name = "needles";
    static constexpr std::string_view summary =
        "thin boxes that drift in a cube, a third of them long on each axis, so that no cell size suits all";

    struct config : motion_config {
        double length = 20;
    };
    static constexpr auto parameters = std::tuple_cat(
        motion_parameters, std::tuple{aabb::number_parameter{"length", &config::length, 1.0, 1e6,
                                                             "long edge of a needle; its other edges are 1"}});

    needles(const config& c, std::uint64_t seed) : drifting_boxes(name, c, seed), length_(c.length) {
        const double width = width_around(c);
        drift(c, width, (c.length + 2) / 3, width + c.length);
    }

private:
    /// The width in which each needle overlaps two others on average: on every axis the centres of an overlapping pair
    /// differ by at most half the sum of the edges: a volume of 8 l for parallel needles, of 2 (l + 1)^2 for others.
    static double width_around(const config& c) {
        const double volume = (8 * c.length + 4 * (c.length + 1) * (c.length + 1)) / 3;
        return cube_root(c.objects * volume / 2);
    }

    /// The box with this centre that is long on axis i modulo 3, and of edge 1 on the others.
    [[nodiscard]] aabb::box box_at(const Eigen::Vector3d& centre, std::size_t i) const override {
        aabb::box b{};
        for (int k = 0; k < 3; ++k) {
            const double half = (i % 3 == static_cast<std::size_t>(k) ? length_ : 1) / 2;
            b.min[k] = static_cast<float>(centre[k] - half);
            b.max[k] = static_cast<float>(centre[k] + half);
        }
        return b;
    }

    double length_;
};

}  // namespace aabblab
