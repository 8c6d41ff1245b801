#include <rapidcheck.h>

#include "../meshes.hpp"
#include "../random_poses.hpp"
#include "searches.hpp"

import aabb.build.median;
import aabb.distance;
import aabb.distance.placed_boxes;
import aabb.distance_stages;
import aabb.partition.columns;
import aabb.sort.bucket;
import aabb.sweep.simd;
import aabb.tree.implicit;

// What is nearer than a distance, through every broad phase and every tree. Exact decisions are compared with judges in
// tests/validation/distances.cpp.

using namespace aabb;

namespace {

/// Whether boxes on the lattice of multiples of 1/4 are within a multiple of 1/4, in whole numbers.
bool are_within_on_lattice(const box& a, const box& b, double d, box_metric metric) {
    long long square = 0, greatest = 0;
    for (int k = 0; k < 3; ++k) {
        const float gap = std::max({0.0F, b.min[k] - a.max[k], a.min[k] - b.max[k]});
        const auto steps = static_cast<long long>(4 * gap);
        square += steps * steps;
        greatest = std::max(greatest, steps);
    }
    const auto steps = static_cast<long long>(4 * d);
    return metric == box_metric::euclidean ? square <= steps * steps : greatest <= steps;
}

std::vector<index_pair> within_on_lattice(std::span<const box> boxes, const std::vector<bool>& present, double d,
                                          box_metric metric) {
    std::vector<index_pair> pairs;
    for (std::uint32_t a = 0; a < boxes.size(); ++a)
        for (std::uint32_t b = a + 1; b < boxes.size(); ++b)
            if (present[a] && present[b] && are_within_on_lattice(boxes[a], boxes[b], d, metric))
                pairs.push_back({a, b});
    return pairs;
}

/// A triangle soup on a coarse lattice: many triangles touch, are coplanar or have no area.
mesh any_soup() {
    mesh m;
    const auto vertices = *rc::gen::inRange<std::uint32_t>(1, 20);
    const float size = *rc::gen::element(0.1F, 1.0F);
    for (std::uint32_t v = 0; v < vertices; ++v) {
        vec3f p;
        for (int k = 0; k < 3; ++k) p[k] = static_cast<float>(*rc::gen::inRange(-3, 4)) * size;
        m.vertices.push_back(p);
    }
    const auto triangles = *rc::gen::inRange<std::size_t>(1, 20);
    for (std::size_t t = 0; t < triangles; ++t)
        m.triangles.push_back(
            {*rc::gen::inRange(0U, vertices), *rc::gen::inRange(0U, vertices), *rc::gen::inRange(0U, vertices)});
    return m;
}

/// Vertices that are no floats.
mesh in_doubles(mesh m, double far) {
    std::vector<vec3d> vertices;
    for (const vec3f& v : m.vertices) vertices.push_back({0.1 * v[0] + far, 0.1 * v[1], 0.1 * v[2] - far});
    set_vertices(m, vertices);
    return m;
}

pose any_pose_near(double distance) {
    vec3d by;
    for (double& x : by.at) x = *rc::gen::inRange(-4, 5) * distance;
    pose p = *rc::gen::arbitrary<bool>() ? any_turned(by) : shifted(by);
    if (*rc::gen::inRange(0, 4) == 0)
        for (double& r : p.rotation) r *= *rc::gen::element(0.5, 3.0);  // neither rigid nor a similarity
    return p;
}

std::vector<index_pair> expected(const mesh& a, const mesh& b, const pose_pair& poses, double d) {
    std::vector<index_pair> pairs;
    for (std::uint32_t s = 0; s < a.triangle_count(); ++s)
        for (std::uint32_t t = 0; t < b.triangle_count(); ++t)
            if (are_within(poses, a.given_triangle(s), b.given_triangle(t), d)) pairs.push_back({s, t});
    return pairs;
}

}  // namespace

