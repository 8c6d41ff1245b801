module;
#include <Eigen/Core>

module aabblab.scenes:free_fall;

import :boxes;

namespace aabblab {

/// Unit cubes that are released at rest above a floor, fall along z, lose half their speed at each bounce, and pass
/// through each other. The world is ten edges high and so wide that each cube overlaps four others on the floor.
class free_fall final : public generated_boxes {
public:
    static constexpr std::string_view name = "free_fall";
    static constexpr std::string_view summary =
        "unit cubes released above a floor, which fall along z, bounce with losses and gather at the floor";

    /// The displacement is that of a box from the greatest height in the frame of its first impact.
    struct config : motion_config {
        config() {
            frames = 60;
            displacement = 1;
        }
    };
    static constexpr auto parameters = motion_parameters_with("greatest displacement of a box per frame");

    /// Places boxes at random above a square floor with an area of 1 per box. Gravity g follows from the speed v at
    /// which a box from the greatest height h hits the floor, the displacement per frame: v² = 2 g h.
    free_fall(const config& c, std::uint64_t seed) : generated_boxes(name, c, seed, sizeof(falling_box)) {
        const double width = std::sqrt(c.objects);
        const double fastest = step_of(c, 1, {width + 1, width + 1, height + 1});
        gravity_ = fastest * fastest / (2 * height);
        boxes_.resize(c.objects);
        for (falling_box& b : boxes_)
            b.corner = {random_.unit() * width, random_.unit() * width, random_.unit() * height};
    }

private:
    struct falling_box {
        Eigen::Vector3d corner;
        double speed = 0;  // upwards, per frame
    };
    static constexpr double height = 10;
    static constexpr double kept = 0.5;  // share of the speed after a bounce

    void advance() override {
        for (falling_box& b : boxes_) fall(b);
    }

    /// Moves a box freely for a frame: z += v - g/2, v -= g. If it hits the floor, it bounces and rises for the rest.
    void fall(falling_box& b) const {
        double& z = b.corner[2];
        const double next = z + b.speed - gravity_ / 2;
        if (next >= 0) {
            z = next;
            b.speed -= gravity_;
            return;
        }
        // The speed v falls from its value to -impact, by g per frame; conservation of energy gives the impact.
        const double impact = std::sqrt(b.speed * b.speed + 2 * gravity_ * z);
        const double remaining = 1 - (b.speed + impact) / gravity_;
        const double bounced = kept * impact;  // upwards
        if (2 * bounced < gravity_) {
            // A box that would return within a frame comes to rest.
            z = b.speed = 0;
        } else {
            z = remaining * (bounced - gravity_ * remaining / 2);
            b.speed = bounced - gravity_ * remaining;
        }
    }

    void place(std::span<aabb::box> boxes) override {
        for (std::size_t i = 0; i < boxes.size(); ++i) boxes[i] = cube_at(boxes_[i].corner, 1);
    }

    double gravity_;
    std::vector<falling_box> boxes_;
};

}  // namespace aabblab
