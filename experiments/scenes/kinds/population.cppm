module;
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

module aabblab.scenes:population;

import aabb.geometry;
import aabb.policy;
import :boxes;
import :drift;
import :random;

namespace aabblab {

/// Unit cubes that come and go, whoever is there drifting. Those that are absent are points on a lattice below the
/// world, as far from one another as objects are in it, so that ignoring absence costs what it should.
class population final : public generated_boxes {
public:
    static constexpr std::string_view name = "population";
    static constexpr std::string_view summary =
        "unit cubes that drift in a cube and come and go: about half of them are there at a time";

    struct config : motion_config {
        /// Objects that come or go in a frame, over all objects.
        double turnover = 0.05;
    };
    static constexpr auto parameters = std::tuple_cat(
        motion_parameters, std::tuple{aabb::number_parameter{"turnover", &config::turnover, 0.0, 1.0,
                                                             "share of the objects that come or go in a frame"}});

    population(const config& c, std::uint64_t seed)
        : generated_boxes(name, c, seed, drifting_points::bytes_each + 1),
          turnover_(c.turnover),
          corners_(drifting_corners(c, 3, random_)),
          present_(c.objects) {
        for (std::size_t i = 0; i < present_.size(); i += 2) present_[i] = 1;
        while (places_ * places_ * places_ < present_.size()) ++places_;
        gap_ = width_for(c.objects, 3) / static_cast<double>(places_);
    }

    [[nodiscard]] std::span<const std::uint8_t> present() const override { return present_; }

private:
    void advance() override {
        corners_.advance(random_);
        for (std::uint8_t& p : present_)
            if (random_.unit() < turnover_) p = p == 0;
    }

    void place(std::span<aabb::box> boxes) override {
        for (std::size_t i = 0; i < boxes.size(); ++i)
            boxes[i] = present_[i] ? cube_at(corners_[i], 1) : cube_at(parking_place(i), 0);
    }

    [[nodiscard]] aabb::vec3d parking_place(std::size_t i) const {
        const std::size_t row = i / places_, layer = row / places_;
        return {gap_ * static_cast<double>(i % places_), gap_ * static_cast<double>(row % places_),
                -1 - gap_ * static_cast<double>(layer)};
    }

    double turnover_;
    drifting_points corners_;
    std::vector<std::uint8_t> present_;
    std::size_t places_ = 1;  // of the lattice, along each axis
    double gap_;
};

}  // namespace aabblab