TEST_CASE("through every broad phase, pairs are exactly the boxes within a distance, as objects come, move and go",
          "[long]") {
    const std::vector<aabb::composition> compositions = global_compositions();
    REQUIRE(rc::check([&] {
        const aabb::composition composition = *rc::gen::elementOf(compositions);
        RC_LOG(text_of_global(composition));
        const auto metric = *rc::gen::element(box_metric::euclidean, box_metric::axis);
        const double d = *rc::gen::element(0.0, 0.25, 1.25, 5.0, 13.0);
        within_stage stage(global_of(composition), d, metric);
        std::vector<box> boxes(40);
        std::vector<bool> present(boxes.size());
        for (int frame = 0; frame < 4; ++frame) {
            for (std::uint32_t id = 0; id < boxes.size(); ++id) {
                if (frame == 0 || *rc::gen::inRange(0, 3) == 0)
                    for (int k = 0; k < 3; ++k) {
                        boxes[id].min[k] = static_cast<float>(*rc::gen::inRange(0, 120)) / 4;
                        boxes[id].max[k] = boxes[id].min[k] + static_cast<float>(*rc::gen::inRange(0, 9)) / 4;
                    }
                if (frame == 0 || *rc::gen::inRange(0, 8) == 0) {
                    present[id] ? stage.remove(id) : stage.insert(id);
                    present[id] = !present[id];
                }
            }
            RC_ASSERT(found_by(stage, boxes) == within_on_lattice(boxes, present, d, metric));
        }
    }));
}

TEST_CASE("every broad phase finds the boxes within a distance") {
    std::mt19937 random(560);
    std::vector<box> boxes = lattice_boxes(random, 150, 40, 3);
    const std::vector<bool> present(boxes.size(), true);
    for (const aabb::composition& composition : global_compositions()) {
        INFO(text_of_global(composition));
        within_stage stage(global_of(composition), 5);
        insert_all(stage, boxes.size());
        const auto pairs = within_on_lattice(boxes, present, 5, box_metric::euclidean);
        CHECK(found_by(stage, boxes) == pairs);
        CHECK(found_by(stage, boxes) == pairs);  // with what it keeps between frames
        CHECK(pairs.size() > overlapping(boxes).size() + 20);
    }
}

TEST_CASE("one unit in the last place decides whether boxes are within a distance") {
    for (const double size : {1.0, 0x1p-1070, 0x1p-700, 0x1p-300, 0x1p500, 0x1p1000})
        for (const auto& [x, y, z, d] : std::vector<std::array<double, 4>>{{3, 4, 0, 5}, {2, 3, 6, 7}, {0, 0, 9, 9}}) {
            INFO(size << ", " << d);
            const boxd a{{-size, -size, -size}, {0, 0, 0}};
            const boxd b{{x * size, y * size, z * size}, {10 * size, 10 * size, 10 * size}};
            const double distance = d * size;
            CHECK(are_within(a, b, distance));
            CHECK(are_within(b, a, distance));
            CHECK_FALSE(are_within(a, b, std::nextafter(distance, 0.0)));
            CHECK(are_within(a, b, std::nextafter(distance, std::numeric_limits<double>::max())));
            boxd farther = b;
            farther.min[2] = std::nextafter(farther.min[2], std::numeric_limits<double>::max());
            // With y = 4 and z = 0 the gap on z becomes the least double, which counts if nothing is rounded.
            CHECK_FALSE(are_within(a, farther, distance));
            const double greatest = std::max({x, y, z}) * size;
            CHECK(are_within(a, b, greatest, box_metric::axis));
            CHECK_FALSE(are_within(a, b, std::nextafter(greatest, 0.0), box_metric::axis));
        }
    CHECK(are_within(boxd{{-1, -1, -1}, {0, 0, 0}}, boxd{{0, 0, 0}, {1, 1, 1}}, 0));
    // A gap that is rounded to d but is greater.
    const boxd low{{-1, 0, 0}, {-0x1p-60, 1, 1}}, high{{1, 0, 0}, {2, 1, 1}};
    CHECK_FALSE(are_within(low, high, 1));
    CHECK_FALSE(are_within(low, high, 1, box_metric::axis));
    const boxd nearer{{-1, 0, 0}, {0x1p-60, 1, 1}};
    CHECK(are_within(nearer, high, 1));
    CHECK(are_within(nearer, high, 1, box_metric::axis));
}

