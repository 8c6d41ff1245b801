#include <benchmark/benchmark.h>

#include "stages.hpp"

import aabb.geometry;
import aabb.std;
import aabb.triangle.exact;

namespace aabblab {

namespace {

using aabb::pose;
using aabb::triangle3d;
using aabb::vec3d;

/// Two meshes at poses.
struct posed_meshes {
    aabb::mesh a, b;
    aabb::pose_pair poses;
};

/// A sheet around the origin, of n² parallelograms of two triangles each. It lies in the plane x + y + z = 0, which a
/// permutation of the axes maps to itself.
aabb::mesh sheet(std::uint32_t n) {
    aabb::mesh m;
    for (std::uint32_t y = 0; y <= n; ++y)
        for (std::uint32_t x = 0; x <= n; ++x) {
            const float half = static_cast<float>(n) / 2, u = static_cast<float>(x) - half,
                        v = static_cast<float>(y) - half;
            m.vertices.push_back({u, v, -u - v});
        }
    for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t corner = y * (n + 1) + x;
            m.triangles.push_back({corner, corner + 1, corner + n + 2});
            m.triangles.push_back({corner, corner + n + 2, corner + n + 1});
        }
    return m;
}

/// The lateral surface, in 16 layers, of a gear of radius 1 with rectangular teeth of height 1/8.
aabb::mesh gear(std::uint32_t teeth) {
    constexpr std::uint32_t layers = 16;
    const std::uint32_t around = 4 * teeth;
    aabb::mesh m;
    for (std::uint32_t layer = 0; layer <= layers; ++layer)
        for (std::uint32_t i = 0; i < around; ++i) {
            const double angle = 2 * std::numbers::pi * i / around;
            const double radius = i % 4 < 2 ? 1.125 : 1;  // two corners of a tooth, then two of a gap
            m.vertices.push_back({static_cast<float>(radius * std::cos(angle)),
                                  static_cast<float>(radius * std::sin(angle)), 0.125F * static_cast<float>(layer)});
        }
    for (std::uint32_t layer = 0; layer < layers; ++layer)
        for (std::uint32_t i = 0; i < around; ++i) {
            const std::uint32_t p = layer * around + i, q = layer * around + (i + 1) % around;
            m.triangles.push_back({p, q, q + around});
            m.triangles.push_back({p, q + around, p + around});
        }
    return m;
}

/// The rotation about (1, 2, 3) by Rodrigues' formula, rounded like that of a user.
pose turned(double degrees) {
    const double angle = degrees / 180 * std::numbers::pi, c = std::cos(angle), s = std::sin(angle), d = 1 - c;
    const double length = std::sqrt(14.0), x = 1 / length, y = 2 / length, z = 3 / length;
    return {{c + x * x * d, x * y * d - z * s, x * z * d + y * s, y * x * d + z * s, c + y * y * d, y * z * d - x * s,
             z * x * d - y * s, z * y * d + x * s, c + z * z * d},
            {0, 0, 0}};
}

/// The pose x -> R (P x + shift), of the rotation R of p, and of P: (x, y, z) -> (y, z, x), a third of a turn about
/// (1, 1, 1), which maps the plane of the sheet to itself. R P is R with its columns permuted.
pose after_permutation(const pose& p, const vec3d& shift) {
    pose result;
    for (std::size_t i = 0; i < 3; ++i) {
        const double* const row = &p.rotation[3 * i];
        for (std::size_t j = 0; j < 3; ++j) result.rotation[3 * i + j] = row[(j + 2) % 3];
        result.translation[static_cast<int>(i)] = row[0] * shift[0] + row[1] * shift[1] + row[2] * shift[2];
    }
    return result;
}

/// The posed meshes of a case: sheets that cross, coincide, or nearly do; otherwise gears in mesh.
posed_meshes make(std::string_view name) {
    const aabb::mesh sheets = sheet(64);
    const pose r = turned(30);
    if (name == "crossing") return {sheets, sheets, {r, turned(50)}};
    if (name == "flush") return {sheets, sheets, {r, after_permutation(r, {0, 0, 0})}};
    if (name == "apart:1e-9") return {sheets, sheets, {r, after_permutation(r, {1e-9, 1e-9, 1e-9})}};
    // Gears under one rotation, flank to flank, at the distance of both radii; the second shifted by half a layer.
    const aabb::mesh wheel = gear(24);
    pose beside = r;
    for (std::size_t k = 0; k < 3; ++k)
        beside.translation[static_cast<int>(k)] = 2.125 * r.rotation[3 * k] + 0.0625 * r.rotation[3 * k + 2];
    return {wheel, wheel, {r, beside}};
}

/// A pair of triangles in all forms that the stages take.
struct posed_pair {
    triangle3d s, t;
    aabb::triangle3f s_in_float, image_of_t;
};

/// The pairs of triangles whose boxes overlap, with the image of the second triangle.
struct candidates {
    /// Collects the pairs of triangles whose boxes overlap in A's frame, in all forms that the stages of the test take.
    /// @param name a case of `make`
    explicit candidates(std::string_view name) : meshes(make(name)) {
        const auto& [a, b, poses] = meshes;
        const aabb::relative_pose to_a(poses.a, poses.b, bounds_of(b), a.frame, b.frame);
        image_error = to_a.image_error();
        for (std::uint32_t t = 0; t < b.triangle_count(); ++t) {
            const aabb::box of_t = to_a(bounds_of(b.triangle(t)));
            for (std::uint32_t s = 0; s < a.triangle_count(); ++s)
                if (overlaps(bounds_of(a.triangle(s)), of_t))
                    pairs.push_back({a.given_triangle(s), b.given_triangle(t), a.triangle(s), to_a(b.triangle(t))});
        }
        // A prime stride that does not divide their number shuffles them, so that order does not predict branches.
        const std::size_t stride = pairs.size() % 7919 != 0 ? 7919 : 7907;
        const std::vector<posed_pair> ordered = std::move(pairs);
        pairs.clear();
        for (std::size_t i = 0; i < ordered.size(); ++i) pairs.push_back(ordered[i * stride % ordered.size()]);
    }

