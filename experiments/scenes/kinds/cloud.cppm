module;
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

module aabblab.scenes:cloud;

import aabb.geometry;
import aabb.policy;
import :boxes;
import :drift;
import :random;
import :sizes;

namespace aabblab {

/// Cubes whose number, motion, density, sizes and clustering are set one by one, for maps of what serves which scene.
/// They lie in clouds, cubes of equal width in cells of a lattice, and drift each within its own; object i lies in
/// cloud i modulo their number. Parked cubes, the first ones, rest in one more cloud.
class cloud final : public generated_boxes {
public:
    static constexpr std::string_view name = "cloud";
    static constexpr std::string_view summary =
        "cubes that drift in one cloud or in several apart; density, sizes and clustering are set one by one";

    struct config : motion_config {
        /// The others rest.
        double moving = 1;
        double density = 0.1;
        /// Edge of the largest cube over that of the smallest, the others between them as in `mixed_sizes`.
        double ratio = 1;
        std::uint32_t clouds = 1;
        /// Edge of a cell over that of the cloud in it.
        double apart = 4;
        /// Share of the cubes, as games keep them out of sight until they need them.
        double parked = 0;
    };
    static constexpr auto parameters = std::tuple_cat(
        motion_parameters,
        std::tuple{aabb::number_parameter{"moving", &config::moving, 0.0, 1.0, "share of the cubes that move", true},
                   aabb::number_parameter{"density", &config::density, 1e-9, 1e6,
                                          "volume of the cubes over that of the clouds that their corners lie in"},
                   aabb::number_parameter{"ratio", &config::ratio, 1.0, 1e6,
                                          "edge of the largest cube over that of the smallest", true},
                   aabb::integer_parameter{"clouds", &config::clouds, 1U, 1'000'000U, "how many clouds"},
                   aabb::number_parameter{"apart", &config::apart, 1.0, 1e6,
                                          "edge of the cell that a cloud has for itself, over that of the cloud", true},
                   aabb::number_parameter{"parked", &config::parked, 0.0, 1.0,
                                          "share of the cubes that rest in a cloud of their own", true}});

    cloud(const config& c, std::uint64_t seed)
        : generated_boxes(name, c, seed, drifting_points::bytes_each + sizeof(double) + sizeof(aabb::vec3d)),
          edges_(spread_edges(c.objects, c.ratio)),
          clouds_(c.clouds),
          parked_(static_cast<std::uint32_t>(c.parked * c.objects)),
          width_(width_of(c)),
          corners_(cloud_corners(c)),
          points_(drifting(c)) {
        const auto resting = std::max(static_cast<std::uint32_t>((1 - c.moving) * c.objects), parked_);
        for (std::uint32_t i = 0; i < resting; ++i) resting_.push_back(points_[i]);
        // So that an object's number does not tell its size.
        for (std::size_t i = edges_.size(); i > 1; --i)
            std::swap(edges_[i - 1], edges_[random_.below(static_cast<std::uint32_t>(i))]);
    }

private:
    [[nodiscard]] static std::uint32_t clouds_of(const config& c) { return c.clouds + (c.parked > 0 ? 1 : 0); }

    [[nodiscard]] double width_of(const config& c) const {
        double volume = 0;
        for (const double e : edges_) volume += e * e * e;
        return cube_root(volume / c.density / clouds_of(c));
    }

    /// In cells of the smallest lattice that has enough of them, one after the other, each at a random place.
    std::vector<aabb::vec3d> cloud_corners(const config& c) {
        const std::uint32_t clouds = clouds_of(c);
        std::uint32_t side = 1;
        while (std::uint64_t{side} * side * side < clouds) ++side;
        const double cell = width_ * c.apart;
        std::vector<aabb::vec3d> corners;
        corners.reserve(clouds);
        for (std::uint32_t i = 0; i < clouds; ++i) {
            const std::uint32_t at[3] = {i / (side * side), i / side % side, i % side};
            aabb::vec3d corner{};
            for (int k = 0; k < 3; ++k) corner[k] = cell * at[k] + (cell - width_) * random_.unit();
            corners.push_back(corner);
        }
        return corners;
    }

    drifting_points drifting(const config& c) {
        double sum = 0;
        for (const double e : edges_) sum += e;
        const double side = width_ * cube_root(clouds_of(c));
        const double step = step_of(c, sum / std::max(c.objects, 1U), {side, side, side});
        return {c.objects, 3, width_, {step, step}, random_};
    }

    void advance() override { points_.advance(random_); }

    void place(std::span<aabb::box> boxes) override {
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const aabb::vec3d& corner = corners_[i < parked_ ? clouds_ : i % clouds_];
            boxes[i] = cube_at(corner + (i < resting_.size() ? resting_[i] : points_[i]), edges_[i]);
        }
    }

    std::vector<double> edges_;
    std::uint32_t clouds_;              // of those that are not parked
    std::uint32_t parked_;              // the first objects
    double width_;                      // of a cloud
    std::vector<aabb::vec3d> corners_;  // by cloud
    drifting_points points_;            // within their cloud
    std::vector<aabb::vec3d> resting_;  // of the first objects
};

}  // namespace aabblab