TEST_CASE("grown boxes overlap where the boxes are within the distance, also if bounds were rounded to float before") {
    std::size_t margins_needed = 0;
    REQUIRE(rc::check([&] {
        const double size = std::ldexp(1.0, *rc::gen::inRange(-140, 120));
        const double low = uniform(-size, size) + uniform(-size, size) * 0x1p-30;
        const double way = uniform(0.0, size) + uniform(0.0, size) * 0x1p-30;
        const double high = low + std::ldexp(way, -*rc::gen::inRange(0, 40));
        const boxd a{{low, 0, 0}, {low, 0, 0}}, b{{high, 0, 0}, {high, 0, 0}};
        double d = high - low;
        while (!are_within(a, b, d)) d = std::nextafter(d, std::numeric_limits<double>::max());
        const auto rounded = [](double x) { return static_cast<float>(x); };
        const box a_in_floats{{rounded(low), 0, 0}, {rounded(low), 0, 0}};
        const box b_in_floats{{rounded(high), 0, 0}, {rounded(high), 0, 0}};
        RC_ASSERT(overlaps(grown(a_in_floats, d), grown(b_in_floats, d)));
        RC_ASSERT(grown(a, d).overlaps(grown(b, d)));
        // They grow by little more, which some need whose bounds were rounded.
        RC_ASSERT(double{grown(a_in_floats, d).max[0]} - low <= d / 2 + 0x1p-19 * (std::abs(low) + d) + 0x1p-140);
        RC_ASSERT(grown(a, d).max[0] - low <= d / 2 + 0x1p-48 * (std::abs(low) + d) + 0x1p-1060);
        margins_needed += rounded(rounded(low) + d / 2) < rounded(rounded(high) - d / 2);
    }));
    CHECK(margins_needed > 0);
}

