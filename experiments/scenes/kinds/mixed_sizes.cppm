module;
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

module aabblab.scenes:mixed_sizes;

import aabb.geometry;
import aabb.policy;
import :boxes;
import :drift;
import :random;
import :sizes;

namespace aabblab {

/// Cubes of very different sizes, evenly spread in the logarithm: as many between 1 and 10 as between 10 and 100.
/// Object i is the i-th in size. The world lies around the origin, where floats are finest.
class mixed_sizes final : public generated_boxes {
public:
    static constexpr std::string_view name = "mixed_sizes";
    static constexpr std::string_view summary =
        "cubes that drift in a cube, their edges evenly spread in the logarithm from 1 to a ratio";

    struct config : motion_config {
        /// Edge of the largest cube over that of the smallest.
        double ratio = 100;
    };
    static constexpr auto parameters = std::tuple_cat(
        motion_parameters, std::tuple{aabb::number_parameter{"ratio", &config::ratio, 1.0, 1e6,
                                                             "edge of the largest cube over that of the smallest"}});

    mixed_sizes(const config& c, std::uint64_t seed)
        : generated_boxes(name, c, seed, drifting_points::bytes_each + sizeof(double)),
          edges_(spread_edges(c.objects, c.ratio)),
          width_(width_around(edges_)),
          centres_(drifting(c)) {}

private:
    /// The width in which each cube overlaps two others on average: cubes of edges a and b overlap where their centres
    /// differ by (a + b) / 2 at most on every axis, and (a + b)^3 is 2 a^3 + 6 a^2 b on average.
    static double width_around(const std::vector<double>& edges) {
        if (edges.empty()) return 0;
        const auto count = static_cast<double>(edges.size());
        double first = 0, second = 0, third = 0;
        for (const double e : edges) {
            first += e / count;
            second += e * e / count;
            third += e * e * e / count;
        }
        return cube_root(count * (2 * third + 6 * second * first) / 2);
    }

    drifting_points drifting(const config& c) {
        double sum = 0;
        for (const double e : edges_) sum += e;
        const double side = width_ + c.ratio;
        const double step = step_of(c, sum / std::max(c.objects, 1U), {side, side, side});
        return {c.objects, 3, width_, {step, step}, random_};
    }

    void advance() override { centres_.advance(random_); }

    void place(std::span<aabb::box> boxes) override {
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const double shift = -(width_ + edges_[i]) / 2;
            boxes[i] = cube_at(centres_[i] + aabb::vec3d{shift, shift, shift}, edges_[i]);
        }
    }

    std::vector<double> edges_;
    double width_;
    drifting_points centres_;
};

}  // namespace aabblab
