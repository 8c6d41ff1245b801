#include <rapidcheck.h>
#include <catch2/generators/catch_generators.hpp>

#include "../meshes.hpp"
#include "../random_poses.hpp"
#include "../triangle_pairs.hpp"

import aabb.strategies;
import aabb.wide_tree;
import aabb.wide_tree.batched_walk;
import aabb.wide_tree.box_images;
import aabb.wide_tree.child_pairs;
import aabb.wide_tree.nearest_walk;
import aabb.wide_tree.triangle_filter;

using namespace aabb;

namespace {

/// Small triangles around a sphere that share no corners.
mesh shell(triangle_pairs::generator& g, std::uint32_t triangles, double radius) {
    std::normal_distribution<double> normal;
    mesh m;
    for (std::uint32_t t = 0; t < triangles; ++t) {
        const std::array<double, 3> at{normal(g), normal(g), normal(g)};
        const double length = std::hypot(at[0], at[1], at[2]);
        triangle3f triangle;
        for (vec3f& v : triangle.corner)
            for (int k = 0; k < 3; ++k)
                v[k] = static_cast<float>(radius * at[static_cast<std::size_t>(k)] / length + 0.02 * normal(g));
        add_triangle(m, triangle[0], triangle[1], triangle[2]);
    }
    return m;
}

/// Two meshes and their trees.
struct two_models {
    two_models(mesh of_a, mesh of_b) : meshes{std::move(of_a), std::move(of_b)} {}

    std::array<mesh, 2> meshes;
    model<implicit_tree> a{meshes[0], median_build()};
    model<implicit_tree> b{meshes[1], median_build()};
};

/// Narrow phase of two models with this triangle test, with counters.
template <class Triangle, class Counters = work_counters>
struct counted_detection : local_detection<implicit_tree, Triangle, Counters> {
    std::vector<index_pair> pairs(const two_models& both, const pose& pose_b = {}) {
        std::vector<index_pair> result;
        this->all_pairs(both.a, {}, both.b, pose_b, result);
        return result;
    }
};

/// One of the nine coordinates, corner by corner.
float in_row(std::size_t row, const triangle3f& t) {
    return t[static_cast<int>(row / 3)][static_cast<int>(row % 3)];
}

/// Stores a triangle in a lane of a block.
void set(triangle_block& block, std::size_t lane, const triangle3f& t) {
    for (std::size_t row = 0; row < 9; ++row) block.corner[row / 3][row % 3][lane] = in_row(row, t);
}

/// As many pairs as a vector has lanes, coordinate by coordinate.
struct pair_vector {
    std::array<std::array<float, simd::width>, 9> a{};
    std::array<std::array<float, simd::width>, 9> b{};

    void fill(triangle_pairs::generator& g, float size) {
        std::uniform_real_distribution<float> coordinate(-1, 1);
        for (auto* rows : {&a, &b})
            for (auto& row : *rows)
                for (float& x : row) x = size * coordinate(g);
    }
    void set(std::size_t lane, const triangle3f& s, const triangle3f& t) {
        for (std::size_t row = 0; row < 9; ++row) {
            a[row][lane] = in_row(row, s);
            b[row][lane] = in_row(row, t);
        }
    }
    [[nodiscard]] filtered_pairs filtered() const {
        return triangle_filter::decide(a[0].data(), b[0].data(), simd::width, vec3f{}.at);
    }
};

float any_float() {
    const float x = *rc::gen::element(0.0F, 1.0F, -1.0F, 1e-3F, 1e-40F, std::numeric_limits<float>::denorm_min(), 1e30F,
                                      -1e30F, std::numeric_limits<float>::max(), -std::numeric_limits<float>::max());
    return *rc::gen::arbitrary<bool>() ? x : static_cast<float>(uniform(-1, 1)) * x;
}

/// Some of the bits, at least one.
std::uint64_t any_bits_of(std::uint64_t bits) {
    const auto draw = [] { return *rc::gen::arbitrary<std::uint64_t>(); };
    const std::uint64_t chosen = bits & *rc::gen::element(~std::uint64_t{0}, draw(), draw() & draw() & draw() & draw());
    return chosen != 0 ? chosen : std::bit_floor(bits);
}

/// Whether both bits are set, and differ if more than one is.
bool are_two_of(std::uint64_t bits, std::uint32_t first, std::uint32_t second) {
    return (bits >> first & bits >> second & 1U) != 0 && (first == second) == (std::popcount(bits) == 1);
}

std::vector<box> any_boxes() {
    std::vector<box> boxes(*rc::gen::inRange<std::size_t>(1, 9));
    // Half the time near 1: with other numbers, few boxes are clearly disjoint.
    const bool is_usual = *rc::gen::arbitrary<bool>();
    const auto number = [&] { return is_usual ? static_cast<float>(uniform(0.5, 1)) : any_float(); };
    const vec3f centre{number(), number(), number()};
    const float size = std::abs(number());
    for (box& b : boxes)
        for (int k = 0; k < 3; ++k) {
            const auto near = [&] {
                const double x = centre[k] + uniform(-1, 1) * size;
                constexpr double most = std::numeric_limits<float>::max();
                return static_cast<float>(std::clamp(x, -most, most));
            };
            const float p = near();
            const float q = *rc::gen::arbitrary<bool>() ? p : near();
            b.min[k] = std::min(p, q);
            b.max[k] = std::max(p, q);
        }
    return boxes;
}

/// A point of the box, often one of its corners.
vec3f point_in(const box& b) {
    vec3f p;
    for (int k = 0; k < 3; ++k) {
        const int where = *rc::gen::inRange(0, 4);
        const double between = b.min[k] + (double{b.max[k]} - b.min[k]) * uniform(0, 1);
        p[k] = where == 0   ? b.min[k]
               : where == 1 ? b.max[k]
                            : std::clamp(static_cast<float>(between), b.min[k], b.max[k]);
    }
    return p;
}

box bounds_of_all(const std::vector<box>& boxes) {
    box bounds = empty_box();
    for (const box& b : boxes) bounds = merged(bounds, b);
    return bounds;
}

/// If there are fewer than eight, the last one fills the rest.
eight_boxes in_eight(const std::vector<box>& boxes) {
    eight_boxes eight{};
    eight.count = static_cast<std::uint32_t>(boxes.size());
    for (std::size_t i = 0; i < eight_boxes::most; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const box& b = boxes[std::min(i, boxes.size() - 1)];
            eight.lower[k][i] = b.min[static_cast<int>(k)];
            eight.upper[k][i] = b.max[static_cast<int>(k)];
        }
    return eight;
}

/// Triangles whose corners are among the last `used` vertices.
mesh any_mesh(std::uint32_t triangles, std::uint32_t vertices, std::uint32_t used, float size) {
    mesh m;
    m.vertices.resize(vertices);
    used = std::min(used, vertices);
    const auto any_number = [&] { return size * static_cast<float>(uniform(-1, 1)); };
    for (std::uint32_t v = vertices - used; v < vertices; ++v)
        m.vertices[v] = {any_number(), any_number(), any_number()};
    const auto any_vertex = [&] {
        return vertices - 1 - std::min(used - 1, static_cast<std::uint32_t>(uniform(0, 1) * used));
    };
    for (std::uint32_t t = 0; t < triangles; ++t) m.triangles.push_back({any_vertex(), any_vertex(), any_vertex()});
    return m;
}

}  // namespace

