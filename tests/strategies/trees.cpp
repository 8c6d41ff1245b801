#include <random>

#include "../compositions.hpp"
#include "../meshes.hpp"

import aabb.strategies;
import aabb.tree.leafless_config;
import aabb.wide_tree;

using namespace aabb;

namespace {

/// A wavy sheet of 2 n² triangles, with a few of them repeated and a few of zero area.
mesh sheet(std::uint32_t n) {
    mesh m = sheet_of(n, [](std::uint32_t i, std::uint32_t j) -> vec3f {
        return {static_cast<float>(i), static_cast<float>(j), static_cast<float>((i * 7 + j * 13) % 5)};
    });
    m.triangles.push_back(m.triangles[0]);
    m.triangles.push_back({0, 0, 1});
    return m;
}

void for_each_build(const auto& check) {
    [&]<class... Builds>(type_list<Builds...>) { (check(Builds{}), ...); }(builds{});
}

void for_each_tree(const auto& check) {
    [&]<class... Trees>(type_list<Trees...>) { (check(type_list<Trees>{}), ...); }(trees{});
}

/// The content of a node.
auto content_of(const build_node& n) {
    return std::tuple(n.bounds, n.right, n.is_leaf() ? n.triangle : 0);
}

mesh equal_triangles(std::uint32_t n) {
    return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {n, {0, 1, 2}}};
}

/// Points, each several times as far out as the one before: a mean split peels them off one by one.
mesh receding(std::uint32_t n) {
    mesh m;
    for (std::uint32_t i = 0; i < n; ++i) {
        m.vertices.push_back({std::ldexp(1.0F, static_cast<int>(i * 240 / n) - 120), 0, 0});
        m.triangles.push_back({i, i, i});
    }
    return m;
}

/// Slivers from the origin, each a little shorter than the one before, with its centroid in its middle: a midpoint
/// split peels them off one by one.
mesh nested(std::uint32_t n) {
    mesh m;
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto length = static_cast<float>(2 * (n - i));
        add_triangle(m, {0, 0, 0}, {length, 0, 0}, {length / 2, 0, 0});
    }
    return m;
}

/// The first n triangles of a sheet, for every small n.
mesh strip(std::uint32_t n) {
    mesh m = sheet(10);
    m.triangles.resize(n);
    return m;
}

std::vector<mesh> meshes() {
    std::vector<mesh> result = {sheet(9),     sheet(40),     equal_triangles(3), equal_triangles(1000),
                                receding(61), receding(500), nested(300)};
    for (std::uint32_t n = 1; n <= 40; ++n) result.push_back(strip(n));
    return result;
}

/// Every build of every layout, with the exact triangle test.
std::vector<composition> all_trees(bool exact_only = false) {
    std::vector<composition> compositions;
    for (const strategy_choice& build : all_choices(strategy_kind::build))
        for (const strategy_choice& tree : all_choices(strategy_kind::tree)) {
            composition& c = compositions.emplace_back();
            c[strategy_kind::build] = build;
            c[strategy_kind::tree] = tree;
        }
    if (exact_only) std::erase_if(compositions, [](const composition& c) { return !is_exact_locally(c); });
    return compositions;
}

std::size_t tree_bytes_of(const local_stage& stage) {
    std::size_t sum = 0;
    for (const part_bytes& part : stage.bytes())
        if (part.part == "nodes" || part.part == "indices") sum += part.bytes;
    return sum;
}

std::unique_ptr<local_stage> stage_of(const composition& c, const mesh& m) {
    auto stage = local_of(c, instrumentation::counters);
    stage->add_model(m);
    return stage;
}

std::size_t bytes_of_tree(const strategy_choice& tree, const mesh& m, const strategy_choice& build = {"median", {}}) {
    composition c = composed({});
    c[strategy_kind::tree] = tree;
    c[strategy_kind::build] = build;
    return tree_bytes_of(*stage_of(c, m));
}

/// Moves every other vertex, and with them most boxes.
void deform(mesh& m) {
    for (std::size_t v = 0; v < m.vertices.size(); v += 2) {
        m.vertices[v][0] += 0.75F;
        m.vertices[v][2] -= static_cast<float>(v % 7);
    }
}

bool is_lossless(const strategy_choice& tree) {
    return tree.name != "compressed_literal" && tree.name != "quantized" && tree.name != "implicit";
}

