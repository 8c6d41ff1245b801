#include "../compositions.hpp"
#include "../random_poses.hpp"
#include "pairs.hpp"
#include "support.hpp"

import aabb.triangle.exact;
import aabb.triangle.intersection;
import aabb.triangle.interval_arithmetic;
import aabb.triangle.orientation_test;
import aabb.wide_tree.triangle_filter;

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
    return turned_by({real(g), real(g), real(g), real(g)}, {});
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

/// What vertices look like: a map of the coordinates of patterns, which are floats.
struct vertex_class {
    const char* name;
    double factor;
    double offset;
};

const std::array<vertex_class, 8> vertex_classes{{{"floats", 1, 0},
                                                  {"decimals", 0.1, 0},
                                                  {"far", 1, 3948995},
                                                  {"decimals, far", 0.1, 3948995.7},
                                                  {"huge", 0x1.23456789abcdep980, 0},
                                                  {"tiny", 0x1.23456789abcdep-980, 0},
                                                  {"denormal", 0x1p-1072, 0},
                                                  {"beyond floats, far", 0x1p200, 0x1p240}}};

/// The triangle with its coordinates mapped, by a function that is the same for all of a mesh.
triangle3d mapped(triangle3d t, const vertex_class& by) {
    for (vec3d& corner : t.corner)
        for (double& x : corner.at) x = x * by.factor + by.offset;
    return t;
}

/// A triangle as a mesh.
aabb::mesh mesh_of(const triangle3d& t) {
    aabb::mesh m{{}, {{0, 1, 2}}};
    set_vertices(m, {t[0], t[1], t[2]});
    return m;
}

/// Signs by integers alone, without a filter.
class integer_signs {
public:
    integer_signs(const pose_pair& poses, const triangle3d& s, const triangle3d& t)
        : corners_(poses, s, t),
          integers_({{{&s[0], &poses.a},
                      {&s[1], &poses.a},
                      {&s[2], &poses.a},
                      {&t[0], &poses.b},
                      {&t[1], &poses.b},
                      {&t[2], &poses.b}}}) {}

    [[nodiscard]] const triangle3d& s() const { return corners_.s(); }
    [[nodiscard]] const triangle3d& t() const { return corners_.t(); }
    [[nodiscard]] static bool are_apart() { return false; }
    [[nodiscard]] bool part(aabb::corner_sides& s_to_t, aabb::corner_sides& t_to_s) const {
        const auto sides = [&](int first, int plane) {
            const auto of = [&](int i) { return integers_.side(plane, plane + 1, plane + 2, first + i); };
            return aabb::corner_sides(std::array{of(0), of(1), of(2)});
        };
        s_to_t = sides(0, 3);
        t_to_s = sides(3, 0);
        return s_to_t.on_one_side() || t_to_s.on_one_side();
    }
    [[nodiscard]] bool are_equal(const vec3d& p, const vec3d& q) const { return corners_.are_equal(p, q); }
    [[nodiscard]] bool boxes_are_disjoint() const { return integers_.boxes_are_disjoint(); }
    [[nodiscard]] int side(const vec3d& a, const vec3d& b, const vec3d& c, const vec3d& d) const {
        return integers_.side(at(a), at(b), at(c), at(d));
    }
    [[nodiscard]] bool in_order(const vec3d& s0, const vec3d& s1, const vec3d& s2, const vec3d& t0, const vec3d& t1,
                                const vec3d& t2) const {
        return side(s0, s1, t0, t1) <= 0 && side(s0, s2, t0, t2) >= 0;
    }
    [[nodiscard]] int turn(const vec3d& a, const vec3d& b, const vec3d& c, int axis) const {
        return integers_.turn(at(a), at(b), at(c), axis);
    }
    [[nodiscard]] bool beyond(const vec3d& a, const vec3d& b, int own, const triangle3d& t, int axis) const {
        const int first = turn(a, b, t[0], axis);
        return first != 0 && first != own && turn(a, b, t[1], axis) == first && turn(a, b, t[2], axis) == first;
    }

private:
    [[nodiscard]] int at(const vec3d& corner) const { return corners_.index_of(corner); }

