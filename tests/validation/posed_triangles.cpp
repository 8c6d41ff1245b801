#include "../compositions.hpp"
#include "pairs.hpp"
#include "support.hpp"

import aabb.triangle.exact;
import aabb.triangle.interval_arithmetic;

// Exact tests of triangles of meshes at poses, compared with two judges: integers of any size, and CGAL.

namespace {

using aabb::pose;
using aabb::pose_pair;
using aabb::triangle3d;
using aabb::vec3d;
using triangle_pairs::generator;

double real(generator& g, double most = 1) {
    return std::uniform_real_distribution<double>(-most, most)(g);
}

/// A matrix of small integers, of full rank.
pose integer_map(generator& g) {
    for (;;) {
        pose p;
        for (double& r : p.rotation) r = triangle_pairs::integer(g, -2, 2);
        for (double& t : p.translation.at) t = triangle_pairs::integer(g, -3, 3);
        if (determinant_sign(p) != 0) return p;
    }
}

/// A rotation by a random quaternion, rounded.
pose rotation(generator& g) {
    std::array<double, 4> q{};
    double square = 0;
    for (double& c : q) c = real(g);
    for (const double c : q) square += c * c;
    for (double& c : q) c /= std::sqrt(square);
    const auto [w, x, y, z] = q;
    return {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), 2 * (x * y + w * z),
             1 - 2 * (x * x + z * z), 2 * (y * z - w * x), 2 * (x * z - w * y), 2 * (y * z + w * x),
             1 - 2 * (x * x + y * y)},
            {}};
}

/// p after q, rounded; exact if the entries of q are small integers and those of p have few digits.
pose composed(const pose& p, const pose& q) {
    pose result;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto row = [&](std::size_t j) {
            return p.rotation[3 * i] * q.rotation[j] + p.rotation[3 * i + 1] * q.rotation[3 + j] +
                   p.rotation[3 * i + 2] * q.rotation[6 + j];
        };
        for (std::size_t j = 0; j < 3; ++j) result.rotation[3 * i + j] = row(j);
        const vec3d& t = q.translation;
        result.translation[static_cast<int>(i)] = p.rotation[3 * i] * t[0] + p.rotation[3 * i + 1] * t[1] +
                                                  p.rotation[3 * i + 2] * t[2] + p.translation[static_cast<int>(i)];
    }
    return result;
}

pose scaled(pose p, int exponent) {
    for (double& r : p.rotation) r = std::ldexp(r, exponent);
    for (double& t : p.translation.at) t = std::ldexp(t, exponent);
    return p;
}

/// The second mesh moved by a whole number of units in the frame that the meshes share.
pose stepped(generator& g) {
    pose p;
    for (double& t : p.translation.at) t = triangle_pairs::integer(g, -1, 1);
    return p;
}

/// How the poses of two meshes relate.
struct pose_class {
    const char* name;
    pose_pair (*make)(generator& g);
};

const std::array<pose_class, 12> pose_classes{{
    {"equal poses",
     [](generator& g) {
         const pose p = composed(rotation(g), integer_map(g));
         return pose_pair{p, p};
     }},
    {"whole translations", [](generator& g) { return pose_pair{stepped(g), stepped(g)}; }},
    {"far translations",
     [](generator& g) {
         pose a, b = stepped(g);
         for (int k = 0; k < 3; ++k) {
             a.translation[k] = 4e6 + real(g, 0.1);
             b.translation[k] += a.translation[k];
         }
         return pose_pair{a, b};
     }},
    {"one rotation, flush",
     [](generator& g) {
         const pose r = rotation(g);
         return pose_pair{r, composed(r, stepped(g))};
     }},
    {"one rotation, apart or pressed by little",
     [](generator& g) {
         const pose r = rotation(g);
         pose b = composed(r, stepped(g));
         for (double& t : b.translation.at) t += std::ldexp(real(g), triangle_pairs::integer(g, -52, -30));
         return pose_pair{r, b};
     }},
    {"two rotations", [](generator& g) { return pose_pair{rotation(g), rotation(g)}; }},
    {"one a turn of the other by right angles",
     [](generator& g) {
         const pose r = rotation(g);
         pose turn{{0, 1, 0, 0, 0, 1, 1, 0, 0}, stepped(g).translation};
         for (double& x : turn.rotation) x *= triangle_pairs::integer(g, 0, 1) == 0 ? 1 : -1;
         return pose_pair{r, composed(r, turn)};
     }},
    {"maps of small integers", [](generator& g) { return pose_pair{integer_map(g), integer_map(g)}; }},
    {"a map of small integers after flush meshes",
     [](generator& g) {
         const pose p = integer_map(g);
         return pose_pair{p, composed(p, stepped(g))};
     }},
    {"any matrices",
     [](generator& g) {
         pose_pair poses;
         for (pose* p : {&poses.a, &poses.b}) {
             for (double& r : p->rotation) r = real(g);
             for (double& t : p->translation.at) t = real(g);
         }
         return poses;
     }},
    {"large or small",
     [](generator& g) {
         const pose p = scaled(rotation(g), triangle_pairs::integer(g, -1000, 980));
         return pose_pair{p, composed(p, stepped(g))};
     }},
    {"entries of all magnitudes",
     [](generator& g) {
         pose_pair poses;
         for (pose* p : {&poses.a, &poses.b}) {
             do {
                 for (double& r : p->rotation) r = std::ldexp(real(g), triangle_pairs::integer(g, -1070, 1020));
             } while (determinant_sign(*p) == 0);
             for (double& t : p->translation.at) t = std::ldexp(real(g), triangle_pairs::integer(g, -1070, 1020));
         }
         return poses;
     }},
}};

}  // namespace