TEST_CASE("of the boxes of two leaves exactly the overlapping pairs are found") {
    std::size_t overlapping = 0;
    REQUIRE(rc::check([&] {
        const std::vector<box> a = any_boxes();
        // Some share planes with boxes of A.
        std::vector<box> b = any_boxes();
        for (box& box_b : b)
            for (int k = 0; k < 3; ++k) {
                const box& of_a = a[*rc::gen::inRange<std::size_t>(0, a.size())];
                const int what = *rc::gen::inRange(0, 4);
                if (what == 0) box_b.min[k] = box_b.max[k] = of_a.max[k];
                if (what == 1) box_b.min[k] = box_b.max[k] = of_a.min[k];
                if (what == 2) box_b.min[k] = of_a.min[k], box_b.max[k] = of_a.max[k];
            }
        const std::uint64_t mask = in_eight(a).overlaps(in_eight(b));
        for (std::size_t j = 0; j < 8; ++j)
            for (std::size_t i = 0; i < 8; ++i) {
                const bool expected = i < a.size() && j < b.size() && overlaps(a[i], b[j]);
                RC_ASSERT((mask >> (8 * j + i) & 1U) == std::uint64_t{expected});
                overlapping += expected;
            }
    }));
    CHECK(overlapping > 50);
}

TEST_CASE("boxes of leaves in 16 bits overlap where the boxes do, and not where these are some steps apart") {
    std::size_t overlapping = 0;
    std::size_t separate = 0;
    REQUIRE(rc::check([&] {
        const std::vector<box> a = any_boxes();
        std::vector<box> b = any_boxes();
        // Some lie near boxes of A.
        if (*rc::gen::inRange(0, 4) > 0)
            for (box& child : b) {
                const box& of_a = a[*rc::gen::inRange<std::size_t>(0, a.size())];
                for (int k = 0; k < 3; ++k) {
                    const float edge = of_a.max[k] - of_a.min[k];
                    const float low = of_a.min[k] + edge * static_cast<float>(uniform(-1, 1));
                    if (!(std::abs(low) < 1e37F) || !(edge < 1e37F)) continue;
                    child.min[k] = low;
                    child.max[k] = low + edge * static_cast<float>(uniform(0, 1));
                }
            }
        const box box_a = bounds_of_all(a);
        const box box_b = bounds_of_all(b);
        leaf_grid grid;
        grid.begin(box_a, box_b);
        const auto in_grid = [&](const std::vector<box>& boxes) {
            const eight_boxes eight = in_eight(boxes);
            std::array<simd::eight_floats, 6> rows;
            for (std::size_t k = 0; k < 3; ++k) {
                rows[k] = simd::load_eight<simd::eight_floats>(eight.lower[k].data());
                rows[3 + k] = simd::load_eight<simd::eight_floats>(eight.upper[k].data());
            }
            leaf_boxes quantized;
            quantized.quantize(grid, rows, boxes.size());
            return quantized;
        };
        // Along an axis on which floats can distinguish the steps of the grid.
        const auto are_separate = [&](const box& p, const box& q) {
            for (int k = 0; k < 3; ++k) {
                const double low = std::max(box_a.min[k], box_b.min[k]);
                const double high = std::min(box_a.max[k], box_b.max[k]);
                if (!(high - low > 1e-25) || std::max(-low, high) > 16 * (high - low) || high > 1e37) continue;
                const double edge = double{std::max(box_a.max[k], box_b.max[k])} - std::min(box_a.min[k], box_b.min[k]);
                if (edge > 1e30 * (high - low) || edge > 1e37) continue;
                const double begin = std::max(low, double{std::min(p.max[k], q.max[k])});
                const double end = std::min(high, double{std::max(p.min[k], q.min[k])});
                if (end - begin > 2.5 * (high - low) / 65000) return true;
            }
            return false;
        };
        const std::uint64_t mask = in_grid(a).overlaps(in_grid(b));
        for (std::size_t j = 0; j < 8; ++j)
            for (std::size_t i = 0; i < 8; ++i) {
                const bool bit = (mask >> (8 * j + i) & 1U) != 0;
                if (i >= a.size() || j >= b.size()) {
                    RC_ASSERT(!bit);
                    continue;
                }
                if (overlaps(a[i], b[j])) {
                    RC_ASSERT(bit);
                    ++overlapping;
                } else if (are_separate(a[i], b[j])) {
                    RC_ASSERT(!bit);
                    ++separate;
                }
            }
    }));
    CHECK(overlapping > 10);
    CHECK(separate > 50);
}

