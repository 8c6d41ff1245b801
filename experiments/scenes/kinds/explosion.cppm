module;
#include <Eigen/Core>

module aabblab.scenes:explosion;

import :boxes;

namespace aabblab {

/// Unit cubes that fill a cube of their total volume, overlap about eight others each, and creep outwards; after a
/// third of the frames they fly, and in the last third they rest. Each third favours other strategies.
class explosion final : public generated_boxes {
public:
    static constexpr std::string_view name = "explosion";
    static constexpr std::string_view summary =
        "unit cubes heaped in a cube that creep outwards, then fly apart, then rest, a third of the frames each";

    struct config : scene_size {
        double displacement = 0.5;
    };
    static constexpr auto parameters =
        std::tuple_cat(size_parameters<config>("how many boxes"),
                       std::tuple{aabb::number_parameter{"displacement", &config::displacement, 0.0, 1e9,
                                                         "displacement of a flying cube per frame, in edges"}});

    /// Places unit cubes at random in a cube of their total volume around the origin, from which they will fly.
    explosion(const config& c, std::uint64_t seed)
        : generated_boxes(name, c, seed, sizeof(flying_box)), flight_step_(c.displacement) {
        const double side = cube_root(c.objects);
        boxes_.resize(c.objects);
        for (flying_box& b : boxes_) {
            for (double& x : b.corner) x = side * random_.signed_unit() / 2;
            const double away = length_of(b.corner);
            b.direction = random_.direction();  // kept only by a cube exactly at the centre
            if (away > 0) b.direction = b.corner / away;
        }
    }

private:
    struct flying_box {
        Eigen::Vector3d corner;
        Eigen::Vector3d direction;
    };

    void advance() override {
        const std::size_t last = frames() - 1;
        const double step = 3 * frame() <= last ? flight_step_ / 100 : 3 * frame() <= 2 * last ? flight_step_ : 0;
        for (flying_box& b : boxes_) b.corner += b.direction * step;
    }

    void place(std::span<aabb::box> boxes) override {
        for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = cube_at(boxes_[i].corner, 1);
    }

    double flight_step_;
    std::vector<flying_box> boxes_;
};

}  // namespace aabblab
