#include <benchmark/benchmark.h>

#include <random>

#include "cgal_side.hpp"
#include "stages.hpp"

import aabb.build.median;
import aabb.containment;
import aabb.std;
import aabb.tree.implicit;
import aabblab.scenes;

namespace aabblab {

namespace {

constexpr std::array<std::string_view, 2> sided_meshes = {"noise_sphere:triangles=20000",
                                                          "torus_knot:triangles=200000"};

using solid = aabb::enclosure<aabb::implicit_tree>;

/// The vertices of triangles without area, at random in a box.
aabb::mesh points_in(const aabb::box& bounds) {
    constexpr std::uint32_t count = 4096;
    std::mt19937 random(56);
    aabb::mesh points;
    for (std::uint32_t v = 0; v < count; ++v) {
        aabb::vec3f p{};
        for (int k = 0; k < 3; ++k)
            p[k] = bounds.min[k] + (bounds.max[k] - bounds.min[k]) * (static_cast<float>(random() >> 8U) * 0x1p-24F);
        points.vertices.push_back(p);
        points.triangles.push_back({v, v, v});
    }
    return points;
}

std::vector<cgal_side::point> for_cgal(const aabb::mesh& m) {
    std::vector<cgal_side::point> points;
    for (const aabb::vec3f& v : m.vertices) points.push_back({v[0], v[1], v[2]});
    return points;
}

/// A closed surface, and points in its box as both methods take them.
struct surrounded_points {
    explicit surrounded_points(std::string_view mesh) : surface(make_mesh(mesh).mesh) {}
    surrounded_points(const surrounded_points&) = delete;  // since `points_as_mesh` refers to `points`

    aabb::mesh surface;
    aabb::mesh points = points_in(bounds_of(surface));
    solid points_as_mesh{points, aabb::median_build{}};
    std::vector<cgal_side::point> points_for_cgal = for_cgal(points);
};

/// Whether a vertex lies inside, as `relation_of` decides in `collide`.
class enclosed_side {
public:
    explicit enclosed_side(const surrounded_points& given)
        : solid_(given.surface, aabb::median_build{}), rays_(given.points_as_mesh, {}, solid_, {}) {}

    [[nodiscard]] bool is_inside(std::uint32_t vertex) const {
        const aabb::parity_ray ray = rays_(vertex);
        if (ray.starts_outside()) return false;
        const auto around = solid_.around(ray, [](std::uint32_t) { return true; });
        return around && around->side() == aabb::solid_side::inside;
    }

private:
    solid solid_;
    aabb::vertex_rays<aabb::implicit_tree> rays_;
};

/// The same by CGAL.
class side_by_cgal {
public:
    explicit side_by_cgal(const surrounded_points& given)
        : side_(for_cgal(given.surface), given.surface.triangles), points_(&given.points_for_cgal) {}

    [[nodiscard]] bool is_inside(std::uint32_t vertex) const { return side_.is_inside((*points_)[vertex]); }

private:
    cgal_side side_;
    const std::vector<cgal_side::point>* points_;
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
                const Side side(given);
                benchmark::DoNotOptimize(side.is_inside(0));
            }
        })->Unit(benchmark::kMillisecond);
        benchmark::RegisterBenchmark(name("query").c_str(), [mesh](benchmark::State& state) {
            const surrounded_points given(mesh);
            const Side side(given);
            const Other other(given);
            const auto count = static_cast<std::uint32_t>(given.points.vertices.size());
            std::uint32_t inside = 0;
            for (std::uint32_t v = 0; v < count; ++v) {
                if (side.is_inside(v) != other.is_inside(v))
                    throw std::logic_error("the library and CGAL disagree about what lies inside");
                inside += side.is_inside(v);
            }
            std::uint32_t vertex = 0;
            for ([[maybe_unused]] const auto& ignored : state) {
                if (++vertex == count) vertex = 0;
                benchmark::DoNotOptimize(side.is_inside(vertex));
            }
            state.counters["inside"] = static_cast<double>(inside) / count;
        });
    }
}

}  // namespace

void add_side_benchmarks() {
    add<enclosed_side, side_by_cgal>("enclosure");
    add<side_by_cgal, enclosed_side>("cgal");
}

}  // namespace aabblab