TEST_CASE("boxes also separate triangles that are much smaller than their meshes") {
    // Rows of crossing triangles, each pair by itself, in meshes a million times as long.
    constexpr std::uint32_t crossing = 800;
    std::array<mesh, 2> meshes;
    for (std::size_t side = 0; side < 2; ++side) {
        const auto add = [&](vec3f p, vec3f q, vec3f r) { add_triangle(meshes[side], p, q, r); };
        for (std::uint32_t i = 0; i < crossing; ++i) {
            const float x = 0.003F * static_cast<float>(i);
            if (side == 0)
                add({x, 0, 0}, {x + 0.001F, 0, 0}, {x, 0.001F, 0});
            else
                add({x + 0.0002F, 0.0002F, -0.001F}, {x + 0.0002F, 0.0002F, 0.001F}, {x + 0.0004F, 0.0002F, 0.001F});
        }
        const float far = side == 0 ? 1000.0F : 900.0F;
        add({far, far, far}, {far, far, far + 1}, {far, far + 1, far});
        add({-far, -far, -far}, {-far, -far, -far - 1}, {-far, -far - 1, -far});
    }
    counted_detection<exact_triangle> detection;
    CHECK(detection.pairs({meshes[0], meshes[1]}).size() == crossing);
    // Those, and some in the leaves of the far triangles.
    CHECK(detection.counters()[work::triangle_tests] < 2 * crossing);
}

TEST_CASE("an inexact test is not run on triangles with disjoint boxes, however close") {
    // The gap is less than a step of 16 bits, and the planes cross; the last triangles make the meshes large.
    const auto tests_with = [&]<class Triangle>(float gap, const Triangle&) {
        std::array<mesh, 2> meshes;
        for (std::size_t side = 0; side < 2; ++side) {
            const auto add = [&](vec3f p, vec3f q, vec3f r) { add_triangle(meshes[side], p, q, r); };
            for (std::uint32_t i = 0; i < 64; ++i) {
                const float y = 3 * static_cast<float>(i);
                if (side == 0)
                    add({0, y, 0}, {1, y, 0}, {1, y + 1, 0});
                else
                    add({1 + gap, y, -1}, {1 + gap, y, 1}, {2 + gap, y + 1, 1});
            }
            const float at = side == 0 ? 1000.0F : 900.0F;
            for (const float far : {at, -at}) add({far, far, far}, {far, far, far + 1}, {far, far + 1, far});
        }
        counted_detection<Triangle> detection;
        detection.pairs({meshes[0], meshes[1]});
        return detection.counters()[work::triangle_tests];
    };
    CHECK(tests_with(0, moller_triangle()) >= 64);
    CHECK(tests_with(0.001F, moller_triangle()) == 0);
    CHECK(tests_with(0.001F, exact_triangle()) > 0);
}