void check(const local_stage& stage, const composition& c, const mesh& m) {
    INFO(text_of_local(c) << ", " << m.triangle_count() << " triangles");
    const std::optional<tree_validation> validation = stage.validate_tree(0);
    REQUIRE(validation.has_value());
    CHECK(validation->fault.empty());
    if (is_lossless(c[strategy_kind::tree])) CHECK(validation->tight);
    CHECK(validation->area_inflation >= 0);
    const auto least_depth = static_cast<std::size_t>(std::bit_width(m.triangle_count() - 1U));
    CHECK(validation->depth >= least_depth);
    if (c[strategy_kind::build].name == "median") CHECK(validation->depth == least_depth);
}

bool same_nodes(const implicit_tree& a, const implicit_tree& b) {
    const std::size_t bytes = a.bytes().nodes;
    return bytes == b.bytes().nodes && a.levels() == b.levels() && std::memcmp(a.level(0), b.level(0), bytes) == 0;
}

/// Boxes within another one, some of them flat, one around it, one at its corner, and one far away.
std::vector<box> regions_of(const box& whole) {
    constexpr float infinity = std::numeric_limits<float>::infinity();
    std::vector<box> regions{whole, {whole.max, whole.max}, {{1e30F, 0, 0}, {1e30F, 1, 1}}};
    regions.push_back({{-infinity, 0, 0}, {infinity, 1, 1}});
    std::mt19937 random(57);
    for (int i = 0; i < 30; ++i) {
        box region;
        for (int k = 0; k < 3; ++k) {
            const auto part = [&] { return static_cast<float>(random()) * 0x1p-32F * (whole.max[k] - whole.min[k]); };
            region.min[k] = whole.min[k] + part();
            region.max[k] = region.min[k] + (i % 3 == k ? 0 : part() / 4);
        }
        regions.push_back(region);
    }
    return regions;
}

template <class Tree>
void check_triangles_in_boxes(const model<Tree>& m) {
    for (const box& region : regions_of(bounds_of(m.triangles()))) {
        std::vector<std::uint32_t> expected, found;
        for (std::uint32_t t = 0; t < m.triangles().triangle_count(); ++t)
            if (overlaps(bounds_of(m.triangles().triangle(t)), region)) expected.push_back(t);
        each_triangle_in(m, region, [&](std::uint32_t t) {
            found.push_back(t);
            return false;
        });
        std::ranges::sort(found);
        CHECK(std::ranges::adjacent_find(found) == found.end());
        CHECK(std::ranges::includes(found, expected));
        if constexpr (WideTreePolicy<Tree>) CHECK(found == expected);
        std::size_t taken = 0;
        each_triangle_in(m, region, [&](std::uint32_t) { return ++taken == 1; });
        CHECK(taken == std::min<std::size_t>(1, found.size()));
    }
}

std::tuple<std::uint32_t, std::array<std::uint32_t, 3>, std::vector<std::uint32_t>> parts_of(const vertex_list& list) {
    return {list.count, list.positions, {list.vertices.begin(), list.vertices.begin() + list.count}};
}

}  // namespace

TEST_CASE("a tree holds every triangle once, has the least depth if balanced, and keeps its size if refitted",
          "[long]") {
    for (const composition& tree : all_trees())
        for (mesh m : meshes()) {
            const auto stage = stage_of(tree, m);
            check(*stage, tree, m);
            const std::size_t bytes = tree_bytes_of(*stage);
            deform(m);
            stage->refit(0);
            check(*stage, tree, m);
            CHECK(tree_bytes_of(*stage) == bytes);
        }
}

TEST_CASE("through every tree, each triangle whose box overlaps another box is found once, also after a refit") {
    for (const mesh& m : {sheet(9), sheet(40), equal_triangles(3), equal_triangles(1000), receding(500), nested(70),
                          strip(1), strip(8), strip(9)})
        for (const strategy_choice& tree : all_choices(strategy_kind::tree)) {
            CAPTURE(to_text(tree), m.triangle_count());
            bool is_checked = false;
            for_each_tree([&]<class Tree>(type_list<Tree>) {
                if (Tree::name != tree.name) return;
                mesh moved = m;
                model of_mesh(moved, median_build(), make_strategy<Tree>(configured<Tree>(tree.settings)));
                check_triangles_in_boxes(of_mesh);
                deform(moved);
                std::vector<box> boxes;
                of_mesh.refit(boxes);
                check_triangles_in_boxes(of_mesh);
                is_checked = true;
            });
            CHECK(is_checked);
        }
}

