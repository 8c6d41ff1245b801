#include <benchmark/benchmark.h>

#include <random>

#include "cgal_side.hpp"
#include "stages.hpp"

import aabb.build.median;
import aabb.containment;
import aabb.std;
import aabb.tree.canonical;
import aabblab.scenes;

namespace aabblab {

namespace {

constexpr std::array<std::string_view, 2> sided_meshes = {"noise_sphere:triangles=20000",
                                                          "torus_knot:triangles=200000"};

/// A closed surface, and points in its box.
struct surrounded_points {
    explicit surrounded_points(std::string_view mesh) : surface(make_mesh(mesh).mesh) {
        constexpr std::size_t count = 4096;
        const aabb::box bounds = bounds_of(surface);
        std::mt19937 random(56);
        points.resize(count);
        for (aabb::vec3f& p : points)
            for (int k = 0; k < 3; ++k)
                p[k] =
                    bounds.min[k] + (bounds.max[k] - bounds.min[k]) * (static_cast<float>(random() >> 8U) * 0x1p-24F);
    }

    aabb::mesh surface;
    std::vector<aabb::vec3f> points;
};

/// Whether a point lies inside, by a ray of `enclosure`.
class enclosed_side {
public:
    explicit enclosed_side(const aabb::mesh& surface) : solid_(surface, aabb::median_build{}) {}

    [[nodiscard]] bool is_inside(const aabb::vec3f& p) const {
        aabb::parity_ray ray(solid_.triangles(), {}, solid_.surface().bounds(), aabb::in_double(p), {});
        ray.set_image(p, {0, 0, 0});
        if (ray.starts_outside()) return false;
        const auto around = solid_.around(ray, [](std::uint32_t) { return true; });
        return around && around->side() == aabb::solid_side::inside;
    }

private:
    aabb::enclosure<aabb::canonical_tree> solid_;
};

/// The same by CGAL.
class side_by_cgal {
public:
    explicit side_by_cgal(const aabb::mesh& surface) : side_(points_of(surface), surface.triangles) {}

    [[nodiscard]] bool is_inside(const aabb::vec3f& p) const { return side_.is_inside({p[0], p[1], p[2]}); }

private:
    [[nodiscard]] static std::vector<cgal_side::point> points_of(const aabb::mesh& surface) {
        std::vector<cgal_side::point> points;
        for (const aabb::vec3f& v : surface.vertices) points.push_back({v[0], v[1], v[2]});
        return points;
    }

    cgal_side side_;
};

/// Adds the benchmarks of one method: `build` is up to the result for the first point, for which CGAL builds its tree.
template <class Side, class Other>
void add(const std::string& method) {
    for (const std::string_view mesh : sided_meshes) {
        const auto name = [&](const std::string& part) {
            return "side/" + method + "/" + part + "/" + std::string(mesh);
        };
        benchmark::RegisterBenchmark(name("build").c_str(), [mesh](benchmark::State& state) {
            const surrounded_points given(mesh);
            for ([[maybe_unused]] const auto& ignored : state) {
                const Side side(given.surface);
                benchmark::DoNotOptimize(side.is_inside(given.points[0]));
            }
        })->Unit(benchmark::kMillisecond);
        benchmark::RegisterBenchmark(name("query").c_str(), [mesh](benchmark::State& state) {
            const surrounded_points given(mesh);
            const Side side(given.surface);
            const Other other(given.surface);
            std::size_t inside = 0;
            for (const aabb::vec3f& p : given.points) {
                if (side.is_inside(p) != other.is_inside(p))
                    throw std::logic_error("the library and CGAL disagree about what lies inside");
                inside += side.is_inside(p);
            }
            std::size_t at = 0;
            for ([[maybe_unused]] const auto& ignored : state) {
                if (++at == given.points.size()) at = 0;
                benchmark::DoNotOptimize(side.is_inside(given.points[at]));
            }
            state.counters["inside"] = static_cast<double>(inside) / static_cast<double>(given.points.size());
        });
    }
}

}  // namespace

void add_side_benchmarks() {
    add<enclosed_side, side_by_cgal>("enclosure");
    add<side_by_cgal, enclosed_side>("cgal");
}

}  // namespace aabblab