TEST_CASE("a slab leaves out no triangle that intersects one of the leaf, of any shape and size") {
    triangle_pairs::generator g{8};
    std::size_t intersecting = 0;
    for (std::size_t pattern = 0; pattern < triangle_pairs::patterns.size(); ++pattern)
        for (const double size : {1e-42, 1e-30, 1e-14, 1.0, 1e12, 1e30, 1e37}) {
            CAPTURE(triangle_pairs::patterns[pattern], size);
            bool all_inside = true;
            for (int round = 0; round < 50; ++round) {
                std::array<std::array<triangle3f, 8>, 2> sides;
                std::array<triangle_block, 2> blocks{};
                std::array<box, 2> bounds{empty_box(), empty_box()};
                for (std::size_t i = 0; i < 8; ++i) {
                    auto pair = triangle_pairs::patterned(g, pattern);
                    for (std::size_t side = 0; side < 2; ++side) {
                        for (auto& corner : pair[side])
                            for (double& x : corner) x *= size;
                        sides[side][i] = triangle_pairs::as<triangle3f>(pair[side]);
                        bounds[side] = merged(bounds[side], bounds_of(sides[side][i]));
                        set(blocks[side], i, sides[side][i]);
                    }
                }
                if (!overlaps(bounds[0], bounds[1]) || !is_valid(bounds[0]) || !is_valid(bounds[1])) continue;
                const float margin = static_cast<float>(size) * 0.1F;
                const box joint = merged(bounds[0], bounds[1]);
                std::array<float, 3> edges{};
                for (int k = 0; k < 3; ++k)
                    edges[static_cast<std::size_t>(k)] = joint.max[k] - joint.min[k] + 2 * margin;
                leaf_slab slab;
                slab.fit(blocks[0], edges);
                const std::uint32_t inside = slab.triangles_inside(blocks[1]);
                // Before the triangles moved here, by no more than the margin.
                triangle_block before = blocks[1];
                for (auto& corner : before.corner)
                    for (std::size_t k = 0; k < 3; ++k)
                        for (float& x : corner[k]) x -= margin * (k == 0 ? 0.6F : k == 1 ? -0.63F : 0.47F);
                slab.fit(blocks[0], edges, margin);
                const std::uint32_t inside_margin = slab.triangles_inside(before);
                for (std::size_t j = 0; j < 8; ++j)
                    for (std::size_t i = 0; i < 8; ++i) {
                        if (!exact_triangle::intersects(sides[0][i], sides[1][j])) continue;
                        ++intersecting;
                        all_inside &= (inside >> j & inside_margin >> j & 1U) != 0;
                    }
            }
            CHECK(all_inside);
        }
    CHECK(intersecting > 1000);
}

TEST_CASE("a slab leaves out no triangle that touches a plane of large odd coefficients from above") {
    REQUIRE(rc::check([&] {
        // Whole numbers, so that all points lie in the plane; their differences and products are rounded.
        const auto any_number = [](int most) { return *rc::gen::inRange(-most, most + 1); };
        const std::array<int, 3> u{any_number(2000) | 1, any_number(2000) | 1, any_number(2000) | 1};
        const std::array<int, 3> v{any_number(2000) | 1, any_number(2000) | 1, any_number(2000) | 1};
        const std::array<double, 3> normal{static_cast<double>(u[1] * v[2] - u[2] * v[1]),
                                           static_cast<double>(u[2] * v[0] - u[0] * v[2]),
                                           static_cast<double>(u[0] * v[1] - u[1] * v[0])};
        const auto point = [&](int p, int q, std::size_t k) { return static_cast<float>(p * u[k] + q * v[k]); };
        std::array<triangle_block, 2> blocks{};
        for (std::size_t i = 0; i < 8; ++i) {
            const int p = 3 * any_number(200);
            const int q = 3 * any_number(200);
            for (std::size_t k = 0; k < 3; ++k) {
                blocks[0].corner[0][k][i] = point(p, q, k);
                blocks[0].corner[1][k][i] = point(p + 3, q, k);
                blocks[0].corner[2][k][i] = point(p, q + 3, k);
                // From the middle of a triangle upward.
                const float up = normal[k] > 0 ? 1e6F : -1e6F;
                blocks[1].corner[0][k][i] = point(p + 1, q + 1, k);
                blocks[1].corner[1][k][i] = point(p + 1, q + 1, k) + up;
                blocks[1].corner[2][k][i] = point(p + 2, q, k) + up;
            }
        }
        for (triangle_block& b : blocks) b.triangles = 8;
        leaf_slab slab;
        slab.fit(blocks[0], {1e7F, 1e7F, 1e7F});
        RC_ASSERT(slab.triangles_inside(blocks[1]) == 0xff);
    }));
}

TEST_CASE("a slab leaves out parallel triangles whose boxes overlap, of every size") {
    // Long triangles along (1, 1, 1), side by side in a plane.
    const auto sheet = [](float size, float height) {
        triangle_block block{};
        for (std::size_t i = 0; i < 8; ++i) {
            const float at = 0.01F * static_cast<float>(i);
            const float corners[3][3] = {
                {at, -at, height}, {at + 1, 1 - at, height + 1}, {at + 0.51F, 0.49F - at, height + 0.5F}};
            for (std::size_t c = 0; c < 3; ++c)
                for (std::size_t k = 0; k < 3; ++k) block.corner[c][k][i] = size * corners[c][k];
        }
        block.triangles = 8;
        return block;
    };
    for (const float size : {1e-9F, 1.0F, 1e9F}) {
        CAPTURE(size);
        const triangle_block lower = sheet(size, 0);
        const triangle_block upper = sheet(size, 0.001F);
        std::array<eight_boxes, 2> boxes;
        boxes[0].set(lower.bounds(), 8);
        boxes[1].set(upper.bounds(), 8);
        REQUIRE(boxes[0].overlaps(boxes[1]) != 0);
        leaf_slab slab;
        slab.fit(lower, {2 * size, 2 * size, 2 * size});
        CHECK(slab.triangles_inside(lower) == 0xff);
        CHECK(slab.triangles_inside(upper) == 0);
    }
}