TEST_CASE("a refit rejects meshes with fewer triangles or invalid vertices") {
    for (const composition& tree : all_trees()) {
        mesh m = strip(7);
        const auto stage = stage_of(tree, m);
        m.vertices[0][1] = NAN;
        CHECK_REFUSED(stage->refit(0), "vertex 0 has a coordinate that is not finite");
        m.vertices[0][1] = 0;
        m.triangles.pop_back();
        CHECK_REFUSED(stage->refit(0), "a deforming mesh must keep its triangles: there were 7, now there are 6");
    }
}

TEST_CASE("queries find all pairs in deep trees and in trees of equal triangles") {
    for (const composition& tree : all_trees(true)) {
        INFO(text_of_local(tree));
        const mesh points = receding(300);
        const mesh equal = equal_triangles(60);
        const mesh slivers = nested(300);
        const auto stage = stage_of(tree, points);
        stage->add_model(equal);
        stage->add_model(slivers);
        std::vector<index_pair> pairs;
        stage->self_pairs(1, pairs);
        CHECK(pairs.size() == 60 * 59 / 2);
        CHECK(stage->count_pairs(1, {}, 1, shifted({0, 0.25, 0})) == 60 * 60);
        // Of the points on the ray from the origin, those that are no further than 1 lie in the triangle's edge.
        const auto near = std::ranges::count_if(points.vertices, [](const vec3f& p) { return p[0] <= 1; });
        CHECK(stage->count_pairs(0, {}, 1, {}) == static_cast<std::uint64_t>(60 * near));
        // All slivers start in a corner of every triangle.
        CHECK(stage->count_pairs(1, {}, 2, {}) == 60 * 300);
        pairs.clear();
        stage->self_pairs(2, pairs);
        CHECK(pairs.size() == 300 * 299 / 2);
    }
}

TEST_CASE("the intermediate layouts hold the canonical tree, box by box") {
    for_each_build([&](const auto& build) {
        for (const mesh& m : meshes()) {
            const std::vector<build_node> nodes = build.build(m, leaf_arrangement::any);
            canonical_tree canonical;
            canonical.pack(nodes);
            const auto same = [&](auto self, const auto& other, auto node, auto twin, bool lossless) -> void {
                REQUIRE(canonical.is_leaf(node) == other.is_leaf(twin));
                if (canonical.is_leaf(node)) {
                    REQUIRE(canonical.triangle(node) == other.triangle(twin));
                    if (other.has_leaf_boxes) REQUIRE(canonical.bounds(node) == other.bounds(twin));
                    return;
                }
                if (lossless) REQUIRE(canonical.bounds(node) == other.bounds(twin));
                REQUIRE(contains(other.bounds(twin), canonical.bounds(node)));
                const auto children = canonical.children(node, m);
                const auto twins = other.children(twin, m);
                for (std::size_t side = 0; side < 2; ++side) self(self, other, children[side], twins[side], lossless);
            };
            const auto check_packed = [&](auto other, bool lossless) {
                other.pack(nodes);
                same(same, other, canonical.root(m), other.root(m), lossless);
            };
            check_packed(shared_planes_tree(), true);
            check_packed(leafless_tree(), true);
            check_packed(compressed_literal_tree(), false);
        }
    });
}

TEST_CASE("layouts take at most the bytes that the paper states") {
    for (std::uint32_t n = 2; n <= 60; ++n) {
        const mesh m = strip(n);
        INFO(n << " triangles");
        CHECK(bytes_of_tree({"canonical", {}}, m) == 32 * (n - 1) + 28 * n);
        CHECK(bytes_of_tree({"leafless", {}}, m) == 32 * (n - 1));
        CHECK(bytes_of_tree({"shared_planes", {}}, m) == 37 * n - 33 + 24);
        CHECK(bytes_of_tree({"compressed_literal", {}}, m) == 21 * (n - 1) + 24);
        for (const strategy_choice& build : all_choices(strategy_kind::build)) {
            // Even: half as many nodes hold two leaves, 8 bytes; the others 33. Odd: one leaf is the sibling of a node.
            const std::size_t pairs = n / 2;
            CHECK(bytes_of_tree({"compressed", {}}, m, build) == 8 * pairs + 33 * (n - 1 - pairs) + 24);
        }
    }
}