TEST_CASE("within a distance, boxes are rejected as they are without") {
    within_stage stage(global_of({}), 5);
    insert_all(stage, 2);
    std::vector<box> boxes(2, cube(0, 1));
    boxes[1].max[0] = -1;
    CHECK_REFUSED(stage.update(boxes), "box 1 is inverted: its minimum is above its maximum");
    boxes[1].max[0] = std::numeric_limits<float>::infinity();
    CHECK_REFUSED(stage.update(boxes), "box 1 has a coordinate that is not finite");
    for (const double d : {-1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        CHECK_REFUSED(within_stage(global_of({}), d), "a distance is a finite number that is not negative");
}

TEST_CASE("through every tree, pairs are exactly the triangles within a distance, in every query", "[long]") {
    std::vector<aabb::composition> compositions = all_compositions(stage::local_detection);
    std::erase_if(compositions, [](const aabb::composition& c) { return c[strategy_kind::triangle].name != "exact"; });
    REQUIRE(compositions.size() >= 33);
    REQUIRE(rc::check([&] {
        mesh a = any_soup(), b = any_soup();
        const double far = *rc::gen::element(0.0, 0.0, 1e7);
        if (far > 0 || *rc::gen::arbitrary<bool>()) a = in_doubles(a, far);
        if (far > 0 || *rc::gen::arbitrary<bool>()) b = in_doubles(b, far);
        const double d = *rc::gen::element(0.0, 0.1, 0.5, 1.0, 3.0);
        const pose_pair poses{any_pose_near(d), any_pose_near(d)};
        const std::vector<index_pair> truth = expected(a, b, poses, d);
        for (int i = 0; i < 8; ++i) {
            const aabb::composition composition = *rc::gen::elementOf(compositions);
            RC_LOG(text_of_local(composition));
            const auto stage = compose_within(composition, d);
            stage->add_model(a);
            stage->add_model(b);
            std::vector<index_pair> pairs;
            stage->all_pairs(0, poses.a, 1, poses.b, pairs);
            RC_ASSERT(sorted(pairs) == truth);
            std::vector<index_pair> swapped;
            stage->all_pairs(1, poses.b, 0, poses.a, swapped);
            for (index_pair& p : swapped) std::swap(p.a, p.b);
            RC_ASSERT(sorted(swapped) == truth);
            RC_ASSERT(stage->count_pairs(0, poses.a, 1, poses.b) == truth.size());
            const auto first = stage->first_pair(0, poses.a, 1, poses.b);
            RC_ASSERT(first.has_value() == !truth.empty());
            if (first) RC_ASSERT(std::ranges::find(truth, *first) != truth.end());
        }
    }));
}

TEST_CASE("whole nodes leave out no triangle within a distance") {
    // Large enough for several levels of nodes; floats and doubles, near and far, at rotations and at other poses.
    const mesh sheet = ripples(12), in_double = in_doubles(ripples(12), 1);
    const mesh cubes = [] {
        mesh m;
        for (std::uint32_t i = 0; i < 40; ++i)
            for (const auto& t : std::vector(tetrahedron(0.4F).triangles)) {
                const vec3f at{static_cast<float>(i % 8), static_cast<float>(i >> 3U), 0};
                const auto corner = [&](std::size_t v) { return tetrahedron(0.4F).vertices[t[v]] + at; };
                add_triangle(m, corner(0), corner(1), corner(2));
            }
        return m;
    }();
    const pose turned = turned_by({1, 0.2, -0.1, 0.3}, {3, -2, 1.5});
    pose stretched = turned;
    for (double& r : stretched.rotation) r *= 2;
    std::size_t pairs_of_truth = 0;
    for (const auto& [a, b] : {std::pair(&sheet, &cubes), std::pair(&sheet, &in_double), std::pair(&cubes, &sheet)})
        for (const pose_pair& poses :
             {pose_pair{{}, shifted({0.5, 0.25, 1.5})}, pose_pair{turned, {}}, pose_pair{turned, stretched},
              pose_pair{shifted({1e6, 0, 0}), shifted({1e6, 0.5, 3})}, pose_pair{{}, shifted({40, 0, 0})}})
            for (const double d : {0.0, 0.3, 1.7, 25.0}) {
                const std::vector<index_pair> truth = expected(*a, *b, poses, d);
                pairs_of_truth += truth.size();
                for (const char* tree : {"implicit", "implicit:vertices=fetched", "canonical"}) {
                    CAPTURE(tree, d);
                    const auto stage = compose_within(composed({{strategy_kind::tree, tree}}), d);
                    stage->add_model(*a);
                    stage->add_model(*b);
                    std::vector<index_pair> pairs;
                    stage->all_pairs(0, poses.a, 1, poses.b, pairs);
                    CHECK(sorted(pairs) == truth);
                }
            }
    CHECK(pairs_of_truth > 10000);
}

TEST_CASE("every tree measures the same distance of meshes with several levels of nodes, and finds a pair within it") {
    const auto in_units = [](mesh m, double unit) {
        std::vector<vec3d> vertices;
        for (const vec3f& v : m.vertices) vertices.push_back({0.1 * unit * v[0], 0.1 * unit * v[1], 0.1 * unit * v[2]});
        set_vertices(m, vertices);
        return m;
    };
    // The last two have frames of another scale.
    const mesh sheet = ripples(30), in_double = in_units(ripples(20), 1), tiny = in_units(ripples(20), 0x1p-120),
               huge = in_units(ripples(20), 0x1p120);
    REQUIRE(tiny.frame.scale != 1);
    REQUIRE(huge.frame.scale != 1);
    const std::array<std::tuple<const mesh*, const mesh*, double>, 5> cases{{{&sheet, &in_double, 1},
                                                                             {&in_double, &sheet, 1},
                                                                             {&sheet, &sheet, 1},
                                                                             {&tiny, &tiny, 0x1p-120},
                                                                             {&huge, &huge, 0x1p120}}};
    std::size_t apart = 0;
    REQUIRE(rc::check([&] {
        const auto [a, b, size] = cases[*rc::gen::inRange<std::size_t>(0, cases.size())];
        const double far = *rc::gen::element(1.0, 30.0, 300.0);
        pose_pair poses{any_turned(any_vector(far * size)), any_turned(any_vector(far * size))};
        if (*rc::gen::inRange(0, 4) == 0)
            for (double& r : poses.b.rotation) r *= 1.5;
        std::optional<mesh_distance> first;
        for (const char* tree : {"canonical", "implicit", "implicit:vertices=fetched", "quantized"}) {
            RC_LOG(std::string(tree));
            const aabb::composition c = composed({{strategy_kind::tree, tree}});
            const auto stage = compose_distance(c);
            stage->add_model(*a);
            stage->add_model(*b);
            const mesh_distance nearest = stage->distance(0, poses.a, 1, poses.b);
            if (!first) first = nearest;
            RC_ASSERT(std::abs(nearest.distance - first->distance) <= nearest.error + first->error);
            RC_ASSERT(nearest.error <= 0x1p-38 * (far + 100) * size);
            const auto any_within = [&](double d) {
                const auto within = compose_within(c, d);
                within->add_model(*a);
                within->add_model(*b);
                return within->first_pair(0, poses.a, 1, poses.b).has_value();
            };
            RC_ASSERT(any_within(nearest.distance + nearest.error));
            const double below = nearest.distance - nearest.error;
            RC_ASSERT(below <= 0 || !any_within(std::nextafter(below, 0.0)));
            apart += below > 0;
        }
    }));
    CHECK(apart > 100);
}

TEST_CASE("the least and the greatest distances decide as any other") {
    constexpr double least = std::numeric_limits<double>::denorm_min(), most = std::numeric_limits<double>::max();
    const mesh a = ripples(9), b = in_doubles(ripples(9), 0);
    for (const double d : {0.0, least, 1e-300, 1e-30, 1e30, 1e300, most})
        for (const double apart : {0.0, 0x1p-40, 1e3}) {
            const pose_pair poses{{}, shifted({0, 0, apart})};
            const std::vector<index_pair> truth = expected(a, b, poses, d);
            CHECK((d > 1 ? truth.size() == a.triangles.size() * b.triangles.size() : truth.empty() == (apart > 1)));
            for (const strategy_info& tree : strategies(strategy_kind::tree)) {
                CAPTURE(tree.name, d, apart);
                const auto stage = compose_within(composed({{strategy_kind::tree, tree.name.c_str()}}), d);
                stage->add_model(a);
                stage->add_model(b);
                std::vector<index_pair> pairs;
                stage->all_pairs(0, poses.a, 1, poses.b, pairs);
                CHECK(sorted(pairs) == truth);
            }
        }
}

TEST_CASE("after vertices have moved, refitted trees find the triangles within a distance, and the distance") {
    for (const strategy_info& tree : strategies(strategy_kind::tree)) {
        CAPTURE(tree.name);
        const aabb::composition c = composed({{strategy_kind::tree, tree.name.c_str()}});
        mesh moving = ripples(10);
        const mesh still = ripples(10);
        const auto stage = compose_within(c, 0.5);
        stage->add_model(moving);
        stage->add_model(still);
        const pose_pair poses{{}, shifted({0, 0, 3})};
        std::vector<index_pair> pairs;
        stage->all_pairs(0, poses.a, 1, poses.b, pairs);
        const std::vector<index_pair> before = expected(moving, still, poses, 0.5);
        CHECK(sorted(pairs) == before);
        for (vec3f& v : moving.vertices) v[2] += 0.25F * v[0];
        stage->refit(0);
        pairs.clear();
        stage->all_pairs(0, poses.a, 1, poses.b, pairs);
        const std::vector<index_pair> after = expected(moving, still, poses, 0.5);
        CHECK(sorted(pairs) == after);
        CHECK(after.size() > before.size());
    }
}

TEST_CASE("a box moved to the world contains its vertices as the poses place them") {
    // A bound or a vertex, at its pose, against another, exactly.
    const auto order = [](const vec3d& p, const pose& at_p, const vec3d& q, const pose& at_q, int axis) {
        const posed_point first{&p, &at_p}, second{&q, &at_q};
        const std::array<posed_point, 6> points{first, first, first, second, second, second};
        return exact_corners(points).order(0, 3, axis);
    };
    std::size_t near = 0, bounds = 0;
    REQUIRE(rc::check([&] {
        const double size = *rc::gen::element(1.0, 1e-6, 1e8, 0x1p-1060, 0x1p900);
        const double far = *rc::gen::element(0.0, 1e7) * size;
        std::vector<vec3d> vertices(5);
        for (vec3d& v : vertices) v = {far + uniform(-size, size), uniform(-size, size), uniform(-size, size)};
        mesh m{{}, {{0, 1, 2}, {2, 3, 4}}};
        set_vertices(m, vertices);
        pose a = any_turned(any_vector(size)), b = any_turned(any_vector(1e3 * size));
        for (double& r : b.rotation) r *= *rc::gen::element(0.75, 3.0);
        const placed_boxes placed(b, b.translation - a.translation, m.frame, bounds_of(m));
        const boxd world = placed(bounds_of(m));
        pose origin;  // of the world, to which boxes are relative
        origin.translation = a.translation;
        for (int k = 0; k < 3; ++k) {
            for (const vec3d& v : vertices) {
                RC_ASSERT(order(v, b, world.min, origin, k) >= 0);
                RC_ASSERT(order(v, b, world.max, origin, k) <= 0);
            }
            // A turned box is at most as long as its diagonal.
            RC_ASSERT(world.max[k] - world.min[k] <= 3 * 3.5 * size + 0x1p-20 * (far + 1e3 * size));
        }
        // A box of a point is little more than that point: its margin must cover what is rounded, and no more.
        const box corner{m.vertices[0], m.vertices[0]};
        const boxd of_corner = placed(corner);
        for (int k = 0; k < 3; ++k) {
            RC_ASSERT(order(vertices[0], b, of_corner.min, origin, k) >= 0);
            RC_ASSERT(order(vertices[0], b, of_corner.max, origin, k) <= 0);
            ++bounds;
            near += of_corner.max[k] - of_corner.min[k] <= 0x1p-20 * (far + 1e3 * size);
        }
    }));
    CHECK(near > bounds / 2);
}

TEST_CASE("boxes at the ends of float are within a distance where their numbers say so, in every broad phase") {
    constexpr float most = std::numeric_limits<float>::max(), least = std::numeric_limits<float>::denorm_min();
    const std::vector<box> boxes{{{-most, -most, -most}, {-most, -most, -most}},
                                 {{most, most, most}, {most, most, most}},
                                 {{-most, 0, 0}, {most, 0, 0}},
                                 {{0, least, 0}, {least, 2 * least, 0}},
                                 {{0, 4 * least, 0}, {0, 4 * least, 0}},
                                 {{1, 1, 1}, {1, 1, 1}},
                                 {{most / 2, 0, 0}, {most / 2, 0, 0}}};
    for (const double d : {0.0, double{least}, 2.0 * least, 1.0, double{most}, 2.0 * most, 1e300}) {
        std::vector<index_pair> truth;
        for (std::uint32_t a = 0; a < boxes.size(); ++a)
            for (std::uint32_t b = a + 1; b < boxes.size(); ++b)
                if (are_within(boxes[a], boxes[b], d)) truth.push_back({a, b});
        CHECK(truth.size() >= (d >= 4.0 * most ? 21 : 1));
        for (const aabb::composition& composition : global_compositions()) {
            INFO(text_of_global(composition) << ", " << d);
            std::vector<index_pair> pairs;
            try {
                within_stage stage(global_of(composition), d);
                insert_all(stage, boxes.size());
                pairs = found_by(stage, boxes);
            } catch (const input_error& error) {
                INFO(error.what());
                CHECK((holds(error.what(), "cells") || holds(error.what(), "copies")));  // of a given size
                continue;
            }
            CHECK(pairs == truth);
        }
    }
}

TEST_CASE("the boxes of nodes exclude most triangles that are farther") {
    const mesh sheet = ripples(40);
    for (const strategy_info& tree : strategies(strategy_kind::tree)) {
        CAPTURE(tree.name);
        const auto stage =
            compose_within(composed({{strategy_kind::tree, tree.name.c_str()}}), 1, instrumentation::counters);
        stage->add_model(sheet);
        stage->add_model(sheet);
        const std::uint64_t pairs = stage->count_pairs(0, {}, 1, shifted({0.25, 0.25, 2.25}));
        CHECK(pairs > 0);
        CHECK(stage->counters()[work::triangle_tests] >= pairs);
        CHECK(20 * stage->counters()[work::triangle_tests] <
              std::uint64_t{sheet.triangle_count()} * sheet.triangle_count());
        CHECK(stage->counters()[work::box_tests] > 0);
        CHECK(stage->validate_tree(0)->fault == "");
        std::vector<index_pair> none;
        CHECK_REFUSED(stage->self_pairs(0, none), "distances are searched between two meshes, not within one");
    }
}

TEST_CASE("through every tree, the distance of two meshes lies within its error of that of all pairs of triangles") {
    std::vector<aabb::composition> compositions = all_compositions(stage::local_detection);
    std::erase_if(compositions, [](const aabb::composition& c) { return c[strategy_kind::triangle].name != "exact"; });
    int meeting = 0, apart = 0;
    REQUIRE(rc::check([&] {
        mesh a = any_soup(), b = any_soup();
        const double far = *rc::gen::element(0.0, 0.0, 1e7);
        if (far > 0 || *rc::gen::arbitrary<bool>()) a = in_doubles(a, far);
        if (far > 0 || *rc::gen::arbitrary<bool>()) b = in_doubles(b, far);
        pose_pair poses{any_pose_near(*rc::gen::element(0.0, 0.25)),
                        any_pose_near(*rc::gen::element(0.0, 0.0, 0.25, 30.0))};
        if (*rc::gen::element(false, false, true)) {  // random meshes seldom meet
            b = a;
            poses.b = poses.a;
        }
        for (int i = 0; i < 4; ++i) {
            const aabb::composition composition = *rc::gen::elementOf(compositions);
            RC_LOG(text_of_local(composition));
            const auto stage = compose_distance(composition);
            stage->add_model(a);
            stage->add_model(b);
            const mesh_distance nearest = stage->distance(0, poses.a, 1, poses.b);
            // Exact decisions bound the distance from both sides.
            const double above = nearest.distance + nearest.error, below = nearest.distance - nearest.error;
            RC_ASSERT(
                are_within(poses, a.given_triangle(nearest.triangles.a), b.given_triangle(nearest.triangles.b), above));
            RC_ASSERT(below <= 0 || expected(a, b, poses, std::nextafter(below, 0.0)).empty());
            double size = 1;
            for (int k = 0; k < 3; ++k)
                size = std::max({size, std::abs(nearest.point_a[k]), std::abs(nearest.point_b[k])});
            RC_ASSERT(nearest.error <= 0x1p-40 * (size + 1e7));
            RC_ASSERT((nearest.distance == 0) == !expected(a, b, poses, 0).empty());
            const auto is_on = [&](const mesh& m, std::uint32_t triangle, const pose& at, const vec3d& point) {
                return are_within({at, {}}, m.given_triangle(triangle), {{point, point, point}}, nearest.point_error);
            };
            RC_ASSERT(is_on(a, nearest.triangles.a, poses.a, nearest.point_a));
            RC_ASSERT(is_on(b, nearest.triangles.b, poses.b, nearest.point_b));
            ++(nearest.distance == 0 ? meeting : apart);
        }
    }));
    CHECK(meeting > 20);
    CHECK(apart > 20);
}

TEST_CASE("a distance below a length is found exactly where there is one") {
    const mesh a = ripples(8), b = in_doubles(ripples(8), 0);
    for (const strategy_info& tree : strategies(strategy_kind::tree)) {
        CAPTURE(tree.name);
        const auto stage = compose_distance(composed({{strategy_kind::tree, tree.name.c_str()}}));
        stage->add_model(a);
        stage->add_model(b);
        for (const double height : {1e-9, 2.5, 40.0}) {
            const pose above = turned_by({1, 0.1, 0.2, 0}, {0, 0, height + 6});
            const mesh_distance nearest = stage->distance(0, {}, 1, above);
            REQUIRE(nearest.distance > 0);
            const double beyond = nearest.distance + 4 * nearest.error;
            CHECK_FALSE(stage->distance_below(0, {}, 1, above, nearest.distance - 2 * nearest.error).has_value());
            CHECK_FALSE(stage->distance_below(0, {}, 1, above, 0).has_value());
            const auto below = stage->distance_below(0, {}, 1, above, beyond);
            REQUIRE(below.has_value());
            CHECK(std::abs(below->distance - nearest.distance) <= below->error + nearest.error);
        }
        CHECK(stage->distance_below(0, {}, 0, {}, 1e-300)->distance == 0);
    }
}

TEST_CASE("distances far below and above one are measured, and what exceeds the range of double is rejected") {
    for (const double size : {0x1p-1060, 1e-300, 1e-62, 1e62, 1e300}) {
        CAPTURE(size);
        mesh m = tetrahedron(1);
        pose small, beside;
        for (pose* const p : {&small, &beside})
            for (std::size_t k = 0; k < 3; ++k) p->rotation[4 * k] = size;
        beside.translation = {4 * size, -4 * size, 0};
        const auto stage = compose_distance(composed({}));
        stage->add_model(m);
        // From (1, 0, 0) to (4, -3, 0), in units of the size.
        const mesh_distance nearest = stage->distance(0, small, 0, beside);
        CHECK(std::abs(nearest.distance - std::sqrt(18.0) * size) <= 1e-14 * size + nearest.error);
        CHECK(nearest.error <= 1e-14 * size + 1e-323);
        CHECK(std::abs(nearest.point_a[0] - size) <= nearest.point_error);
        CHECK(std::abs(nearest.point_b[1] + 3 * size) <= nearest.point_error);
        CHECK(nearest.point_error <= 1e-13 * size + 1e-320);
    }
    mesh m = tetrahedron(1);
    const auto stage = compose_distance(composed({}));
    stage->add_model(m);
    constexpr double most = std::numeric_limits<double>::max();
    CHECK_REFUSED(stage->distance(0, shifted({-most, 0, 0}), 0, shifted({most, 0, 0})),
                  "the distance of the meshes, or where it is, exceeds the range of double");
}

TEST_CASE("a detector composed at compile time finds triangles and boxes within a distance") {
    using search = global_search<bucket_sort, columns_partition, simd_sweep>;
    const mesh tetra = tetrahedron(1);
    constexpr double d = 0.5;
    detector<prepared_search<grow_boxes, search>, within_detection<median_build, implicit_tree>> meshes(
        {tetra}, {0, 0, 0}, prepared_search<grow_boxes, search>(grow_boxes{d}),
        within_detection<median_build, implicit_tree>(d));
    const std::vector<pose> poses{shifted({0, 0, 0}), shifted({0, 0, 1.5}), shifted({0, 0, 3.5})};
    std::vector<contact> truth;
    for (std::uint32_t a = 0; a < 3; ++a)
        for (std::uint32_t b = a + 1; b < 3; ++b)
            for (const auto [s, t] : expected(tetra, tetra, {poses[a], poses[b]}, d)) truth.push_back({a, b, s, t});
    REQUIRE(!truth.empty());
    REQUIRE(std::ranges::all_of(truth, [](const contact& c) { return c.a == 0 && c.b == 1; }));
    CHECK(sorted(meshes.contacts(poses)) == truth);

    detector<prepared_search<near_boxes, search>> boxes(prepared_search<near_boxes, search>(near_boxes{5}));
    insert_all(boxes, 3);
    const std::vector<box> frame{cube(0, 1), {{4, 5, 0}, {6, 6, 1}}, {{4, 5.001F, 0}, {6, 7, 1}}};
    CHECK(sorted(boxes.pairs(frame)) == std::vector<index_pair>{{0, 1}, {1, 2}});
}