TEST_CASE("the filter decides like the exact test, and leaves what rounding puts in doubt undecided") {
    triangle_pairs::generator g{5};
    std::size_t decided = 0;
    for (std::size_t pattern = 0; pattern < triangle_pairs::patterns.size(); ++pattern)
        for (std::size_t placement = 0; placement < triangle_pairs::placements.size(); ++placement) {
            CAPTURE(triangle_pairs::patterns[pattern], triangle_pairs::placements[placement]);
            bool agrees = true;
            for (int round = 0; round < 400; ++round) {
                pair_vector pairs;
                std::uint32_t truth = 0;
                for (std::size_t lane = 0; lane < simd::width; ++lane) {
                    const auto pair =
                        triangle_pairs::placed<float>(g, triangle_pairs::patterned(g, pattern), placement);
                    const triangle3f s = triangle_pairs::as<triangle3f>(pair[0]);
                    const triangle3f t = triangle_pairs::as<triangle3f>(pair[1]);
                    pairs.set(lane, s, t);
                    truth |= static_cast<std::uint32_t>(exact_triangle::intersects(s, t)) << lane;
                }
                const filtered_pairs result = pairs.filtered();
                agrees &= (result.hits & result.undecided) == 0;
                agrees &= result.hits == (truth & ~result.undecided);
                decided += simd::width - static_cast<std::size_t>(std::popcount(result.undecided));
            }
            CHECK(agrees);
        }
    CHECK(decided > 0);
}

TEST_CASE("the filter leaves few generic pairs undecided, of every size") {
    triangle_pairs::generator g{6};
    for (const float size : {1e-9F, 1.0F, 1e9F}) {
        std::size_t undecided = 0;
        std::size_t hits = 0;
        for (int round = 0; round < 2000; ++round) {
            pair_vector pairs;
            pairs.fill(g, size);
            const filtered_pairs result = pairs.filtered();
            undecided += static_cast<std::size_t>(std::popcount(result.undecided));
            hits += static_cast<std::size_t>(std::popcount(result.hits));
        }
        CAPTURE(size);
        CHECK(undecided * 1000 < 2000 * simd::width);
        CHECK(hits > 100 * simd::width);
    }
}

TEST_CASE("the filter decides neighbours that share any corner, of every size") {
    triangle_pairs::generator g{7};
    for (const float size : {1e-45F, 1e-30F, 1.0F, 1e30F, 3e38F})
        for (std::size_t corner_a = 0; corner_a < 3; ++corner_a)
            for (std::size_t corner_b = 0; corner_b < 3; ++corner_b) {
                pair_vector pairs;
                pairs.fill(g, size);
                for (std::size_t k = 0; k < 3; ++k) pairs.b[3 * corner_b + k] = pairs.a[3 * corner_a + k];
                CAPTURE(size, corner_a, corner_b);
                CHECK(pairs.filtered().hits == simd::every_lane);
            }
}

TEST_CASE("a wide node contains its children's boxes, of any size and in any place") {
    REQUIRE(rc::check([] {
        const std::vector<box> boxes = any_boxes();
        wide_node n{};
        n.encode(boxes);
        RC_ASSERT(n.children == boxes.size());
        const box bounds = bounds_of_all(boxes);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const box decoded = n.child(i);
            RC_ASSERT(contains(decoded, boxes[i]));
            // No plane is further out than 1/64 of the node, or than the rounding of floats there.
            for (int k = 0; k < 3; ++k) {
                const double step =
                    std::max((double{bounds.max[k]} - bounds.min[k]) / 64,
                             std::max(std::abs(double{bounds.min[k]}), std::abs(double{bounds.max[k]})) * 0x1p-20);
                RC_ASSERT(double{boxes[i].min[k]} - decoded.min[k] <= step + 0x1p-125);
                RC_ASSERT(double{decoded.max[k]} - boxes[i].max[k] <= step + 0x1p-125);
            }
        }
    }));
}

TEST_CASE("all children of a wide node whose boxes overlap another box are found, and none a step from it") {
    std::size_t inside = 0, outside = 0;
    REQUIRE(rc::check([&] {
        const std::vector<box> boxes = any_boxes();
        wide_node n{};
        n.encode(boxes);
        std::vector<box> regions = any_boxes();
        for (const box& b : boxes) {
            // At a corner of the box, and beyond it by little.
            regions.push_back({b.max, b.max});
            box beside{b.min, b.min};
            const int k = *rc::gen::inRange(0, 3);
            beside.min[k] = beside.max[k] = std::nextafter(b.min[k], -std::numeric_limits<float>::max());
            regions.push_back(beside);
        }
        for (const box& region : regions) {
            const std::uint32_t found = n.children_in(region);
            RC_ASSERT(found >> boxes.size() == 0U);
            for (std::size_t i = 0; i < boxes.size(); ++i) {
                const bool is_found = (found >> i & 1U) != 0;
                if (overlaps(n.child(i), region)) RC_ASSERT(is_found);
                for (int k = 0; k < 3 && is_found; ++k) {
                    const double step = n.step(static_cast<std::size_t>(k));
                    RC_ASSERT(double{region.min[k]} - n.child(i).max[k] < step);
                    RC_ASSERT(double{n.child(i).min[k]} - region.max[k] < step);
                }
                ++(is_found ? inside : outside);
            }
        }
    }));
    CHECK(inside > 100);
    CHECK(outside > 100);
}