    aabb::posed_orientations corners_;
    aabb::exact_corners integers_;
};

bool intersect_by_integers(const pose_pair& poses, const triangle3d& s, const triangle3d& t) {
    return aabb::orientation_test<integer_signs>::intersects(poses, s, t);
}

/// What the filter in float of the wide tree, and then that in double, decide of a pair in the frame of the first mesh;
/// nothing if its image leaves the range of float.
std::array<std::optional<bool>, 2> filtered(const pose_pair& poses, const aabb::mesh& a, const aabb::mesh& b) {
    std::optional<aabb::relative_pose> to_a;
    try {
        to_a.emplace(poses.a, poses.b, bounds_of(b), a.frame, b.frame);
    } catch (const aabb::input_error&) {
        return {};
    }
    const aabb::triangle3f s = a.triangle(0);
    const aabb::triangle3f image = (*to_a)(b.triangle(0));
    std::array<std::array<std::array<float, aabb::simd::width>, 9>, 2> rows{};
    for (std::size_t row = 0; row < 9; ++row)
        for (std::size_t lane = 0; lane < aabb::simd::width; ++lane) {
            rows[0][row][lane] = s[static_cast<int>(row / 3)][static_cast<int>(row % 3)];
            rows[1][row][lane] = image[static_cast<int>(row / 3)][static_cast<int>(row % 3)];
        }
    const aabb::filtered_pairs decided =
        aabb::triangle_filter::decide(rows[0][0].data(), rows[1][0].data(), aabb::simd::width, to_a->image_error().at);
    return {(decided.undecided & 1U) != 0 ? std::nullopt : std::optional((decided.hits & 1U) != 0),
            aabb::exact_triangle::intersects_if_certain(s, image, to_a->image_error())};
}

}  // namespace

// With RC_PARAMS=max_success=10000 in the environment, 10^6 pairs.
TEST_CASE("exact tests decide triangles of meshes at poses as two judges do, in either order") {
    generator g(54);
    const aabb::exact_triangle exact;
    const aabb::interval_arithmetic_triangle intervals;
    std::array<std::array<int, 2>, pose_classes.size()> results{};
    REQUIRE(rc::check([&] {
        const vertex_class& vertices = vertex_classes[*rc::gen::inRange<std::size_t>(0, vertex_classes.size())];
        for (std::size_t i = 0; i < pose_classes.size() * triangle_pairs::patterns.size(); ++i) {
            const std::size_t c = i % pose_classes.size();
            const auto pair = triangle_pairs::of_type<double>(triangle_pairs::patterned(g, i / pose_classes.size()));
            const triangle3d s = mapped(pair.a, vertices), t = mapped(pair.b, vertices);
            const pose_pair poses = pose_classes[c].make(g);
            const bool truth = aabb::intersect_in_integers(poses, s, t);
            ++results[c][truth ? 1 : 0];
            RC_ASSERT(aabb::exactly_intersect(poses, s, t) == truth);
            RC_ASSERT(exact.intersects(poses, s, t) == truth);
            RC_ASSERT(exact.intersects({poses.b, poses.a}, t, s) == truth);
            RC_ASSERT(intervals.intersects(poses, s, t) == truth);
        }
    }));
    for (std::size_t c = 0; c < pose_classes.size(); ++c) {
        CAPTURE(pose_classes[c].name);
        CHECK(std::ranges::min(results[c]) > 0);
    }
}