TEST_CASE("a balanced sah tree is split across the axis that makes boxes small, not the longest one") {
    for (const std::uint32_t n : {64U, 256U, 4096U}) {
        CAPTURE(n);
        mesh bars;
        for (std::uint32_t i = 0; i < n; ++i) {
            const auto y = static_cast<float>(37 * i % n);
            const auto x = 2 * static_cast<float>(n);
            add_triangle(bars, {-x, y, 0}, {x, y, 0}, {0, y, 0.5F});
        }
        for (const box& leaf : sah_build().order(bars).bounds) CHECK(leaf.max[1] - leaf.min[1] == 7);
        for (const box& leaf : median_build().order(bars).bounds) CHECK(leaf.max[1] - leaf.min[1] > 7);
    }
}

TEST_CASE("a balanced sah tree is built even if nearly all centroids lie at one end") {
    // One large triangle, others in its corner: more than half of them are to go to the left, and lie in the last bin.
    mesh m{{{0, 0, 0}, {1, 0, 1}, {1, 1, 0}}, {{0, 1, 2}}};
    for (int i = 0; i < 128; ++i) {
        const float at = 0.998F + 1e-5F * static_cast<float>(i);
        add_triangle(m, {at, at, at}, {at, at, at + 1e-5F}, {at, at + 1e-5F, at});
    }
    const auto order = sorted(sah_build().order(m).triangles);
    for (std::uint32_t i = 0; i < 129; ++i) CHECK(order[i] == i);
}

TEST_CASE("trees are refitted to meshes with renumbered vertices") {
    for (const composition& tree : all_trees(true)) {
        INFO(text_of_local(tree));
        mesh m = sheet(12);
        const auto stage = stage_of(tree, m);
        const pose aside = shifted({0.3, 0.2, 0.1});
        const std::uint64_t before = stage->count_pairs(0, {}, 0, aside);
        m = numbered_backwards(m);
        stage->refit(0);
        CHECK(before > 0);
        CHECK(stage->count_pairs(0, {}, 0, aside) == before);
    }
}

TEST_CASE("an implicit tree takes 64 bytes per eight leaves or nodes, and log2(n) bits per triangle") {
    for (const std::uint32_t n : {1U, 8U, 9U, 64U, 65U, 1000U}) {
        std::size_t nodes = 0;
        for (std::size_t below = (n + 7) / 8; nodes == 0 || below > 1;) nodes += below = (below + 7) / 8;
        const auto bits = static_cast<std::size_t>(std::bit_width(n - 1));
        INFO(n << " triangles");
        const strategy_choice fetched{"implicit", {{"vertices", "fetched"}}};
        mesh m = strip(n);
        std::ranges::reverse(m.triangles);
        CHECK(bytes_of_tree(fetched, m) == 64 * nodes + (n <= 8 ? 0 : (n * bits + 7) / 8 + 8));
    }
    // Lists of vertices, of two bytes each, on a surface of ordinary shape.
    const mesh m = sheet(100);
    CHECK(bytes_of_tree({"implicit", {}}, m) < 8 * m.triangles.size());
}

TEST_CASE("a mesh in leaf order is the same mesh, and has the same tree without a list of triangles") {
    std::vector<mesh> cases = meshes();
    cases.push_back(sheet(70));
    cases.back().vertices.insert(cases.back().vertices.begin(), {5, 5, 5});  // used by no triangle
    for (auto& t : cases.back().triangles)
        for (std::uint32_t& v : t) ++v;
    for (const mesh& m : cases)
        for_each_build([&]<class Build>(Build build) {
            INFO(Build::name << ", " << m.triangles.size() << " triangles");
            const balanced_order order = build.order(m);
            const mesh ordered = in_leaf_order(m, order);
            REQUIRE(ordered.triangles.size() == m.triangles.size());
            std::uint32_t next = 0;
            for (std::uint32_t t = 0; t < m.triangle_count(); ++t) {
                for (int c = 0; c < 3; ++c) REQUIRE(ordered.triangle(t)[c] == m.triangle(order.triangles[t])[c]);
                for (const std::uint32_t v : ordered.triangles[t]) {
                    REQUIRE(v <= next);
                    next = std::max(next, v + 1);
                }
            }
            const auto in_order = [](mesh unordered) {
                std::ranges::sort(unordered.vertices, {}, [](const vec3f& p) { return std::tuple(p[0], p[1], p[2]); });
                return unordered.vertices;
            };
            REQUIRE(in_order(ordered) == in_order(m));

            const implicit_tree fetched({implicit_tree::vertex_choice::fetched});
            const model<implicit_tree> before(m, as_tree_builder<Build>(), fetched);
            const model<implicit_tree> after(ordered, as_tree_builder<file_order_build>(), fetched);
            CHECK(after.tree().bytes().indices == 0);
            CHECK(same_nodes(after.tree(), before.tree()));
            for (std::uint32_t place = 0; place < m.triangle_count(); ++place) {
                REQUIRE(before.tree().triangle_at(place) == order.triangles[place]);
                REQUIRE(after.tree().triangle_at(place) == place);
            }
        });
}

