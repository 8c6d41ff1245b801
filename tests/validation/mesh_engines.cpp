#include "engines.hpp"

using namespace aabb;

namespace {

std::vector<index_pair> found_by(const char* engine, const mesh_case& c) {
    return pairs_of(*make_mesh_engine(engine), c.a, c.pose_a, c.b, c.pose_b);
}

/// The definition: every pair of triangles, B's taken into A's frame.
std::vector<index_pair> expected(const mesh_case& c) {
    const relative_pose to_a(c.pose_a, c.pose_b, bounds_of(c.b));
    std::vector<index_pair> pairs;
    for (std::uint32_t s = 0; s < c.a.triangle_count(); ++s)
        for (std::uint32_t t = 0; t < c.b.triangle_count(); ++t)
            if (exactly_intersect(c.a.triangle(s), to_a(c.b.triangle(t)))) pairs.push_back({s, t});
    return pairs;
}

std::string text(const differences& all) {
    std::string lines;
    for (std::size_t c = 0; c < difference_class_names.size(); ++c)
        lines += std::string(difference_class_names[c]) + ": " + std::to_string(all.false_negatives[c]) + " missing, " +
                 std::to_string(all.false_positives[c]) + " invented\n";
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

TEST_CASE("what FCL and libccd answer differently has a reason") {
    for (const char* engine : {"fcl", "fcl_aabb", "libccd"}) {
        if (is_left_out(engine)) continue;
        for (const mesh_case& c : mesh_cases()) {
            const std::vector<index_pair> found = found_by(engine, c);
            REQUIRE(std::ranges::adjacent_find(found) == found.end());
            const differences all = compare_triangle_pairs(expected(c), found, c.a, c.pose_a, c.b, c.pose_b);
            INFO(engine << ", " << c.name << "\n" << text(all));
            CHECK(all.false_negatives[other] == 0);
            CHECK(all.false_positives[other] == 0);
        }
    }
}

TEST_CASE("libccd's absolute tolerances, wrong on tiny meshes, are counted as other") {
    if (is_left_out("libccd")) SKIP(rejection_of_engine("libccd"));
    mesh_case c = mesh_cases().front();
    for (mesh* m : {&c.a, &c.b})
        for (vec3f& v : m->vertices)
            for (int k = 0; k < 3; ++k) v[k] *= 0x1p-20F;
    for (int k = 0; k < 3; ++k) c.pose_b.translation[k] *= 0x1p-20;
    const differences all = compare_triangle_pairs(expected(c), found_by("libccd", c), c.a, c.pose_a, c.b, c.pose_b);
    INFO(text(all));
    REQUIRE(all.false_negatives[other] + all.false_positives[other] > 0);
}

TEST_CASE("FCL, called with its own layout of classes, knows a plain answer") {
    if (is_left_out("fcl")) SKIP(rejection_of_engine("fcl"));
    const mesh_case c = mesh_cases().front();
    const std::vector<index_pair> truth = expected(c);
    REQUIRE(truth.size() > 50);
    REQUIRE(found_by("fcl", c) == truth);
    REQUIRE(found_by("fcl_aabb", c) == truth);
}

TEST_CASE("the first pair is one of the pairs, or nothing") {
    for (const mesh_case& c : mesh_cases()) {
        INFO(c.name);
        for_each_mesh_engine([&](local_stage& engine, const engine_info&) {
            const std::uint32_t a = engine.add_model(c.a);
            const std::uint32_t b = engine.add_model(c.b);
            std::vector<index_pair> all;
            engine.all_pairs(a, c.pose_a, b, c.pose_b, all);
            const std::optional<index_pair> first = engine.first_pair(a, c.pose_a, b, c.pose_b);
            REQUIRE(first.has_value() == !all.empty());
            if (first) REQUIRE(std::ranges::find(all, *first) != all.end());
        });
    }
}

TEST_CASE("models are numbered from 0 and asked for in any order") {
    const mesh ball = sphere(5);
    const mesh floor = grid(4);
    const mesh corner = tetrahedron(1);
    const pose still;
    for_each_mesh_engine([&](local_stage& engine, const engine_info& info) {
        REQUIRE(engine.add_model(ball) == 0);
        REQUIRE(engine.add_model(floor) == 1);
        REQUIRE(engine.add_model(corner) == 2);
        const pose moved = turned({1, 1, 0}, 0.3, {0.1, 0.2, -0.3});
        std::vector<index_pair> pairs = {{7, 7}};
        engine.all_pairs(2, moved, 0, still, pairs);
        REQUIRE(pairs.front() == index_pair{7, 7});  // found pairs are appended
        pairs.erase(pairs.begin());
        REQUIRE(sorted(pairs) == pairs_of(*make_mesh_engine(info.name), corner, moved, ball, still));
        const std::vector<part_bytes> bytes = engine.bytes();
        REQUIRE(bytes.size() == 1);
        REQUIRE(bytes[0].bytes > 0);
    });
}

TEST_CASE("mesh engines answer at any later pose as at the first, and when both meshes have deformed") {
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
            const int place = step / 2;  // each twice, the second one before and after
            const pose moved = turned({1, 2, 3}, 0.3 + 0.7 * place, {0.2 * place, 0.3, 0.05});
            for (const auto& [model_b, mesh_b] : {std::pair{1U, &b}, std::pair{0U, &a}}) {
                std::vector<index_pair> pairs;
                engine.all_pairs(0, {}, model_b, moved, pairs);
                const std::vector<index_pair> afresh = pairs_of(*make_mesh_engine(info.name), a, {}, *mesh_b, moved);
                REQUIRE(afresh.size() > 10);
                REQUIRE(sorted(pairs) == afresh);
            }
        }
    });
}

