module;
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>

module aabblab.scenes:needles;

import aabb.geometry;
import aabb.policy;
import :boxes;
import :drift;
import :random;

namespace aabblab {

/// Boxes that are long on one axis and thin on the other two; object i is long on axis i modulo 3. Cells and segments
/// that fit one axis of a needle do not fit the others.
class needles final : public generated_boxes {
public:
    static constexpr std::string_view name = "needles";
    static constexpr std::string_view summary =
        "thin boxes that drift in a cube, a third of them long on each axis, so that no cell fits them";

    struct config : motion_config {
        double length = 20;
    };
    static constexpr auto parameters = std::tuple_cat(
        motion_parameters, std::tuple{aabb::number_parameter{"length", &config::length, 1.0, 1e6,
                                                             "long edge of a needle; its other edges are 1"}});

    needles(const config& c, std::uint64_t seed)
        : generated_boxes(name, c, seed, drifting_points::bytes_each),
          length_(c.length),
          width_(width_around(c)),
          centres_(drifting(c)) {}

private:
    /// The width in which each needle overlaps two others on average: the centres of two differ on every axis by half
    /// the sum of their edges at most, in a volume of 8 l where they are long on one axis, of 2 (l + 1)^2 where not.
    static double width_around(const config& c) {
        const double volume = (8 * c.length + 4 * (c.length + 1) * (c.length + 1)) / 3;
        return cube_root(c.objects * volume / 2);
    }

    drifting_points drifting(const config& c) {
        const double side = width_ + c.length;
        const double step = step_of(c, (c.length + 2) / 3, {side, side, side});
        return {c.objects, 3, width_, {step, step}, random_};
    }

    void advance() override { centres_.advance(random_); }

    void place(std::span<aabb::box> boxes) override {
        for (std::size_t i = 0; i < boxes.size(); ++i)
            for (int k = 0; k < 3; ++k) {
                const double reach = (i % 3 == static_cast<std::size_t>(k) ? length_ : 1) / 2;
                boxes[i].min[k] = static_cast<float>(centres_[i][k] - reach);
                boxes[i].max[k] = static_cast<float>(centres_[i][k] + reach);
            }
    }

    double length_;
    double width_;
    drifting_points centres_;
};

}  // namespace aabblab