TEST_CASE("what triangles at poses have in common equals what CGAL constructs, within the stated error") {
    generator g(544);
    std::map<aabb::intersection_kind, int> kinds;
    for (const pose_class& c : pose_classes)
        for (const vertex_class& vertices : vertex_classes) {
            CAPTURE(c.name, vertices.name);
            int wrong_kinds = 0, beyond_error = 0, coarse = 0;
            for (std::size_t pattern = 0; pattern < triangle_pairs::patterns.size(); ++pattern)
                for (int i = 0; i < 10; ++i) {
                    const auto pair = triangle_pairs::of_type<double>(triangle_pairs::patterned(g, pattern));
                    const triangle3d s = mapped(pair.a, vertices), t = mapped(pair.b, vertices);
                    const pose_pair poses = c.make(g);
                    const aabb::exact_intersection exact(poses, s, t);
                    ++kinds[exact.kind()];
                    wrong_kinds += aabb::intersection_kind_of(poses, s, t) != exact.kind();
                    const aabb::triangle_intersection common = aabb::intersection_of(poses, s, t);
                    double largest = 0;
                    for (const aabb::posed_point& p : {aabb::posed_point{&s[0], &poses.a}, {&t[0], &poses.b}})
                        for (std::size_t k = 0; k < 9; ++k)
                            largest = std::max(
                                {largest, std::abs(p.at->translation[static_cast<int>(k % 3)]),
                                 std::abs(p.at->rotation[k]) * (std::abs((*p.vertex)[0]) + 8 * vertices.factor)});
                    wrong_kinds += common.kind != exact.kind();
                    if (largest > 1e300) continue;  // coordinates may leave the range of double
                    const aabb::corner_errors errors = exact.errors_of(common);
                    beyond_error += !errors.same || !errors.within;
                    for (const double error : common.error.at) coarse += error > 0x1p-46 * largest + 0x1p-1060;
                }
            CHECK(wrong_kinds == 0);
            CHECK(beyond_error == 0);
            CHECK(coarse == 0);
        }
    for (const auto& [kind, count] : kinds) CHECK(count > 20);
    CHECK(kinds.size() == 5);
}