TEST_CASE("overlapping children are found under any rotation of the nodes") {
    std::size_t overlapping = 0;
    std::size_t separate = 0;
    std::size_t separate_in_b = 0;
    REQUIRE(rc::check([&] {
        const std::vector<box> b = any_boxes();
        const double far = *rc::gen::element(0.0, 1.0, 1e3);
        const pose pose_b =
            *rc::gen::arbitrary<bool>() ? any_turned(any_vector(far)) : turned_up_to(0, any_vector(far));
        const auto is_representable = [&]() -> bool {
            try {
                static_cast<void>(relative_pose({}, pose_b, bounds_of_all(b)));
                return true;
            } catch (const input_error&) {
                return false;
            }
        };
        RC_PRE(is_representable());
        const relative_pose to_a({}, pose_b, bounds_of_all(b));
        wide_node node_b{};
        node_b.encode(b);
        // Children of A are drawn around images of points of B's, so that many just touch.
        std::vector<box> a(*rc::gen::inRange<std::size_t>(1, 9));
        const float size = *rc::gen::element(0.0F, 1e-3F, 1.0F, 1e20F);
        for (box& child_a : a) {
            const vec3f image = to_a(point_in(b[*rc::gen::inRange<std::size_t>(0, b.size())]));
            child_a = bounds_of(image);
            for (int k = 0; k < 3; ++k) {
                constexpr float most = std::numeric_limits<float>::max();
                child_a.min[k] = std::max(-most, child_a.min[k] - size * static_cast<float>(uniform(-0.5, 1)));
                child_a.max[k] = std::min(
                    most, std::max(child_a.min[k], child_a.max[k] + size * static_cast<float>(uniform(-0.5, 1))));
            }
        }
        wide_node node_a{};
        node_a.encode(a);
        eight_boxes images{};
        box_images to_other;
        to_other.begin(to_a.to_boxes());
        to_other.store(node_b, images);
        const std::uint64_t in_a = node_a.planes.overlaps(node_a.grid(), images);
        to_other.begin(to_a.back_to_boxes(bounds_of_all(a)));
        to_other.store(node_a, images);
        const std::uint64_t in_b = node_b.planes.overlaps(node_b.grid(), images);
        for (int sample = 0; sample < 40; ++sample) {
            const auto j = *rc::gen::inRange<std::size_t>(0, b.size());
            const box image = bounds_of(to_a(point_in(b[j])));
            for (std::size_t i = 0; i < a.size(); ++i) {
                const bool bit = in_a >> (8 * j + i) & 1U;
                if (overlaps(a[i], image)) RC_ASSERT(bit);
                if (overlaps(a[i], image)) RC_ASSERT(in_b >> (8 * i + j) & 1U);
                overlapping += overlaps(a[i], image);
                separate += !bit;
                separate_in_b += (in_b >> (8 * i + j) & 1U) == 0;
            }
        }
        // Missing children overlap nothing.
        for (std::size_t j = 0; j < 8; ++j)
            for (std::size_t i = 0; i < 8; ++i)
                if (i >= a.size() || j >= b.size()) RC_ASSERT(((in_a >> (8 * j + i) | in_b >> (8 * i + j)) & 1U) == 0);
    }));
    CHECK(overlapping > 500);
    CHECK(separate > 1000);
    CHECK(separate_in_b > 1000);
}

TEST_CASE("find_two_nearest finds the two pairs with the nearest centres") {
    CHECK(rc::check([] {
        std::vector<box> children;
        eight_boxes others{};
        others.count = 8;
        const auto at = [] { return static_cast<float>(*rc::gen::inRange(-1000, 1000)); };
        for (std::size_t i = 0; i < 8; ++i) {
            const vec3f corner{at(), at(), at()};
            children.push_back({corner, corner});
            for (std::size_t k = 0; k < 3; ++k) others.lower[k][i] = others.upper[k][i] = at();
        }
        wide_node node{};
        node.encode(children);
        const std::uint64_t candidates = any_bits_of(~std::uint64_t{0});
        const auto distance = [&](std::uint32_t p) {
            double sum = 0;
            const box child = node.child(p & 7U);
            for (int k = 0; k < 3; ++k) {
                const double difference =
                    (double{child.min[k]} + child.max[k]) / 2 - others.lower[static_cast<std::size_t>(k)][p >> 3U];
                sum += difference * difference;
            }
            return sum;
        };
        const auto [first, second] = find_two_nearest(candidates, node, others);
        RC_ASSERT(are_two_of(candidates, first, second));
        const auto is_nearer = [&](std::uint32_t p, std::uint32_t q) {
            return distance(p) <= distance(q) * (1 + 1e-4) + 1e-6;
        };
        RC_ASSERT(is_nearer(first, second));
        for (std::uint32_t p = 0; p < 64; ++p)
            if ((candidates >> p & 1U) != 0 && p != first) RC_ASSERT(is_nearer(second, p));
    }));
}

TEST_CASE("find_two_nearest finds two pairs for boxes of any size, at any distance") {
    CHECK(rc::check([] {
        const std::vector<box> children = any_boxes();
        const std::vector<box> boxes = any_boxes();
        wide_node node{};
        node.encode(children);
        std::uint64_t pairs = 0;
        for (std::size_t j = 0; j < boxes.size(); ++j)
            for (std::size_t i = 0; i < children.size(); ++i) pairs |= std::uint64_t{1} << (8 * j + i);
        const std::uint64_t candidates = any_bits_of(pairs);
        const auto [first, second] = find_two_nearest(candidates, node, in_eight(boxes));
        RC_ASSERT(are_two_of(candidates, first, second));
    }));
}

