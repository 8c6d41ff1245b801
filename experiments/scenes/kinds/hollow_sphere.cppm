module;
#include <Eigen/Core>

module aabblab.scenes:hollow_sphere;

import :boxes;

namespace aabblab {

/// Unit cubes that move along great circles of a sphere. Their world is nearly empty, and projections are uniform.
class hollow_sphere final : public generated_boxes {
public:
    static constexpr std::string_view name = "hollow_sphere";
    static constexpr std::string_view summary =
        "unit cubes that drift over a sphere, with nothing inside; a hundredth of them change direction in every frame";

    using config = motion_config;
    static constexpr auto parameters = motion_parameters;

    /// Derives the radius r from the number of cubes, and the angle of a step from the displacement.
    hollow_sphere(const config& c, std::uint64_t seed) : generated_boxes(name, c, seed, sizeof(point)) {
        // A cube overlaps those with centres in the cube of edge 2 around its own, in which the sphere has an area of
        // 4.767, averaged over the direction of its normal. Each overlaps two others if n · 4.767 / (4πr²) = 2.
        radius_ = std::sqrt(c.objects * 4.767 / (8 * pi));
        const double side = 2 * radius_ + 1;
        const double step = step_of(c, 1, {side, side, side});
        // The chord of an angle is 2 r sin(angle/2). A step is a chord, at most the diameter.
        const double half_angle_sine = radius_ > 0 ? std::min(1.0, step / (2 * radius_)) : 0;
        step_cosine_ = 1 - 2 * half_angle_sine * half_angle_sine;
        step_sine_ = 2 * half_angle_sine * std::sqrt(1 - half_angle_sine * half_angle_sine);
        points_.reserve(c.objects);
        for (std::uint32_t i = 0; i < c.objects; ++i) {
            const Eigen::Vector3d at = random_.direction();
            points_.push_back({at, tangent_at(at)});
        }
    }

private:
    static constexpr double pi = 3.141592653589793;

    /// A point on the unit sphere with its tangential direction of motion.
    struct point {
        Eigen::Vector3d at;
        Eigen::Vector3d direction;
    };

    static Eigen::Vector3d unit(const Eigen::Vector3d& v) { return v * (1 / length_of(v)); }

    Eigen::Vector3d tangent_at(const Eigen::Vector3d& at) {
        while (true) {
            const Eigen::Vector3d direction = random_.direction();
            const Eigen::Vector3d across = direction - at * dot(direction, at);
            if (dot(across, across) > 1e-3) return unit(across);
        }
    }

    /// Gives a random hundredth of the points a new direction, then moves each by a step along its great circle.
    void advance() override {
        const auto count = static_cast<std::uint32_t>(points_.size());
        // The remainder is carried over, so that few points turn as often as many do.
        for (to_turn_ += count; to_turn_ >= 100; to_turn_ -= 100) {
            point& turned = points_[random_.below(count)];
            turned.direction = tangent_at(turned.at);
        }
        for (point& p : points_) {
            const Eigen::Vector3d before = p.at;
            p.at = unit(before * step_cosine_ + p.direction * step_sine_);
            const Eigen::Vector3d ahead = p.direction * step_cosine_ - before * step_sine_;
            p.direction = unit(ahead - p.at * dot(ahead, p.at));  // tangent in spite of rounding
        }
    }

    void place(std::span<aabb::box> boxes) override {
        for (std::size_t i = 0; i < boxes.size(); ++i)
            boxes[i] = cube_at(points_[i].at * radius_ - Eigen::Vector3d::Constant(0.5), 1);
    }

    double radius_ = 0;
    double step_cosine_ = 1;
    double step_sine_ = 0;
    std::vector<point> points_;
    std::uint64_t to_turn_ = 0;
};

}  // namespace aabblab
