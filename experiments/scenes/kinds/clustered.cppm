module;
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

module aabblab.scenes:clustered;

import aabb.geometry;
import aabb.policy;
import :boxes;
import :drift;
import :random;

namespace aabblab {

/// Unit cubes in tight clusters far apart; object i drifts in cluster i modulo their number. Each cluster is a cube at
/// a random place in the middle of a cell of its own, eight times as wide.
class clustered final : public generated_boxes {
public:
    static constexpr std::string_view name = "clustered";
    static constexpr std::string_view summary =
        "unit cubes in tight clusters far apart, each drifting about its cluster's centre; most of the world is empty";

    struct config : motion_config {
        std::uint32_t clusters = 10;
    };
    static constexpr auto parameters = std::tuple_cat(
        motion_parameters,
        std::tuple{aabb::integer_parameter{"clusters", &config::clusters, 1U, 1'000'000U, "how many clusters"}});

    clustered(const config& c, std::uint64_t seed)
        : generated_boxes(name, c, seed, drifting_points::bytes_each),
          width_(width_for((c.objects + c.clusters - 1) / c.clusters, 3)),
          corners_(cluster_corners(c.clusters)),
          points_(drifting(c)) {}

private:
    /// Takes cells of the smallest lattice that has enough of them, every choice of cells equally likely.
    std::vector<aabb::vec3d> cluster_corners(std::uint32_t wanted) {
        std::uint32_t side = 1;
        while (side * side * side < wanted) ++side;
        std::vector<aabb::vec3d> corners;
        corners.reserve(wanted);
        for (std::uint32_t cell = 0, cells = side * side * side; corners.size() < wanted; ++cell) {
            if (random_.below(cells - cell) >= wanted - corners.size()) continue;
            const std::uint32_t at[3] = {cell / (side * side), cell / side % side, cell % side};
            aabb::vec3d corner{};
            for (int k = 0; k < 3; ++k) corner[k] = (width_ + 1) * (8 * at[k] + 2 + 3 * random_.unit());
            corners.push_back(corner);
        }
        return corners;
    }

    /// The world is what the clusters span.
    drifting_points drifting(const config& c) {
        aabb::vec3d sides{};
        for (int k = 0; k < 3; ++k) {
            const auto [least, most] = std::ranges::minmax(corners_, {}, [k](const aabb::vec3d& p) { return p[k]; });
            sides[k] = most[k] - least[k] + width_ + 1;
        }
        const double step = step_of(c, 1, sides);
        return {c.objects, 3, width_, {step, step}, random_};
    }

    void advance() override { points_.advance(random_); }

    void place(std::span<aabb::box> boxes) override {
        for (std::size_t i = 0; i < boxes.size(); ++i)
            boxes[i] = cube_at(corners_[i % corners_.size()] + points_[i], 1);
    }

    double width_;
    std::vector<aabb::vec3d> corners_;  // by cluster
    drifting_points points_;            // within their cluster
};

}  // namespace aabblab
