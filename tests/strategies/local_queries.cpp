#include <rapidcheck.h>

#include "../compositions.hpp"
#include "../meshes.hpp"
#include "../random_poses.hpp"

import aabb.triangle.exact;

using namespace aabb;

namespace {

/// Vertices on a coarse lattice, so that many triangles touch, repeat, are coplanar or have no area; sometimes small,
/// sometimes thin.
mesh any_mesh() {
    mesh m;
    const auto vertices = *rc::gen::inRange<std::uint32_t>(1, 25);
    const vec3f size{*rc::gen::element(1e-4F, 0.1F, 1.0F), *rc::gen::element(0.0F, 1.0F),
                     *rc::gen::element(1e-3F, 1.0F)};
    for (std::uint32_t v = 0; v < vertices; ++v) {
        vec3f p;
        for (int k = 0; k < 3; ++k) p[k] = static_cast<float>(*rc::gen::inRange(-3, 4)) * size[k];
        m.vertices.push_back(p);
    }
    const auto triangles = *rc::gen::inRange<std::size_t>(1, 30);
    for (std::size_t t = 0; t < triangles; ++t)
        m.triangles.push_back(
            {*rc::gen::inRange(0U, vertices), *rc::gen::inRange(0U, vertices), *rc::gen::inRange(0U, vertices)});
    return m;
}

/// Rotations by multiples of a right angle keep lattices touching; others do not.
pose any_pose() {
    const double far = *rc::gen::element(0.0, 0.0, 1e3, 1e9);
    vec3d translation;
    for (int k = 0; k < 3; ++k) translation[k] = far + *rc::gen::inRange(-2, 3) * *rc::gen::element(0.1, 1.0);
    if (*rc::gen::arbitrary<bool>()) return any_turned(translation);
    std::array<double, 4> q{1, 0, 0, 0};
    if (*rc::gen::arbitrary<bool>()) q[*rc::gen::inRange<std::size_t>(1, 4)] = 1;
    return turned_by(q, translation);
}

std::vector<index_pair> expected(const mesh& a, const pose& pose_a, const mesh& b, const pose& pose_b) {
    std::vector<index_pair> pairs;
    for (std::uint32_t s = 0; s < a.triangle_count(); ++s)
        for (std::uint32_t t = 0; t < b.triangle_count(); ++t)
            if (exact_triangle::intersects({pose_a, pose_b}, in_double(a.triangle(s)), in_double(b.triangle(t))))
                pairs.push_back({s, t});
    return pairs;
}

}  // namespace

TEST_CASE("every exact composition finds exactly the intersecting triangles of two meshes, in every query", "[long]") {
    const std::vector<aabb::composition> compositions = exact_local_compositions();
    REQUIRE(compositions.size() >= (has_sanitizer ? 10 : 33));
    REQUIRE(rc::check([&] {
        mesh a = any_mesh();
        const mesh b = any_mesh();
        std::vector<std::unique_ptr<local_stage>> stages;
        for (const aabb::composition& c : compositions) {
            stages.push_back(local_of(c, instrumentation::none));
            stages.back()->add_model(a);
            stages.back()->add_model(b);
        }
        for (int query = 0; query < 3; ++query) {
            // The last query follows a deformation.
            if (query == 2) a.vertices[0] = {1, 2, 0};
            const pose pose_a = any_pose();
            pose pose_b = any_pose();
            for (int k = 0; k < 3; ++k)
                if (std::abs(pose_a.translation[k]) > 100) pose_b.translation[k] = pose_a.translation[k];
            const std::vector<index_pair> truth = expected(a, pose_a, b, pose_b);
            for (std::size_t i = 0; i < stages.size(); ++i) {
                RC_LOG(text_of_local(compositions[i]));
                if (query == 2) stages[i]->refit(0);
                std::vector<index_pair> pairs;
                stages[i]->all_pairs(0, pose_a, 1, pose_b, pairs);
                RC_ASSERT(sorted(pairs) == truth);
                RC_ASSERT(stages[i]->count_pairs(0, pose_a, 1, pose_b) == truth.size());
                const std::optional<index_pair> first = stages[i]->first_pair(0, pose_a, 1, pose_b);
                RC_ASSERT(first.has_value() == !truth.empty());
                if (first) RC_ASSERT(std::ranges::binary_search(truth, *first));
            }
        }
    }));
}

TEST_CASE("every exact composition finds exactly the self-intersections of a mesh", "[long]") {
    const std::vector<aabb::composition> compositions = exact_local_compositions();
    REQUIRE(rc::check([&] {
        const mesh m = any_mesh();
        std::vector<index_pair> truth;
        for (const index_pair p : expected(m, {}, m, {}))
            if (p.a < p.b) truth.push_back(p);
        for (const aabb::composition& c : compositions) {
            RC_LOG(text_of_local(c));
            const auto stage = local_of(c, instrumentation::none);
            stage->add_model(m);
            // A query that stops early leaves nothing behind.
            (void)stage->first_pair(0, {}, 0, {});
            std::vector<index_pair> pairs;
            stage->self_pairs(0, pairs);
            RC_ASSERT(sorted(pairs) == truth);
        }
    }));
}