TEST_CASE("an implicit tree is the same if packed by any number of threads, or again") {
    const mesh m = sheet(110);
    const balanced_order order = sah_build().order(m);
    implicit_tree sequential;
    sequential.pack(m, order);
    for (const std::uint32_t threads : {1U, 2U, 5U}) {
        balanced_order parallel = order;
        parallel.threads = threads;
        implicit_tree packed;
        if (threads == 2) packed.pack(m, median_build().order(m));
        if (threads == 5) packed.pack(m, file_order_build().order(m));
        packed.pack(m, parallel);
        CHECK(same_nodes(packed, sequential));
        // More leaves than one range of boxes: every child holds its triangles.
        std::size_t triangles_of_child = 8;
        for (std::size_t level = 0; level < packed.levels(); ++level, triangles_of_child *= 8)
            for (std::size_t place = 0; place < m.triangles.size(); ++place) {
                const std::size_t child = place / triangles_of_child;
                const box child_box = packed.level(level)[child / 8].child(child % 8);
                REQUIRE(contains(child_box, bounds_of(m.triangle(order.triangles[place]))));
            }
        for (std::uint32_t place = 0; place < m.triangle_count(); ++place)
            REQUIRE(packed.triangle_at(place) == order.triangles[place]);
        for (std::uint32_t leaf = 0; 8 * leaf < m.triangle_count(); ++leaf) {
            vertex_list list;
            vertex_list expected;
            packed.read_vertices(leaf, list);
            sequential.read_vertices(leaf, expected);
            REQUIRE(parts_of(list) == parts_of(expected));
            REQUIRE(list.count > 0);
            for (std::size_t i = 1; i < list.count; ++i) REQUIRE(list.vertices[i - 1] < list.vertices[i]);
            for (std::uint32_t i = 0; i < std::min(8U, m.triangle_count() - 8 * leaf); ++i)
                for (std::size_t c = 0; c < 3; ++c)
                    REQUIRE(list.vertices[list.positions[c] >> 4 * i & 15U] ==
                            m.triangles[order.triangles[8 * leaf + i]][c]);
        }
        packed.pack(m, file_order_build().order(m));
        CHECK(packed.triangle_at(1000) == 1000);
    }
}

TEST_CASE("a tree of nearly linear depth is built the same by two threads as by one") {
    const mesh m = nested(20000);
    const auto nodes = midpoint_build().build(m, leaf_arrangement::any);
    CHECK(std::ranges::equal(midpoint_build({2}).build(m, leaf_arrangement::any), nodes, {}, content_of, content_of));
}

