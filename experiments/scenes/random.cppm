module;
#include <Eigen/Core>
#include <random>

/// Random numbers, drifting points and roots that are identical with every compiler and on every machine: the standard
/// specifies random engines but not distributions, and among functions only the square root is correctly rounded.
module aabblab.scenes:random;

import aabb.std;
import aabblab.vectors;

namespace aabblab {

class random_source {
public:
    explicit random_source(std::uint64_t seed) : engine_(seed) {}

    /// A random multiple of 2^-53 in [0, 1).
    [[nodiscard]] double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

    /// A random number in [0, count); count > 0.
    [[nodiscard]] std::uint32_t below(std::uint32_t count) {
        return static_cast<std::uint32_t>((engine_() >> 32) * count >> 32);
    }

    /// A random direction, uniform on the unit sphere (2 axes: circle, 1: two points). It is that of a random point of
    /// the cube; points outside the ball are rejected, and those so near its centre that their direction is inexact.
    [[nodiscard]] Eigen::Vector3d direction(int axes = 3) {
        while (true) {
            Eigen::Vector3d p = Eigen::Vector3d::Zero();
            for (int k = 0; k < axes; ++k) p[k] = signed_unit();
            const double square = dot(p, p);
            if (square <= 1 && square >= 1e-6) return p / length_of(p);
        }
    }

    /// A random point in the cube [0, width)^3.
    [[nodiscard]] Eigen::Vector3d point(double width) { return {unit() * width, unit() * width, unit() * width}; }

    /// A random number in [-1, 1).
    [[nodiscard]] double signed_unit() { return 2 * unit() - 1; }

private:
    std::mt19937_64 engine_;
};

/// The root of x^3 = value >= 0 by Newton's method, from above until rounding stops it: std::cbrt differs by library.
[[nodiscard]] inline double cube_root(double value) {
    if (value == 0) return 0;
    double root = value > 1 ? value : 1;
    while (true) {
        const double next = (2 * root + value / (root * root)) / 3;
        if (!(next < root)) return root;
        root = next;
    }
}

/// The edge of the cube, square or segment (3, 2, 1 axes) of that volume, area or length.
[[nodiscard]] inline double edge_of(double volume, int axes) {
    return axes == 3 ? cube_root(volume) : axes == 2 ? std::sqrt(volume) : volume;
}

/// The range of displacements per frame, in which the steps of points are uniformly distributed.
struct step_range {
    double least;
    double most;
};

/// Points that move through the cube [0, width]^3 by constant steps. Walls reflect them; a hundredth turns every frame.
class drifting_points {
public:
    drifting_points() = default;
    /// Places points with random directions and steps along the first `axes` axes; other coordinates stay 0.
    drifting_points(std::uint32_t count, int axes, double width, step_range steps, random_source& random)
        : axes_(axes), width_(width > 0 ? width : 0) {
        points_.reserve(count);
        for (std::uint32_t i = 0; i < count; ++i) {
            point& p = points_.emplace_back();
            for (int k = 0; k < axes; ++k) p.at[k] = random.unit() * width_;
            p.step = steps.least + random.unit() * (steps.most - steps.least);
            p.direction = random.direction(axes);
        }
    }

    [[nodiscard]] std::size_t size() const noexcept { return points_.size(); }
    [[nodiscard]] const Eigen::Vector3d& operator[](std::size_t i) const noexcept { return points_[i].at; }

    /// Gives a random hundredth of the points a new direction, then moves all points by a step.
    void advance(random_source& random) {
        const auto count = static_cast<std::uint32_t>(points_.size());
        // The remainder is carried over, so that few points turn as often as many do.
        for (to_turn_ += count; to_turn_ >= 100; to_turn_ -= 100)
            points_[random.below(count)].direction = random.direction(axes_);
        for (point& p : points_)
            for (int k = 0; k < axes_; ++k) move(p, k);
    }

    static constexpr double bytes_each = 56;

private:
    struct point {
        Eigen::Vector3d at = Eigen::Vector3d::Zero();
        Eigen::Vector3d direction;
        double step = 0;
    };
    static_assert(sizeof(point) == static_cast<std::size_t>(bytes_each));

    /// Moves a point along axis k, between reflecting walls at 0 and at the width.
    void move(point& p, int k) const {
        if (width_ == 0) return;
        // A path that walls reflect is a straight one, folded at the walls: it repeats after twice the width.
        double along = std::fmod(p.at[k] + p.step * p.direction[k], 2 * width_);
        if (along < 0) along += 2 * width_;
        if (along > width_) {
            along = 2 * width_ - along;
            p.direction[k] = -p.direction[k];
        }
        p.at[k] = along;
    }

    int axes_ = 0;
    double width_ = 0;
    std::vector<point> points_;
    std::uint64_t to_turn_ = 0;
};

}  // namespace aabblab
