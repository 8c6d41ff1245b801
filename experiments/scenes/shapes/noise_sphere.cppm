module;
#include <Eigen/Core>

module aabblab.scenes:noise_sphere;

import :circle;
import :random;
import :shape;

namespace aabblab {

/// A fixed sphere with dents and bumps of many sizes, like a scanned object: rings between two poles.
struct noise_sphere {
    static constexpr std::string_view name = "noise_sphere";
    static constexpr std::string_view summary = "a sphere with dents and bumps";

    /// The number of triangles is 2 · rings · vertices per ring, the nearest one that keeps their shape.
    using config = shape_size<5000>;
    static constexpr auto parameters = config::parameters(18, "about how many triangles");

    /// Puts a vertex at each pole and rings between them, at distances that the noise determines.
    [[nodiscard]] static aabb::mesh make(const config& c) {
        const auto [rings, around] = rings_for(c.triangles, /*aspect=*/0.5);
        const noise waves;
        aabb::mesh m;
        m.vertices.push_back(waves.surface({0, 0, 1}));
        for (std::uint32_t ring = 1; ring <= rings; ++ring) {
            const circle_point latitude = on_circle(ring / (2.0 * (rings + 1)));
            for (std::uint32_t i = 0; i < around; ++i) {
                const circle_point longitude = on_circle(static_cast<double>(i) / around);
                m.vertices.push_back(
                    waves.surface({latitude.sin * longitude.cos, latitude.sin * longitude.sin, latitude.cos}));
            }
        }
        m.vertices.push_back(waves.surface({0, 0, -1}));

        const std::uint32_t south = rings * around + 1;
        const auto index_of = [=](std::uint32_t ring, std::uint32_t i) { return 1 + ring * around + i % around; };
        for (std::uint32_t i = 0; i < around; ++i) m.triangles.push_back({0, index_of(0, i), index_of(0, i + 1)});
        add_bands(m, rings - 1, around, index_of);
        for (std::uint32_t i = 0; i < around; ++i)
            m.triangles.push_back({index_of(rings - 1, i), south, index_of(rings - 1, i + 1)});
        return m;
    }

private:
    /// Plane waves of random directions, with amplitudes proportional to wavelengths.
    class noise {
    public:
        /// Chooses the waves, with a fixed seed, so that all meshes have the same. Each has 1.2 times the frequency of
        /// the one before, and its height divided by 1.2.
        noise() {
            random_source random(/*seed=*/1);
            double frequency = 0.35;
            for (wave& w : waves_) {
                w = {random.direction(), frequency, random.unit(), 0.06 / frequency};
                frequency *= 1.2;
            }
        }
        [[nodiscard]] aabb::vec3f surface(const Eigen::Vector3d& direction) const {
            double radius = 1;
            for (const wave& w : waves_)
                radius += w.height * on_circle(w.frequency * dot(w.direction, direction) + w.phase).sin;
            return in_float(direction * radius);
        }

    private:
        struct wave {
            Eigen::Vector3d direction;
            double frequency;  // periods per unit of length
            double phase;      // turns
            double height;
        };
        std::array<wave, 12> waves_{};
    };
};

}  // namespace aabblab
