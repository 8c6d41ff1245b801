module;
#include <Eigen/Core>
#include <random>

/// Random numbers that are the same with every compiler and on every machine: the standard fixes the engine, not its
/// distributions, and of functions only the square root is rounded alike everywhere.
module aabblab.scenes:random;

import aabb.std;
import aabblab.vectors;

namespace aabblab {

class random_source {
public:
    explicit random_source(std::uint64_t seed) : engine_(seed) {}

    /// In [0, 1), a multiple of 2^-53.
    [[nodiscard]] double unit() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

    /// In [0, count); count > 0.
    [[nodiscard]] std::uint32_t below(std::uint32_t count) {
        return static_cast<std::uint32_t>((engine_() >> 32) * count >> 32);
    }

    /// Evenly over the unit sphere; over the unit circle of the first two axes; along the first.
    [[nodiscard]] Eigen::Vector3d direction(int axes = 3) {
        while (true) {
            Eigen::Vector3d p = Eigen::Vector3d::Zero();
            for (int k = 0; k < axes; ++k) p[k] = within();
            const double square = dot(p, p);
            if (square <= 1 && square >= 1e-6) return p / length_of(p);
        }
    }

    /// In the cube [0, width)^3.
    [[nodiscard]] Eigen::Vector3d point(double width) { return {unit() * width, unit() * width, unit() * width}; }

    /// In [-1, 1).
    [[nodiscard]] double within() { return 2 * unit() - 1; }

private:
    std::mt19937_64 engine_;
};

}  // namespace aabblab
