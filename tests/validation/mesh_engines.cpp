#include "engines.hpp"

using namespace aabb;

namespace {

std::vector<index_pair> found_by(const char* engine, const mesh_case& c) {
    return pairs_of(*make_mesh_engine(engine), c.a, c.pose_a, c.b, c.pose_b);
}

/// The definition: every pair of triangles at their poses.
std::vector<index_pair> expected(const mesh_case& c) {
    std::vector<index_pair> pairs;
    for (std::uint32_t s = 0; s < c.a.triangle_count(); ++s)
        for (std::uint32_t t = 0; t < c.b.triangle_count(); ++t)
            if (exactly_intersect({c.pose_a, c.pose_b}, c.a.given_triangle(s), c.b.given_triangle(t)))
                pairs.push_back({s, t});
    return pairs;
}

std::string text(const differences& counts) {
    std::string lines;
    for (std::size_t c = 0; c < difference_class_names.size(); ++c)
        lines += std::string(difference_class_names[c]) + ": " + std::to_string(counts.false_negatives[c]) +
                 " false negatives, " + std::to_string(counts.false_positives[c]) + " false positives\n";
    return lines;
}

constexpr auto other = static_cast<std::size_t>(difference_class::other);

}  // namespace

TEST_CASE("brute force and CGAL find exactly the intersecting triangles") {
    for (const mesh_case& c : mesh_cases()) {
        INFO(c.name);
        const std::vector<index_pair> truth = expected(c);
        REQUIRE(truth.empty() == (std::string(c.name) == "apart"));
        REQUIRE(found_by("brute_force", c) == truth);
        REQUIRE(found_by("cgal", c) == truth);
        REQUIRE(found_by("cgal_tree", c) == truth);
    }
}

TEST_CASE("each difference of FCL and libccd has a known class") {
    for (const char* engine : {"fcl", "fcl_aabb", "libccd"}) {
        if (is_left_out(engine)) continue;
        for (const mesh_case& c : mesh_cases()) {
            const std::vector<index_pair> pairs = found_by(engine, c);
            REQUIRE(std::ranges::adjacent_find(pairs) == pairs.end());
            const differences counts = compare_triangle_pairs(expected(c), pairs, c.a, c.pose_a, c.b, c.pose_b);
            INFO(engine << ", " << c.name << "\n" << text(counts));
            CHECK(counts.false_negatives[other] == 0);
            CHECK(counts.false_positives[other] == 0);
        }
    }
}

TEST_CASE("errors of libccd's absolute tolerances on tiny meshes are classified as other") {
    if (is_left_out("libccd")) SKIP(rejection_of_engine("libccd"));
    mesh_case c = mesh_cases().front();
    for (mesh* m : {&c.a, &c.b})
        for (vec3f& v : m->vertices)
            for (int k = 0; k < 3; ++k) v[k] *= 0x1p-20F;
    for (int k = 0; k < 3; ++k) c.pose_b.translation[k] *= 0x1p-20;
    const differences counts = compare_triangle_pairs(expected(c), found_by("libccd", c), c.a, c.pose_a, c.b, c.pose_b);
    INFO(text(counts));
    REQUIRE(counts.false_negatives[other] + counts.false_positives[other] > 0);
}

TEST_CASE("FCL, called with its own layout of classes, is exact on a simple case") {
    if (is_left_out("fcl")) SKIP(rejection_of_engine("fcl"));
    const mesh_case c = mesh_cases().front();
    const std::vector<index_pair> truth = expected(c);
    REQUIRE(truth.size() > 50);
    REQUIRE(found_by("fcl", c) == truth);
    REQUIRE(found_by("fcl_aabb", c) == truth);
}

TEST_CASE("the first pair is one of all pairs, or there is none") {
    for (const mesh_case& c : mesh_cases()) {
        INFO(c.name);
        for_each_mesh_engine([&](local_stage& engine, const engine_info&) {
            const std::uint32_t a = engine.add_model(c.a);
            const std::uint32_t b = engine.add_model(c.b);
            std::vector<index_pair> pairs;
            engine.all_pairs(a, c.pose_a, b, c.pose_b, pairs);
            const std::optional<index_pair> first = engine.first_pair(a, c.pose_a, b, c.pose_b);
            REQUIRE(first.has_value() == !pairs.empty());
            if (first) REQUIRE(std::ranges::find(pairs, *first) != pairs.end());
        });
    }
}

TEST_CASE("models are numbered from 0 and queried in any order") {
    const mesh ball = sphere(5);
    const mesh floor = grid(4);
    const mesh corner = tetrahedron(1);
    const pose identity;
    for_each_mesh_engine([&](local_stage& engine, const engine_info& info) {
        REQUIRE(engine.add_model(ball) == 0);
        REQUIRE(engine.add_model(floor) == 1);
        REQUIRE(engine.add_model(corner) == 2);
        const pose moved = turned({1, 1, 0}, 0.3, {0.1, 0.2, -0.3});
        std::vector<index_pair> pairs = {{7, 7}};
        engine.all_pairs(2, moved, 0, identity, pairs);
        REQUIRE(pairs.front() == index_pair{7, 7});  // pairs are appended
        pairs.erase(pairs.begin());
        REQUIRE(sorted(pairs) == pairs_of(*make_mesh_engine(info.name), corner, moved, ball, identity));
        const std::vector<part_bytes> bytes = engine.bytes();
        REQUIRE(bytes.size() == 1);
        REQUIRE(bytes[0].bytes > 0);
    });
}