TEST_CASE("the first pair is found where there are hardly any pairs") {
    // The meshes are brought together until they barely touch.
    triangle_pairs::generator g{10};
    const two_models both(shell(g, 3000, 1), shell(g, GENERATE(3000U, 300U), 1));
    counted_detection<exact_triangle, no_counters> detection;
    std::size_t few = 0;
    std::size_t wrong = 0;
    for (int turn = 0; turn < 40; ++turn) {
        double touching = 0;
        double disjoint = 4;
        for (int step = 0; step < 16; ++step) {
            const double middle = (touching + disjoint) / 2;
            const pose pose_b = turned_by({1, 0.3 * turn, 0.1, 0.7}, {middle, 0.01 * turn, 0});
            const std::vector<index_pair> pairs = detection.pairs(both, pose_b);
            const auto first = detection.first_pair(both.a, {}, both.b, pose_b);
            wrong += first ? std::ranges::count(pairs, *first) != 1 : !pairs.empty();
            few += !pairs.empty() && pairs.size() < 4;
            (pairs.empty() ? disjoint : touching) = middle;
        }
    }
    CHECK(few > 50);
    CHECK(wrong == 0);
}

TEST_CASE("the search for the first pair opens few nodes, the nearest first") {
    triangle_pairs::generator g{12};
    const two_models both(shell(g, 20000, 1), shell(g, 20000, 1));
    counted_detection<exact_triangle> detection;
    constexpr int turns = 100;
    for (int turn = 0; turn < turns; ++turn)
        REQUIRE(detection.first_pair(both.a, {}, both.b, turned_by({1, 0.3 * turn, 0.1, 0.7}, {0.02 * turn, 0.1, 0})));
    const double visits = static_cast<double>(detection.counters()[work::node_visits]) / turns;
    CHECK(visits < 8);
}

TEST_CASE("if no triangles intersect, first_pair opens as many nodes as all_pairs") {
    triangle_pairs::generator g{11};
    for (const std::uint32_t of_a : {9U, 300U, 3000U})
        for (const std::uint32_t of_b : {9U, 300U, 3000U}) {
            CAPTURE(of_a, of_b);
            const two_models both(shell(g, of_a, 1), shell(g, of_b, 1.2));
            counted_detection<exact_triangle> for_first;
            counted_detection<exact_triangle> for_all;
            CHECK_FALSE(for_first.first_pair(both.a, {}, both.b, {}));
            CHECK(for_all.pairs(both).empty());
            CHECK(for_first.counters()[work::node_visits] == for_all.counters()[work::node_visits]);
        }
}

TEST_CASE("collecting pairs of leaves within a margin stops at the first pair over the limit") {
    triangle_pairs::generator g{12};
    const two_models both(shell(g, 3000, 1), shell(g, 3000, 1));
    const relative_pose to_a({}, {}, both.b.bounds());
    batched_walk<implicit_tree, exact_triangle, no_counters> walk;
    std::vector<front_pair> all_pairs;
    REQUIRE(walk.collect_front(both.a, both.b, to_a, 0.1, std::numeric_limits<std::size_t>::max(), all_pairs));
    REQUIRE(all_pairs.size() > 1000);
    for (const std::size_t limit : {std::size_t{0}, std::size_t{1}, std::size_t{64}, all_pairs.size() - 1}) {
        CAPTURE(limit);
        std::vector<front_pair> pairs;
        CHECK_FALSE(walk.collect_front(both.a, both.b, to_a, 0.1, limit, pairs));
        CHECK(pairs.size() == limit + 1);
    }
    std::vector<front_pair> repeated;
    CHECK(walk.collect_front(both.a, both.b, to_a, 0.1, all_pairs.size(), repeated));
    CHECK(repeated.size() == all_pairs.size());
}

TEST_CASE("a box that is the image of a vertex contains the vertex when transformed back") {
    triangle_pairs::generator g{9};
    std::uniform_real_distribution<double> unit(-1, 1);
    const box bounds{{-1, -1, -1}, {1, 1, 1}};
    const auto on_grid = [](float x) { return (std::bit_cast<std::uint32_t>(x) & 7U) == 0; };
    for (const double far : {0.0, 1.0, 1e3, 1e6}) {
        CAPTURE(far);
        std::size_t contained = 0;
        std::size_t images = 0;
        while (images < 50) {
            const pose pose_b =
                turned_by({1 + unit(g), unit(g), unit(g), unit(g)}, {far * unit(g), far * unit(g), far * unit(g)});
            const relative_pose to_a({}, pose_b, bounds);
            const vec3f x{static_cast<float>(unit(g)), static_cast<float>(unit(g)), static_cast<float>(unit(g))};
            const vec3f image = to_a(x);
            // Only on the grid is a box that is encoded around the image no larger than it.
            if (!on_grid(image[0]) || !on_grid(image[1]) || !on_grid(image[2])) continue;
            ++images;
            wide_node node{};
            node.encode(std::array{bounds_of(image)});
            eight_boxes in_b{};
            box_images to_b;
            to_b.begin(to_a.back_to_boxes(bounds_of(image)));
            to_b.store(node, in_b);
            bool is_contained = true;
            for (std::size_t k = 0; k < 3; ++k) {
                const auto axis = static_cast<int>(k);
                is_contained &= node.child(0).min[axis] == image[axis] && node.child(0).max[axis] == image[axis];
                is_contained &= in_b.lower[k][0] <= x[axis] && x[axis] <= in_b.upper[k][0];
            }
            contained += is_contained;
        }
        CHECK(contained == images);
    }
}

