module;
#include <Eigen/Core>

module aabblab.scenes:clustered;

import :boxes;

namespace aabblab {

/// Unit cubes in dense, distant clusters; object i drifts in cluster i modulo their number. Each cluster is a cube at a
/// random position near the middle of its own lattice cell, which is eight times as wide.
class clustered final : public drifting_boxes {
public:
    static constexpr std::string_view name = "clustered";
    static constexpr std::string_view summary =
        "unit cubes in tight clusters far apart, each drifting within its cluster; most of the world is empty";

    struct config : motion_config {
        std::uint32_t clusters = 10;
    };
    static constexpr auto parameters = std::tuple_cat(
        motion_parameters,
        std::tuple{aabb::integer_parameter{"clusters", &config::clusters, 1U, 1'000'000U, "how many clusters"}});

    /// Makes clusters so wide that a cube overlaps two others on average; the world is their bounding box.
    clustered(const config& c, std::uint64_t seed) : drifting_boxes(name, c, seed) {
        // The width in which the corners of unit cubes lie; a cluster is wider by the edge of a cube.
        const double width = width_for((c.objects + c.clusters - 1) / c.clusters, /*axes=*/3);
        place_clusters(c.clusters, width + 1);
        Eigen::Vector3d least = corners_.front();
        Eigen::Vector3d most = corners_.front();
        for (const Eigen::Vector3d& corner : corners_) {
            least = least.cwiseMin(corner);
            most = most.cwiseMax(corner);
        }
        aabb::vec3d sides{};
        for (int k = 0; k < 3; ++k) sides[k] = most[k] - least[k] + width + 1;
        drift(c, width, /*extent=*/1, sides);
    }

private:
    /// Places clusters of this width in random cells of a lattice. A cell is eight clusters wide, and its cluster
    /// begins at 2 to 5 of these 8 on each axis. The loop visits the cells in order and takes one with the probability
    /// clusters left / cells left, so that every choice of cells is equally likely (Knuth, TAOCP 3.4.2, algorithm S).
    void place_clusters(std::uint32_t wanted, double width) {
        const std::uint32_t side = lattice_side(wanted);
        for (std::uint32_t cell = 0, cells = side * side * side; corners_.size() < wanted; ++cell) {
            if (random_.below(cells - cell) >= wanted - corners_.size()) continue;
            const Eigen::Vector3d start = lattice_cell(cell, side) * 8 + Eigen::Vector3d::Constant(2);
            corners_.emplace_back((start + random_.point(1) * 3) * width);
        }
    }

    [[nodiscard]] aabb::box box_at(const Eigen::Vector3d& point, std::size_t i) const override {
        return cube_at(corners_[i % corners_.size()] + point, 1);
    }

    std::vector<Eigen::Vector3d> corners_;  // by cluster
};

}  // namespace aabblab