// Boxes that are transformed from frame to frame must grow by what rounding may do (`relative_pose`), or most of these
// pairs are missed.
TEST_CASE("coincident points are found at any common pose, even far from the origin, but near ones are not", "[long]") {
    const std::vector<aabb::composition> compositions = exact_local_compositions();
    REQUIRE(rc::check([&] {
        const pose pose_a = any_pose();
        pose pose_b = any_pose();
        // Far from the origin of its mesh, near in A's frame: double loses digits that float has.
        const double far = *rc::gen::element(1.0, 1e6, 1e9);
        const vec3f x{static_cast<float>(uniform(-far, far)), static_cast<float>(uniform(-far, far)), 0.3F};
        for (int k = 0; k < 3; ++k) {
            pose_b.translation[k] = pose_a.translation[k] + uniform(-1, 1);
            for (int j = 0; j < 3; ++j) pose_b.translation[k] -= pose_b.rotation[3 * k + j] * x[j];
        }
        const mesh b{{x}, {{0, 0, 0}}};
        const mesh a{{relative_pose(pose_a, pose_b, bounds_of(x))(x)}, {{0, 0, 0}}};
        const std::size_t truth = expected(a, pose_a, b, pose_b).size();
        for (const aabb::composition& c : compositions) {
            RC_LOG(text_of_local(c));
            const auto stage = local_of(c, instrumentation::none);
            stage->add_model(a);
            stage->add_model(b);
            RC_ASSERT(stage->count_pairs(0, pose_a, 1, pose_b) == truth);
            RC_ASSERT(stage->count_pairs(1, pose_b, 1, pose_b) == 1U);
        }
    }));
}

TEST_CASE("a leaf test in place of leaf boxes saves triangle tests") {
    const mesh m = ripples(30);
    const pose moved = shifted({0.3, 0.2, 0.4});
    const auto work_of = [&](const strategy_choice& tree) {
        composition c;
        c[strategy_kind::tree] = tree;
        const auto stage = local_of(c, instrumentation::counters);
        const auto model = stage->add_model(m);
        CHECK(stage->count_pairs(model, {}, model, moved) > 100);
        return stage->counters();
    };
    for (const char* layout : {"leafless", "compressed", "compressed_literal", "quantized"}) {
        INFO(layout);
        const work_counters none = work_of({layout, {}});
        const work_counters box = work_of({layout, {{"leaf_test", "triangle_box"}}});
        const work_counters own = work_of({layout, {{"leaf_test", "triangle_aabb"}}});
        CHECK(none[work::triangle_box_tests] == 0);
        CHECK(own[work::triangle_box_tests] == 0);
        CHECK(box[work::triangle_box_tests] > 0);
        CHECK(box[work::triangle_tests] < none[work::triangle_tests]);
        CHECK(own[work::triangle_tests] < none[work::triangle_tests]);
    }
    // Both layouts hold the same tree, so the same boxes are tested.
    CHECK(work_of({"canonical", {}})[work::box_tests] == work_of({"shared_planes", {}})[work::box_tests]);
    CHECK(work_of({"canonical", {}})[work::triangle_tests] == work_of({"shared_planes", {}})[work::triangle_tests]);
}

TEST_CASE("Möller's original triangle-box test misses touching pairs, and has no false positives") {
    const composition original = composed({{strategy_kind::tree, "leafless:leaf_test=moller_triangle_box"}});
    std::size_t false_negatives = 0;
    REQUIRE(rc::check([&] {
        for (int i = 0; i < 10; ++i) {
            const mesh a = any_mesh();
            const mesh b = any_mesh();
            const pose pose_a = any_pose();
            pose pose_b = any_pose();
            // A small motion that double holds exactly keeps lattices touching, and meshes apart from each other's
            // frame.
            pose_b.translation = pose_a.translation;
            const std::vector<index_pair> truth = expected(a, pose_a, b, pose_b);
            const auto stage = local_of(original);
            stage->add_model(a);
            stage->add_model(b);
            std::vector<index_pair> pairs;
            stage->all_pairs(0, pose_a, 1, pose_b, pairs);
            RC_ASSERT(std::ranges::includes(truth, sorted(pairs)));
            false_negatives += truth.size() - pairs.size();
        }
    }));
    CHECK(false_negatives > 0);
}

TEST_CASE("only Möller's original triangle-box test makes a leafless tree inexact") {
    for (const strategy_choice& tree : all_choices(strategy_kind::tree)) {
        const bool original =
            std::ranges::find(tree.settings, "moller_triangle_box", &setting::value) != tree.settings.end();
        composition c;
        c[strategy_kind::tree] = tree;
        CHECK(is_exact_locally(c) == !original);
    }
}