TEST_CASE("a balanced tree splits triangles into full halves along one axis, on any number of threads") {
    const auto before = [](const mesh& m, std::uint32_t p, std::uint32_t q, int k) {
        const auto centre = [&](std::uint32_t t) {
            const box b = bounds_of(m.triangle(t));
            return 0.5F * b.min[k] + 0.5F * b.max[k];
        };
        return centre(p) != centre(q) ? centre(p) < centre(q) : p < q;
    };
    const auto is_split = [&](auto self, const mesh& m, std::span<const std::uint32_t> order) -> bool {
        if (order.size() <= 8) return true;
        const auto left = order.first(std::bit_ceil(order.size()) / 2);
        const auto right = order.subspan(left.size());
        const auto is_across = [&](int k) {
            const auto less = [&](std::uint32_t p, std::uint32_t q) { return before(m, p, q, k); };
            return less(*std::ranges::max_element(left, less), *std::ranges::min_element(right, less));
        };
        return (is_across(0) || is_across(1) || is_across(2)) && self(self, m, left) && self(self, m, right);
    };
    std::vector<mesh> cases = meshes();
    cases.push_back(sheet(80));
    cases.push_back(equal_triangles(3000));
    mesh& beyond_float = cases.emplace_back(sheet(12));
    for (vec3f& p : beyond_float.vertices)
        for (int k = 0; k < 3; ++k) p[k] = (p[k] - 6) * 5e37F;
    for (const mesh& m : cases)
        for_each_build([&]<class Build>(Build) {
            INFO(Build::name << ", " << m.triangles.size() << " triangles");
            const balanced_order order = Build().order(m);
            const auto ascending = sorted(order.triangles);
            REQUIRE(ascending.size() == m.triangles.size());
            for (std::uint32_t t = 0; t < ascending.size(); ++t) REQUIRE(ascending[t] == t);
            if constexpr (std::same_as<Build, file_order_build>)
                CHECK(std::ranges::is_sorted(order.triangles));
            else
                CHECK(is_split(is_split, m, order.triangles));
            REQUIRE(order.bounds.size() == (ascending.size() + 7) / 8);
            for (std::size_t leaf = 0; leaf < order.bounds.size(); ++leaf) {
                box leaf_bounds = empty_box();
                for (std::size_t i = 8 * leaf; i < std::min(8 * leaf + 8, ascending.size()); ++i)
                    leaf_bounds = merged(leaf_bounds, bounds_of(m.triangle(order.triangles[i])));
                REQUIRE(order.bounds[leaf] == leaf_bounds);
            }
            for (const std::uint32_t threads : {2U, 5U, 256U}) {
                const Build parallel({threads});
                CHECK(parallel.order(m).triangles == order.triangles);
                CHECK(parallel.order(m).bounds == order.bounds);
                for (const auto arrangement : {leaf_arrangement::any, leaf_arrangement::pairs})
                    CHECK(std::ranges::equal(parallel.build(m, arrangement), Build().build(m, arrangement), {},
                                             content_of, content_of));
            }
        });
}

TEST_CASE("builds split by their own rules") {
    // With a tree that takes any splits; `implicit` prescribes them.
    const auto split_by = [](const char* build) {
        return composed({{strategy_kind::build, build}, {strategy_kind::tree, "canonical"}});
    };
    const auto depth = [&](const char* build, const mesh& m) {
        return stage_of(split_by(build), m)->validate_tree(0)->depth;
    };
    CHECK(depth("median", receding(61)) == 6);
    CHECK(depth("mean", receding(61)) > 15);
    CHECK(depth("midpoint", nested(61)) == 60);
    // The middle of the box lies between the first two points, the mean and the median further on.
    mesh points;
    for (const float x : {0.0F, 6.0F, 9.0F, 9.5F, 10.0F}) add_triangle(points, {x, 0, 0}, {x, 0, 0}, {x, 0, 0});
    const auto left_end = [&](const auto& build) {
        return build.build(points, leaf_arrangement::any)[1].bounds.max[0];
    };
    CHECK(left_end(midpoint_build()) == 0);
    CHECK(left_end(mean_build()) == 6);
    // A case that the heuristic is made for: two clusters of different sizes.
    mesh clusters;
    for (int i = 0; i < 300; ++i) {
        const float x = i < 200 ? static_cast<float>(i) / 200 : 100 + static_cast<float>(i) / 300;
        add_triangle(clusters, {x, 0, 0}, {x, 0, 0}, {x, 0.01F, 0});
    }
    const auto tests = [&](const char* build) {
        const auto stage = stage_of(split_by(build), clusters);
        CHECK(stage->count_pairs(0, {}, 0, shifted({50, 0, 0})) == 0);
        return stage->counters()[work::box_tests];
    };
    CHECK(tests("sah") < tests("median"));
}

TEST_CASE("only layouts with few bits per plane inflate boxes, compressed_literal only a little") {
    mesh m = sheet(40);
    for (std::size_t v = 0; v < m.vertices.size(); ++v)
        for (int k = 0; k < 3; ++k)
            m.vertices[v][k] += std::sin(static_cast<float>(v * 3 + static_cast<std::size_t>(k)));
    for (const composition& tree : all_trees()) {
        INFO(text_of_local(tree));
        const double inflation = stage_of(tree, m)->validate_tree(0)->area_inflation;
        if (is_lossless(tree[strategy_kind::tree])) {
            CHECK(inflation == 0);
        } else {
            CHECK_BETWEEN(0, inflation, (tree[strategy_kind::tree].name == "compressed_literal" ? 0.05 : 1));
        }
    }
}
