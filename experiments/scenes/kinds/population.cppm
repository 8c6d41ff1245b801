module;
#include <Eigen/Core>

module aabblab.scenes:population;

import :boxes;

namespace aabblab {

/// Drifting unit cubes that appear and disappear. Absent ones are points on a lattice below the world with the mean
/// spacing of objects, so that a strategy that ignores absence has a realistic cost.
class population final : public drifting_boxes {
public:
    static constexpr std::string_view name = "population";
    static constexpr std::string_view summary =
        "unit cubes that drift in a cube, appear and disappear; about half of them are present at a time";

    struct config : motion_config {
        double turnover = 0.05;
    };
    static constexpr auto parameters =
        std::tuple_cat(motion_parameters,
                       std::tuple{aabb::number_parameter{"turnover", &config::turnover, 0.0, 1.0,
                                                         "share of the objects that appear or disappear per frame"}});

    population(const config& c, std::uint64_t seed)
        : drifting_boxes(name, c, seed, 1),
          turnover_(c.turnover),
          present_(c.objects),
          places_(lattice_side(c.objects)),
          gap_(width_for(c.objects, 3) / places_) {
        drift(c);
        for (std::size_t i = 0; i < present_.size(); i += 2) present_[i] = 1;
    }

    [[nodiscard]] std::span<const std::uint8_t> present() const override { return present_; }

private:
    void advance() override {
        drifting_boxes::advance();
        for (std::uint8_t& p : present_)
            if (random_.unit() < turnover_) p = p == 0;
    }

    [[nodiscard]] aabb::box box_at(const Eigen::Vector3d& point, std::size_t i) const override {
        if (present_[i]) return cube_at(point, 1);
        const Eigen::Vector3d parked = lattice_cell(i, places_) * gap_;
        return cube_at({parked[2], parked[1], -1 - parked[0]}, 0);
    }

    double turnover_;
    std::vector<std::uint8_t> present_;
    std::uint32_t places_;  // of the lattice, along each axis
    double gap_;
};

}  // namespace aabblab