TEST_CASE("a leaf's triangles are loaded and transformed as they are one by one, with exact bounds") {
    REQUIRE(rc::check([] {
        const auto any_pose = [&] {
            pose p = any_turned(any_vector(1));
            if (*rc::gen::arbitrary<bool>()) p.rotation = pose{}.rotation;
            if (*rc::gen::arbitrary<bool>()) p.translation = pose{}.translation;
            return p;
        };
        const pose pose_a = any_pose();
        const pose pose_b = any_pose();
        const float size = *rc::gen::element(1e-30F, 1.0F, 1e30F);
        // More than sixteen vertices are not listed. Indices take one to three bytes.
        const mesh m = any_mesh(*rc::gen::inRange<std::uint32_t>(1, 20),
                                *rc::gen::element<std::uint32_t>(1, 3, 9, 256, 257, 65536, 100000),
                                *rc::gen::element<std::uint32_t>(12, 40), size);
        const relative_pose to_a(pose_a, pose_b, bounds_of(m));
        for (const auto vertices : {implicit_tree::vertex_choice::listed, implicit_tree::vertex_choice::fetched}) {
            const model<aabb::implicit_tree> built(m, aabb::median_build(), implicit_tree({vertices}));
            for (std::uint32_t leaf = 0; 8 * leaf < m.triangle_count(); ++leaf) {
                const std::uint32_t triangles = std::min(8U, m.triangle_count() - 8 * leaf);
                vertex_list list;
                built.tree().read_vertices(leaf, list);
                triangle_block block;
                block.load(m, built.tree(), leaf, list);
                triangle_block transformed;
                transformed.load(m, built.tree(), leaf, list, to_a);
                const auto bounds = transformed.bounds();
                RC_ASSERT(transformed.triangles == triangles);
                for (std::uint32_t i = 0; i < 8; ++i) {
                    const triangle3f t = m.triangle(built.tree().triangle_at(8 * leaf + std::min(i, triangles - 1)));
                    const triangle3f image = to_a(t);
                    const box image_bounds = bounds_of(image);
                    for (std::size_t row = 0; row < 9; ++row) {
                        RC_ASSERT(block.corner[row / 3][row % 3][i] == in_row(row, t));
                        RC_ASSERT(transformed.corner[row / 3][row % 3][i] == in_row(row, image));
                    }
                    for (int k = 0; k < 3; ++k) {
                        RC_ASSERT(bounds[static_cast<std::size_t>(k)][i] == image_bounds.min[k]);
                        RC_ASSERT(bounds[static_cast<std::size_t>(k) + 3][i] == image_bounds.max[k]);
                    }
                }
            }
        }
    }));
}

TEST_CASE("a batch of node pairs has the overlapping children of each pair, in order") {
    std::size_t rotated = 0;
    REQUIRE(rc::check([&] {
        const pose pose_b = any_turned(any_vector(1));
        // Up to more nodes than the cache holds images.
        const std::uint32_t triangles = *rc::gen::element<std::uint32_t>(9, 700, 3000);
        const mesh m = any_mesh(triangles, 300, 300, 1);
        const two_models both(m, m);
        const auto& [meshes, a, b] = both;
        const relative_pose to_a({}, pose_b, b.bounds());
        rotated += to_a.growth() > 1.2;
        const auto nodes = [](const model<implicit_tree>& t) { return (t.triangles().triangle_count() + 63) / 64; };
        const wide_node* const of_a = a.tree().level(0);
        const wide_node* const of_b = b.tree().level(0);
        std::vector<std::uint32_t> nodes_a(*rc::gen::inRange<std::size_t>(0, 65));
        std::vector<std::uint32_t> nodes_b(nodes_a.size());
        for (std::uint32_t& n : nodes_a) n = *rc::gen::inRange<std::uint32_t>(0, nodes(a));
        for (std::uint32_t& n : nodes_b) n = *rc::gen::inRange<std::uint32_t>(0, nodes(b));
        no_counters counters;
        child_pairs<implicit_tree> batch;
        batch.begin(a.tree(), b.tree(), to_a, a.bounds(), 0);
        const auto pairs = batch.find_overlapping(of_a, nodes_a, of_b, nodes_b, counters);
        std::size_t next = 0;
        for (std::size_t p = 0; p < nodes_a.size(); ++p) {
            child_pairs<implicit_tree> single;
            single.begin(a.tree(), b.tree(), to_a, a.bounds(), 0);
            const auto expected = single.find_overlapping(of_a, std::span(nodes_a).subspan(p, 1), of_b,
                                                          std::span(nodes_b).subspan(p, 1), counters);
            if (expected.empty()) continue;
            RC_ASSERT(next < pairs.size());
            RC_ASSERT(pairs[next].pair == p);
            RC_ASSERT(pairs[next].mask == expected[0].mask);
            ++next;
        }
        RC_ASSERT(next == pairs.size());
    }));
    CHECK(rotated > 20);
}