TEST_CASE("mesh engines refuse meshes that cannot be searched") {
    const mesh none{{{0, 0, 0}}, {}};
    const mesh wild{{{0, 0, 0}}, {{0, 0, 1}}};
    for_each_mesh_engine([&](local_stage& engine, const engine_info&) {
        CHECK_REFUSED(engine.add_model(none), "the mesh has no triangles");
        CHECK_REFUSED(engine.add_model(wild), "triangle 0 uses vertex 1, but there are only 1 vertices");
    });
}

TEST_CASE("mesh engines follow vertices that were numbered anew, and refuse other triangles") {
    for_each_mesh_engine([&](local_stage& engine, const engine_info&) {
        mesh_case c = mesh_cases().front();
        const std::uint32_t a = engine.add_model(c.a);
        const std::uint32_t b = engine.add_model(c.b);
        const auto pairs = [&] {
            std::vector<index_pair> all;
            engine.all_pairs(a, c.pose_a, b, c.pose_b, all);
            return sorted(all);
        };
        const std::vector<index_pair> before = pairs();
        c.b = numbered_backwards(c.b);
        c.b.vertices.push_back(c.b.vertices.back());  // of no triangle
        engine.refit(b);
        CHECK(pairs() == before);
        c.b.triangles.pop_back();
        CHECK_THROWS_AS(engine.refit(b), input_error);
    });
}

TEST_CASE("engines take meshes of one triangle, with area and without") {
    const pose still;
    const mesh flat = one_triangle({{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}}});
    const mesh needle = one_triangle({{{0.5F, 0.5F, -1}, {0.5F, 0.5F, 1}, {0.5F, 0.5F, 0}}});
    const mesh dot_in = one_triangle({{{0.5F, 0.5F, 0}, {0.5F, 0.5F, 0}, {0.5F, 0.5F, 0}}});
    const mesh dot_off = one_triangle({{{5, 5, 0}, {5, 5, 0}, {5, 5, 0}}});
    // Of so few, all in one point, Embree cannot make a scene of low quality.
    const mesh dots{dot_in.vertices, {{0, 1, 2}, {2, 1, 0}, {1, 2, 0}}};
    for_each_mesh_engine([&](local_stage& engine, const engine_info& info) {
        const std::size_t found = pairs_of(engine, flat, still, dots, still).size();
        REQUIRE((found == 3 || !info.exact));
    });
    for (const char* engine : {"brute_force", "cgal", "cgal_tree"}) {
        INFO(engine);
        REQUIRE(pairs_of(*make_mesh_engine(engine), flat, still, needle, still).size() == 1);
        REQUIRE(pairs_of(*make_mesh_engine(engine), flat, still, dot_in, still).size() == 1);
        REQUIRE(pairs_of(*make_mesh_engine(engine), flat, still, dot_off, still).empty());
    }
    for (const char* engine : {"fcl", "fcl_aabb", "libccd"}) {
        if (is_left_out(engine)) continue;
        INFO(engine);
        REQUIRE(pairs_of(*make_mesh_engine(engine), flat, still, needle, still).size() <= 1);
        REQUIRE(pairs_of(*make_mesh_engine(engine), flat, still, dot_off, still).empty());
    }
}