TEST_CASE("mesh engines are as exact at later poses as at the first, also after both meshes deformed") {
    const auto waves = [](float height) {
        mesh m = grid(8);
        for (vec3f& v : m.vertices) v = {v[0] - 4, v[1] - 4, height * std::sin(2 * v[0] + v[1])};
        return m;
    };
    for_each_mesh_engine([&](local_stage& engine, const engine_info& info) {
        mesh a = waves(0);
        mesh b = waves(0.5F);
        engine.add_model(a);
        engine.add_model(b);
        for (int step = 0; step < 6; ++step) {
            if (step == 3)
                for (std::uint32_t model = 0; model < 2; ++model) {
                    (model == 0 ? a : b).vertices = waves(model == 0 ? 0.3F : -1).vertices;
                    engine.refit(model);
                }
            const int place = step / 2;  // each twice, the second before and after deforming
            const pose moved = turned({1, 2, 3}, 0.3 + 0.7 * place, {0.2 * place, 0.3, 0.05});
            for (const auto& [model_b, mesh_b] : {std::pair{1U, &b}, std::pair{0U, &a}}) {
                std::vector<index_pair> pairs;
                engine.all_pairs(0, {}, model_b, moved, pairs);
                const std::vector<index_pair> from_new = pairs_of(*make_mesh_engine(info.name), a, {}, *mesh_b, moved);
                REQUIRE(from_new.size() > 10);
                REQUIRE(sorted(pairs) == from_new);
            }
        }
    });
}

TEST_CASE("mesh engines refuse meshes without triangles or with invalid indices") {
    const mesh empty{{{0, 0, 0}}, {}};
    const mesh invalid{{{0, 0, 0}}, {{0, 0, 1}}};
    for_each_mesh_engine([&](local_stage& engine, const engine_info&) {
        CHECK_REFUSED(engine.add_model(empty), "the mesh has no triangles");
        CHECK_REFUSED(engine.add_model(invalid), "triangle 0 uses vertex 1, but there are only 1 vertices");
    });
}

TEST_CASE("mesh engines follow renumbered vertices, and reject a different number of triangles") {
    for_each_mesh_engine([&](local_stage& engine, const engine_info&) {
        mesh_case c = mesh_cases().front();
        const std::uint32_t a = engine.add_model(c.a);
        const std::uint32_t b = engine.add_model(c.b);
        const auto pairs = [&] {
            std::vector<index_pair> found_pairs;
            engine.all_pairs(a, c.pose_a, b, c.pose_b, found_pairs);
            return sorted(found_pairs);
        };
        const std::vector<index_pair> before = pairs();
        c.b = numbered_backwards(c.b);
        c.b.vertices.push_back(c.b.vertices.back());  // used by no triangle
        engine.refit(b);
        CHECK(pairs() == before);
        c.b.triangles.pop_back();
        CHECK_THROWS_AS(engine.refit(b), input_error);
    });
}

TEST_CASE("engines accept meshes of one triangle, degenerate or not") {
    const pose identity;
    const mesh flat = one_triangle({{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}});
    const mesh needle = one_triangle({{{0.5F, 0.5F, -1}, {0.5F, 0.5F, 1}, {0.5F, 0.5F, 0}}});
    const mesh dot_inside = one_triangle({{{0.5F, 0.5F, 0}, {0.5F, 0.5F, 0}, {0.5F, 0.5F, 0}}});
    const mesh dot_outside = one_triangle({{{5, 5, 0}, {5, 5, 0}, {5, 5, 0}}});
    // Embree cannot build a low-quality scene of so few triangles, all in one point.
    const mesh dots{dot_inside.vertices, {{0, 1, 2}, {2, 1, 0}, {1, 2, 0}}};
    for_each_mesh_engine([&](local_stage& engine, const engine_info& info) {
        const std::size_t count = pairs_of(engine, flat, identity, dots, identity).size();
        REQUIRE((count == 3 || !info.exact));
    });
    for (const char* engine : {"brute_force", "cgal", "cgal_tree"}) {
        INFO(engine);
        REQUIRE(pairs_of(*make_mesh_engine(engine), flat, identity, needle, identity).size() == 1);
        REQUIRE(pairs_of(*make_mesh_engine(engine), flat, identity, dot_inside, identity).size() == 1);
        REQUIRE(pairs_of(*make_mesh_engine(engine), flat, identity, dot_outside, identity).empty());
    }
    for (const char* engine : {"fcl", "fcl_aabb", "libccd"}) {
        if (is_left_out(engine)) continue;
        INFO(engine);
        REQUIRE(pairs_of(*make_mesh_engine(engine), flat, identity, needle, identity).size() <= 1);
        REQUIRE(pairs_of(*make_mesh_engine(engine), flat, identity, dot_outside, identity).empty());
    }
}