TEST_CASE("two cubes at poses intersect in the pairs that rational arithmetic finds, either way round") {
    const aabb::mesh cube = aabb::unit_cube();
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

// With RC_PARAMS=max_success=1000000 in the environment, 10^8 pairs.
TEST_CASE("no filter at poses contradicts integers") {
    generator g(541);
    std::array<std::uint64_t, 4> decided{};  // by the filter in float, then that in double, then neither; hits
    REQUIRE(rc::check([&] {
        const pose_class& c = pose_classes[*rc::gen::inRange<std::size_t>(0, pose_classes.size())];
        for (int i = 0; i < 100; ++i) {
            const auto pattern = static_cast<std::size_t>(i) % triangle_pairs::patterns.size();
            const auto pair = triangle_pairs::of_type<float>(triangle_pairs::patterned(g, pattern));
            const vertex_class& vertices = vertex_classes[*rc::gen::inRange<std::size_t>(0, vertex_classes.size())];
            const triangle3d s = mapped(in_double(pair.a), vertices), t = mapped(in_double(pair.b), vertices);
            const pose_pair poses = c.make(g);
            const bool truth = intersect_by_integers(poses, s, t);
            RC_ASSERT(aabb::exact_triangle::intersects(poses, s, t) == truth);
            const auto [in_float, in_double] = filtered(poses, mesh_of(s), mesh_of(t));
            RC_ASSERT(in_float.value_or(truth) == truth);
            RC_ASSERT(in_double.value_or(truth) == truth);
            ++decided[in_float ? 0 : in_double ? 1 : 2];
            decided[3] += truth;
        }
    }));
    CAPTURE(decided);
    CHECK(std::ranges::min(decided) > 100);
}

// With RC_PARAMS=max_success=25000 in the environment, as many lines as 96 grids of 256 by 256 units have.
TEST_CASE("around degenerate pairs, unit by unit in the last place, no stage at poses contradicts integers") {
    constexpr int half = 128;
    generator g(542);
    std::array<std::uint64_t, 4> decided{};  // by the filter in float, then that in double, then neither; hits
    std::uint64_t pairs = 0;
    REQUIRE(rc::check([&] {
        const pose_pair poses = pose_classes[*rc::gen::inRange<std::size_t>(0, pose_classes.size())].make(g);
        const auto pattern = *rc::gen::inRange<std::size_t>(1, triangle_pairs::patterns.size());
        const auto pair = triangle_pairs::of_type<double>(triangle_pairs::patterned(g, pattern));
        const aabb::mesh fixed = mesh_of(pair.a);
        triangle3d moved = pair.b;
        vec3d& corner = moved[triangle_pairs::integer(g, 0, 2)];
        const int x = triangle_pairs::integer(g, 0, 2), y = (x + 1) % 3;
        // Coordinates are below 8, so that doubles hold these sums.
        corner[x] += triangle_pairs::integer(g, -half, half - 1) * 0x1p-50;
        const double from_y = corner[y];
        for (int j = -half; j < half; ++j) {
            corner[y] = from_y + j * 0x1p-50;
            const bool truth = intersect_by_integers(poses, pair.a, moved);
            const auto [in_float, in_double] = filtered(poses, fixed, mesh_of(moved));
            RC_ASSERT(in_float.value_or(truth) == truth);
            RC_ASSERT(in_double.value_or(truth) == truth);
            RC_ASSERT(aabb::exact_triangle::intersects(poses, pair.a, moved) == truth);
            ++decided[in_float ? 0 : in_double ? 1 : 2];
            decided[3] += truth;
            ++pairs;
        }
    }));
    CAPTURE(decided, pairs);
    CHECK(decided[2] > pairs / 10);
    CHECK(decided[3] > pairs / 40);
    CHECK(decided[3] < pairs - pairs / 40);
}

namespace {

/// The pairs of two meshes by every exact composition, either way round, are those of a judge.
void check_meshes(const aabb::mesh& a, const pose& pose_a, const aabb::mesh& b, const pose& pose_b,
                  bool intersect = true) {
    std::vector<aabb::index_pair> truth, swapped;
    for (std::uint32_t s = 0; s < a.triangle_count(); ++s)
        for (std::uint32_t t = 0; t < b.triangle_count(); ++t)
            if (aabb::intersect_in_integers({pose_a, pose_b}, a.given_triangle(s), b.given_triangle(t))) {
                truth.push_back({s, t});
                swapped.push_back({t, s});
            }
    std::ranges::sort(swapped);
    REQUIRE(truth.empty() != intersect);
    for (const aabb::composition& c : exact_local_compositions()) {
        CAPTURE(text_of_local(c));
        CHECK(pairs_of(*local_of(c, aabb::instrumentation::none), a, pose_a, b, pose_b) == truth);
        CHECK(pairs_of(*local_of(c, aabb::instrumentation::none), b, pose_b, a, pose_a) == swapped);
    }
}

}  // namespace

TEST_CASE("segments whose corners coincide only as rounded are no points") {
    constexpr double e = 0x1p-60;
    const triangle3d s{{{1, 1, 1}, {1, 2, 1}, {1, 1, 1}}};
    const pose_pair poses{{}, {pose{}.rotation, {1, 1, 1}}};
    const vec3d p{-e, -e, 0}, q{e / 2, 0, 0};
    for (const triangle3d& t : {triangle3d{{p, q, p}}, triangle3d{{p, p, q}}, triangle3d{{q, p, p}}}) {
        CHECK_FALSE(aabb::exact_triangle::intersects(poses, s, t));
        CHECK_FALSE(aabb::exact_triangle::intersects({poses.b, poses.a}, t, s));
        CHECK_FALSE(aabb::interval_arithmetic_triangle().intersects(poses, s, t));
    }
}

TEST_CASE("a tiny mesh is found in an oblique triangle far from the origin") {
    constexpr float c = 0x1p20F, d = 0x1p-10F;
    const aabb::mesh a{{{c + 2, c - 2 + 0x1p-4F, -5}, {c - 2 + 0x1p-4F, c + 2, -5}, {c + 2, c - 2 + 0x1p-4F, 5}},
                       {{0, 1, 2}}};
    const aabb::mesh b{{{-d, -d, 0}, {d, d, 0}, {-d, d, d}, {d, -d, d}}, {{0, 1, 2}, {0, 1, 3}}};
    check_meshes(a, {}, b, {pose{}.rotation, {c + 0x1p-5, c + 0x1p-5, -2}});
}

TEST_CASE("what underflows in the world is found in a frame that magnifies it") {
    constexpr float u = 0x1p-80F;
    const aabb::mesh a{{{0.75F * u, 0, 0}, {1.25F * u, 0, u / 8}, {1.25F * u, 0, -u / 8}}, {{0, 1, 2}}};
    const aabb::mesh b{{{u, -u, -u}, {u, u, -u}, {u, 0, u}}, {{0, 1, 2}}};
    const std::array<double, 9> matrix{0x1p-1000, 0, 0, 0, 0x1p1000, 0, 0, 0, 1};
    check_meshes(a, {matrix, {0, 0, 0}}, b, {matrix, {0, 0, 0x1p-90}});
}

TEST_CASE("nodes of denormal boxes touch at a pose that magnifies them") {
    constexpr float v = 0x1p-149F, m = 0x1.0000f8p-60F;
    const aabb::mesh a{{{m, -m, -m}, {m, m, -m}, {m, 0, m}}, {{0, 1, 2}}};
    const aabb::mesh b{{{0, 0, 0}, {v, 0, 0}, {0, v, v}}, {{0, 1, 2}}};
    check_meshes(a, {}, b,
                 {{0x1.1705c780491abp+99, 0x1.82fbb50b8e52ap+99, 0x1.9aeadbfe6ab87p+99, 0, 1, 0, 0, 0, 1}, {m, 0, 0}});
}

TEST_CASE("meshes scaled by any power meet as they do unscaled") {
    const aabb::mesh ball = aabb::sphere(4);
    for (const double scale : {1e-110, 1e-30, 1e30, 1e110}) {
        const std::array<double, 9> matrix{scale, 0, 0, 0, scale, 0, 0, 0, scale};
        check_meshes(ball, {matrix, {0, 0, 0}}, ball, {matrix, {scale / 4, 0, 0}});
    }
}

namespace {

/// The mesh with its vertices mapped, in double.
aabb::mesh mapped(aabb::mesh m, auto map) {
    std::vector<vec3d> vertices;
    for (std::size_t v = 0; v < m.vertices.size(); ++v) {
        vec3d p = m.given_vertex(v);
        for (int k = 0; k < 3; ++k) p[k] = map(p[k], k);
        vertices.push_back(p);
    }
    set_vertices(m, vertices);
    return m;
}

}  // namespace

TEST_CASE("meshes of doubles at poses intersect in the pairs that a judge finds, either way round") {
    generator g(543);
    const aabb::mesh ball = aabb::sphere(4);
    for (const vertex_class& c : vertex_classes) {
        CAPTURE(c.name);
        const aabb::mesh a = mapped(ball, [&](double x, int) { return x * c.factor + c.offset; });
        const aabb::mesh b = mapped(ball, [&](double x, int k) { return (x + (k == 0)) * c.factor + c.offset; });
        // Squares of such coordinates leave the range of double, which poses may make greater.
        const bool is_extreme = std::abs(std::ilogb(c.factor)) > 300;
        CHECK(a.given.empty() == (c.factor == 1 && c.offset == 0));
        check_meshes(a, {}, b, {});
        const pose turned = rotation(g);
        check_meshes(a, turned, b, turned);
        pose moved = turned;
        moved.translation[0] += c.factor / 3;
        check_meshes(a, turned, b, moved);
        if (is_extreme) continue;
        for (const pose& p : {turned, integer_map(g)})
            check_meshes(a, p, a, composed(p, {pose{}.rotation, {c.factor, 0, 0}}));
    }
}

TEST_CASE("what lies a little apart in doubles, and nowhere near it in floats, does not touch") {
    const aabb::mesh cube = mapped(aabb::grid(1), [](double x, int k) { return k == 2 ? 1 : x; });
    for (const double gap : {0.1, 1e-9, -1e-9})
        for (const vec3d& at : {vec3d{388096, 3948995, 10}, vec3d{0.1, 0.2, 0.3}}) {
            CAPTURE(gap, at[1]);
            const auto placed = [&](double up) {
                return mapped(cube, [&](double x, int k) { return x + at[k] + (k == 1 ? up : 0); });
            };
            const bool intersect = gap < 0;
            check_meshes(placed(0), {}, placed(1 + gap), {}, intersect);
            check_meshes(placed(0), {}, placed(0), {pose{}.rotation, {0, 1 + gap, 0}}, intersect);
        }
}

TEST_CASE("a mesh of doubles intersects itself in the pairs that a judge finds") {
    for (const vertex_class& c : vertex_classes) {
        CAPTURE(c.name);
        // Two balls in one mesh, of which some vertices coincide as floats.
        aabb::mesh both = aabb::sphere(4);
        const auto vertices = static_cast<std::uint32_t>(both.vertices.size());
        const auto triangles = both.triangles;
        for (const auto& [p, q, r] : triangles) both.triangles.push_back({p + vertices, q + vertices, r + vertices});
        std::vector<vec3d> given;
        for (const double shift : {0.0, 0x1p-30})
            for (std::uint32_t v = 0; v < vertices; ++v) {
                vec3d p = both.given_vertex(v);
                for (double& x : p.at) x = (x + shift) * c.factor + c.offset;
                given.push_back(p);
            }
        set_vertices(both, given);
        std::vector<aabb::index_pair> truth;
        for (std::uint32_t s = 0; s < both.triangle_count(); ++s)
            for (std::uint32_t t = s + 1; t < both.triangle_count(); ++t)
                if (aabb::intersect_in_integers({}, both.given_triangle(s), both.given_triangle(t)))
                    truth.push_back({s, t});
        for (const aabb::composition& composed : exact_local_compositions()) {
            CAPTURE(text_of_local(composed));
            const auto stage = local_of(composed, aabb::instrumentation::none);
            std::vector<aabb::index_pair> pairs;
            stage->self_pairs(stage->add_model(both), pairs);
            CHECK(sorted(pairs) == truth);
        }
    }
}

TEST_CASE("an oblique triangle meets the box of one whose doubles lie beyond its floats") {
    // Near 2^20, where floats have steps of 1/8, a leaf's box and triangle differ from the true ones by 0.005.
    aabb::mesh a{{}, {{0, 1, 2}}};
    set_vertices(a, {{1048584, 1048576, 0}, {1048576, 1048583.875, 0}, {1048576, 1048583.875, 8}});
    aabb::mesh b{{}, {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}}};
    set_vertices(b, {{1048576.13, 1048583.755, 3},
                     {1048572, 1048578, 3},
                     {1048572, 1048578, 3.5},
                     {1048572, 1048579, 3.25},
                     {786432, 786432, 0},
                     {786432, 786431, 0},
                     {786431, 786432, 0},
                     {786430, 786432, 1}});
    check_meshes(a, {}, b, {});
}

TEST_CASE("meshes of one point, and a tiny mesh and a huge one, are searched in either order") {
    const auto at = [](double x) {
        aabb::mesh m{{}, {{0, 1, 2}}};
        set_vertices(m, {{x, x, x}, {x, x, x}, {x, x, x}});
        return m;
    };
    for (const double x : {1e70, 1e-320, 3948995.7}) check_meshes(at(x), {}, at(x), {});
    const aabb::mesh huge = mapped(aabb::sphere(4), [](double x, int) { return x * 1e28; });
    const aabb::mesh tiny = mapped(aabb::sphere(4), [](double x, int k) { return x * 1.1e-12 + (k == 2 ? 1e28 : 0); });
    check_meshes(huge, {}, mapped(aabb::sphere(4), [](double x, int) { return x * 1.1e-12; }), {}, /*intersect=*/false);
    check_meshes(huge, {}, tiny, {});
}