TEST_CASE("exact tests decide triangles of meshes at poses as two judges do, in either order") {
    generator g(54);
    const aabb::exact_triangle exact;
    const aabb::interval_arithmetic_triangle intervals;
    for (const pose_class& c : pose_classes) {
        CAPTURE(c.name);
        std::array<int, 2> results{};
        int wrong = 0, wrong_intervals = 0, contradicted = 0;
        for (std::size_t pattern = 0; pattern < triangle_pairs::patterns.size(); ++pattern)
            for (int i = 0; i < 200; ++i) {
                const auto pair = triangle_pairs::of_type<double>(triangle_pairs::patterned(g, pattern));
                const pose_pair poses = c.make(g);
                const bool truth = aabb::intersect_in_integers(poses, pair.a, pair.b);
                ++results[truth ? 1 : 0];
                wrong += exact.intersects(poses, pair.a, pair.b) != truth;
                wrong += exact.intersects({poses.b, poses.a}, pair.b, pair.a) != truth;
                wrong_intervals += intervals.intersects(poses, pair.a, pair.b) != truth;
                if (i % 10 == 0)
                    contradicted += aabb::exactly_intersect(poses, in_float(pair.a), in_float(pair.b)) != truth;
            }
        CHECK(wrong == 0);
        CHECK(wrong_intervals == 0);
        CHECK(contradicted == 0);
        CHECK(results[0] > 0);
        CHECK(results[1] > 0);
    }
}

TEST_CASE("two cubes at poses intersect in the pairs that rational arithmetic finds, either way round") {
    aabb::mesh cube{{},
                    {{0, 1, 3},
                     {0, 3, 2},
                     {4, 6, 7},
                     {4, 7, 5},
                     {0, 4, 5},
                     {0, 5, 1},
                     {2, 3, 7},
                     {2, 7, 6},
                     {0, 2, 6},
                     {0, 6, 4},
                     {1, 5, 7},
                     {1, 7, 3}}};
    for (int i = 0; i < 8; ++i)
        cube.vertices.push_back(
            {static_cast<float>(i >> 2), static_cast<float>(i >> 1 & 1), static_cast<float>(i & 1)});
    std::ifstream file(AABBLAB_POSED_CUBES);
    int lines = 0;
    for (std::string line; std::getline(file, line);) {
        if (line.starts_with('#')) continue;
        ++lines;
        std::istringstream fields(line);
        std::array<std::string, 4> field;
        for (std::string& f : field) std::getline(fields, f, ';');
        const auto pose_of = [](std::string text) {
            std::ranges::replace(text, ',', ' ');
            std::istringstream numbers(text);
            pose p;
            for (std::size_t i = 0; i < 3; ++i) {
                for (std::size_t j = 0; j < 3; ++j) numbers >> p.rotation[3 * i + j];
                numbers >> p.translation[static_cast<int>(i)];
            }
            return p;
        };
        const pose a = pose_of(field[1]), b = pose_of(field[2]);
        for (const char* const engine : {"brute_force", "cgal", "cgal_tree"}) {
            CAPTURE(line, engine);
            CHECK(std::to_string(pairs_of(*aabb::make_mesh_engine(engine), cube, a, cube, b).size()) == field[3]);
        }
        for (const aabb::composition& c : exact_local_compositions()) {
            const auto stage = [&] { return local_of(c, aabb::instrumentation::none); };
            CAPTURE(line, text_of_local(c));
            CHECK(std::to_string(pairs_of(*stage(), cube, a, cube, b).size()) == field[3]);
            CHECK(std::to_string(pairs_of(*stage(), cube, b, cube, a).size()) == field[3]);
        }
    }
    CHECK(lines == 36);
}