    posed_meshes meshes;
    aabb::vec3f image_error{};  // a bound on that of an image in float, by axis
    std::vector<posed_pair> pairs;
};

/// Adds the benchmarks of one stage of the exact test, one per case; `decided` is the share of pairs that it decides.
/// @param stage called with the candidates and a pair; returns whether it decides the pair
template <class Stage>
void add(const std::string& name, Stage stage) {
    for (const std::string_view of : {"crossing", "apart:1e-9", "flush", "gears"})
        benchmark::RegisterBenchmark(("posed/" + name + "/" + std::string(of)).c_str(), [=](benchmark::State& state) {
            const candidates given(of);
            std::size_t at = 0, decided = 0;
            for ([[maybe_unused]] const auto& ignored : state) {
                if (++at >= given.pairs.size()) at = 0;
                benchmark::DoNotOptimize(stage(given, given.pairs[at]));
            }
            for (const posed_pair& p : given.pairs) decided += stage(given, p);
            state.counters["decided"] = static_cast<double>(decided) / static_cast<double>(given.pairs.size());
            state.counters["pairs"] = static_cast<double>(given.pairs.size());
        });
}

}  // namespace

/// Times the stages of the exact test alone: the filter in double, which may leave a pair undecided; the whole test;
/// and its integer arithmetic, `side`.
void add_posed_triangle_benchmarks() {
    add("filter_in_double", [](const candidates& given, const posed_pair& p) {
        return aabb::exact_triangle::intersects_if_certain(p.s_in_float, p.image_of_t, given.image_error).has_value();
    });
    add("exact", [](const candidates& given, const posed_pair& p) {
        benchmark::DoNotOptimize(aabb::exact_triangle::intersects(given.meshes.poses, p.s, p.t));
        return true;
    });
    add("integers", [](const candidates& given, const posed_pair& p) {
        const auto& [a, b] = given.meshes.poses;
        const aabb::exact_corners corners(
            {{{&p.s[0], &a}, {&p.s[1], &a}, {&p.s[2], &a}, {&p.t[0], &b}, {&p.t[1], &b}, {&p.t[2], &b}}});
        int sides = 0;
        for (const int i : {3, 4, 5}) sides += corners.side(0, 1, 2, i);
        benchmark::DoNotOptimize(sides);
        return true;
    });
}

}  // namespace aabblab
