module;
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <tuple>
#include <vector>

module aabblab.scenes:hollow_sphere;

import aabb.geometry;
import :boxes;
import :random;

namespace aabblab {

/// Unit cubes whose centres lie on a sphere and move along great circles of it. Nearly all of their world is empty, and
/// on every axis as many lie in the middle as at the ends.
class hollow_sphere final : public generated_boxes {
public:
    static constexpr std::string_view name = "hollow_sphere";
    static constexpr std::string_view summary =
        "unit cubes that drift over a sphere, with nothing inside; a hundredth of them turn every frame";

    using config = motion_config;
    static constexpr auto parameters = motion_parameters;

    hollow_sphere(const config& c, std::uint64_t seed) : generated_boxes(name, c, seed, sizeof(point)) {
        // A cube overlaps those whose centres the sphere has in the cube of edge 2 around its own: an area of 4.767 in
        // the mean over the directions in which the sphere may pass. So each overlaps two others on average.
        radius_ = std::sqrt(c.objects * 4.767 / (8 * pi));
        const double side = 2 * radius_ + 1;
        const double step = step_of(c, 1, {side, side, side});
        // Half the angle of a step has this sine; none is longer than the sphere is wide.
        const double sine = radius_ > 0 ? std::min(1.0, step / (2 * radius_)) : 0;
        along_ = 1 - 2 * sine * sine;
        across_ = 2 * sine * std::sqrt(1 - sine * sine);
        points_.reserve(c.objects);
        for (std::uint32_t i = 0; i < c.objects; ++i) {
            const aabb::vec3d at = random_.direction();
            points_.push_back({at, tangent_at(at)});
        }
    }

private:
    static constexpr double pi = 3.141592653589793;

    /// On the unit sphere, with the direction in which it moves, which is orthogonal to it.
    struct point {
        aabb::vec3d at;
        aabb::vec3d direction;
    };

    static aabb::vec3d scaled(double factor, const aabb::vec3d& v) {
        return {factor * v[0], factor * v[1], factor * v[2]};
    }

    static aabb::vec3d unit(const aabb::vec3d& v) { return scaled(1 / std::sqrt(aabb::dot(v, v)), v); }

    aabb::vec3d tangent_at(const aabb::vec3d& at) {
        while (true) {
            const aabb::vec3d any = random_.direction();
            const aabb::vec3d across = any - scaled(aabb::dot(any, at), at);
            if (aabb::dot(across, across) > 1e-3) return unit(across);
        }
    }

    void advance() override {
        const auto count = static_cast<std::uint32_t>(points_.size());
        // As points that drift elsewhere do.
        for (to_turn_ += count; to_turn_ >= 100; to_turn_ -= 100) {
            point& turned = points_[random_.below(count)];
            turned.direction = tangent_at(turned.at);
        }
        for (point& p : points_) {
            const aabb::vec3d before = p.at;
            p.at = unit(scaled(along_, before) + scaled(across_, p.direction));
            const aabb::vec3d ahead = scaled(along_, p.direction) - scaled(across_, before);
            p.direction = unit(ahead - scaled(aabb::dot(ahead, p.at), p.at));
        }
    }

    void place(std::span<aabb::box> boxes) override {
        for (std::size_t i = 0; i < boxes.size(); ++i)
            boxes[i] = cube_at(scaled(radius_, points_[i].at) - aabb::vec3d{0.5, 0.5, 0.5}, 1);
    }

    double radius_ = 0;
    double along_ = 1;
    double across_ = 0;
    std::vector<point> points_;
    std::uint64_t to_turn_ = 0;
};

}  // namespace aabblab
