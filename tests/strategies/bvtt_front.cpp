#include <rapidcheck.h>

#include "../compositions.hpp"
#include "../meshes.hpp"
#include "../random_poses.hpp"

import aabb.strategies;
import aabb.wide_tree.child_pairs;
import aabb.wide_tree.bvtt_front;

using namespace aabb;

namespace {

composition with_front() {
    return composed({{strategy_kind::build, "sah"}, {strategy_kind::tree, "implicit:front=kept"}});
}
composition without_front() {
    return composed({{strategy_kind::build, "sah"}, {strategy_kind::tree, "implicit"}});
}

std::unique_ptr<local_stage> stage_of(const composition& c, std::span<const mesh> models,
                                      instrumentation counted = instrumentation::none) {
    auto stage = local_of(c, counted);
    for (const mesh& m : models) stage->add_model(m);
    return stage;
}

/// A wavy unit sheet of 2 edges² triangles.
mesh waves(std::uint32_t edges, float height) {
    return sheet_of(edges, [&](std::uint32_t i, std::uint32_t j) -> vec3f {
        const float x = static_cast<float>(i) / static_cast<float>(edges);
        const float y = static_cast<float>(j) / static_cast<float>(edges);
        return {x, y, height * std::sin(9 * x) * std::cos(7 * y)};
    });
}

pose moved(const vec3d& by, double turn) {
    return turned_by({1, turn, -turn / 2, turn / 3}, by);
}

/// A stage that reports the number of nodes that each query opens.
class counted_queries {
public:
    explicit counted_queries(const mesh& m) : stage_(stage_of(with_front(), {&m, 1}, instrumentation::counters)) {}

    std::uint64_t nodes_opened(const pose& pose_b, bool for_first = false) {
        const std::uint64_t before = visits();
        if (for_first)
            static_cast<void>(stage_->first_pair(0, {}, 0, pose_b));
        else
            static_cast<void>(stage_->count_pairs(0, {}, 0, pose_b));
        return visits() - before;
    }
    std::uint64_t nodes_opened_for_first(const pose& pose_b) { return nodes_opened(pose_b, true); }
    void refit() { stage_->refit(0); }

private:
    [[nodiscard]] std::uint64_t visits() const { return stage_->counters()[work::node_visits]; }

    std::unique_ptr<local_stage> stage_;
};

}  // namespace

TEST_CASE("displacement_bound holds for every vertex, within a factor of three") {
    REQUIRE(rc::check([] {
        const float size = *rc::gen::element(1e-30F, 1e-3F, 1.0F, 1e30F);
        const box bounds{{-size, 0, size / 2}, {size, size, size}};
        const auto any_pose = [&](double turn) { return turned_up_to(turn, any_vector(2 * size)); };
        const double turn = *rc::gen::element(0.0, 1e-9, 1e-3, 1.0);
        const pose a = any_pose(1);
        const pose b = any_pose(turn);
        pose c = *rc::gen::arbitrary<bool>() ? any_pose(turn) : b;
        if (*rc::gen::arbitrary<bool>()) c.rotation = b.rotation;
        const relative_pose p(a, b, bounds);
        const relative_pose q(a, c, bounds);
        const double bound = displacement_bound(p.to_boxes(), q.to_boxes(), bounds);
        double largest = 0;
        for (int i = 0; i < 40; ++i) {
            vec3f x;
            for (int k = 0; k < 3; ++k)
                x[k] = i < 8 ? (i >> k & 1 ? bounds.max[k] : bounds.min[k])
                             : static_cast<float>(uniform(bounds.min[k], bounds.max[k]));
            const vec3f from = p(x);
            const vec3f to = q(x);
            double squares = 0;
            for (int k = 0; k < 3; ++k) squares += std::pow((double{to[k]} - double{from[k]}) / size, 2);
            largest = std::max(largest, std::sqrt(squares) * size);
        }
        RC_ASSERT(largest <= bound);
        RC_ASSERT(bound <= 3 * largest + 1e-5 * size);
    }));
}

TEST_CASE("children within a margin of each other are found under any rotation") {
    REQUIRE(rc::check([] {
        const double margin = uniform(0.01, 0.5);
        const double turn = *rc::gen::element(0.0, 0.01, 1.0);
        const pose pose_b = turned_up_to(turn, any_vector(2));
        // Each leaf repeats one point eight times.
        std::array<mesh, 2> meshes;
        for (std::uint32_t point = 0; point < 8; ++point) {
            vec3d in_a;
            vec3d direction;
            double square = 0;
            for (int k = 0; k < 3; ++k) {
                in_a[k] = static_cast<float>(uniform(-1, 1));
                direction[k] = uniform(-1, 1);
                square += direction[k] * direction[k];
            }
            vec3f in_b{};
            for (int j = 0; j < 3; ++j) {
                double sum = 0;
                for (int k = 0; k < 3; ++k)
                    sum += pose_b.rotation[3 * k + j] *
                           (in_a[k] + 0.999 * margin * direction[k] / std::sqrt(square) - pose_b.translation[k]);
                in_b[j] = static_cast<float>(sum);
            }
            meshes[0].vertices.push_back(
                {static_cast<float>(in_a[0]), static_cast<float>(in_a[1]), static_cast<float>(in_a[2])});
            meshes[1].vertices.push_back(in_b);
            for (mesh& m : meshes) m.triangles.insert(m.triangles.end(), 8, {point, point, point});
        }
        const model<implicit_tree> a(meshes[0], as_tree_builder<median_build>());
        const model<implicit_tree> b(meshes[1], as_tree_builder<median_build>());
        child_pairs<implicit_tree> pairs;
        pairs.begin(a.tree(), b.tree(), relative_pose({}, pose_b, b.bounds()), a.bounds(), margin);
        no_counters counters;
        const std::array<std::uint32_t, 1> roots{0};
        const auto overlaps = pairs.find_overlapping(a.tree().level(0), roots, b.tree().level(0), roots, counters);
        const std::uint64_t mask = overlaps.empty() ? 0 : overlaps[0].mask;
        for (std::uint32_t i = 0; i < 8; ++i)
            for (std::uint32_t j = 0; j < 8; ++j)
                if (a.tree().triangle_at(8 * i) / 8 == b.tree().triangle_at(8 * j) / 8)
                    RC_ASSERT((mask >> (8 * j + i) & 1U) != 0);
    }));
}

// A front's margin is a few hundredths of a leaf, so about one step in ten invalidates it. Several objects share meshes
// of any size, which may lie far from their origins and have rotations that are barely orthonormal.
TEST_CASE("kept pairs of leaves contain all intersecting triangles as meshes creep, stop, jump and deform") {
    std::size_t queries = 0;
    std::size_t served = 0;
    REQUIRE(rc::check([&] {
        const float size = *rc::gen::element(1.0F, 1e-3F, 1e-30F, 1e-37F, 1e30F);
        const float offset = *rc::gen::element(0.0F, 0.0F, 100.0F);
        std::vector<mesh> meshes;
        for (const float height : {0.2F, 0.1F, 0.05F}) {
            meshes.push_back(waves(*rc::gen::inRange(12U, 20U), height));
            for (vec3f& p : meshes.back().vertices)
                for (int k = 0; k < 3; ++k) p[k] = (p[k] + offset) * size;
        }
        const auto tracked = stage_of(with_front(), meshes, instrumentation::counters);
        const auto untracked = stage_of(without_front(), meshes);
        struct object {
            std::array<std::uint32_t, 2> models;
            std::array<double, 3> position;
            std::array<double, 3> velocity;
            double angle;
            double angular_velocity;
            double stretch;
        };
        const auto choose_velocity = [&](object& o) {
            const double speed = *rc::gen::element(0.0, 0.0, 1e-6, 1e-4, 1e-3, 1e-2, 5e-2) / 10;
            for (double& v : o.velocity) v = uniform(-speed, speed);
            o.angular_velocity = offset == 0 ? uniform(-speed, speed) : 0;
        };
        std::vector<object> objects(*rc::gen::inRange<std::size_t>(1, 4));
        for (object& o : objects) {
            for (std::uint32_t& model : o.models) model = *rc::gen::inRange(0U, 3U);
            for (double& x : o.position) x = uniform(-0.2, 0.2);
            o.angle = offset == 0 ? uniform(-0.5, 0.5) : 0;
            o.stretch = *rc::gen::element(0.0, 4e-7, -4e-7);
            // Different meshes in the same place.
            if (*rc::gen::arbitrary<bool>()) {
                o.position = objects[0].position;
                o.angle = objects[0].angle;
            }
            choose_velocity(o);
        }
        for (int frame = 0; frame < 25; ++frame) {
            if (*rc::gen::weightedElement<bool>({{20, false}, {1, true}})) {
                const auto changed = *rc::gen::inRange<std::uint32_t>(0, 3);
                mesh& m = meshes[changed];
                m.vertices[*rc::gen::inRange<std::size_t>(0, m.vertices.size())][2] += 0.1F * size;
                tracked->refit(changed);
                untracked->refit(changed);
            }
            for (object& o : objects) {
                if (*rc::gen::weightedElement<bool>({{12, false}, {1, true}})) choose_velocity(o);
                for (std::size_t k = 0; k < 3; ++k) o.position[k] += o.velocity[k];
                o.angle += o.angular_velocity;
                pose pose_b = moved({o.position[0] * size, o.position[1] * size, o.position[2] * size}, o.angle);
                for (const std::size_t r : {0U, 4U, 8U}) pose_b.rotation[r] *= 1 + o.stretch;
                std::vector<index_pair> truth;
                untracked->all_pairs(o.models[0], {}, o.models[1], pose_b, truth);
                truth = sorted(truth);
                const std::uint64_t before = tracked->counters()[work::node_visits];
                const int query = *rc::gen::inRange(0, 3);
                if (query == 0) {
                    std::vector<index_pair> pairs;
                    tracked->all_pairs(o.models[0], {}, o.models[1], pose_b, pairs);
                    RC_ASSERT(sorted(pairs) == truth);
                } else if (query == 1) {
                    RC_ASSERT(tracked->count_pairs(o.models[0], {}, o.models[1], pose_b) == truth.size());
                } else {
                    const std::optional<index_pair> first = tracked->first_pair(o.models[0], {}, o.models[1], pose_b);
                    RC_ASSERT(first.has_value() == !truth.empty());
                    if (first) RC_ASSERT(std::ranges::binary_search(truth, *first));
                }
                ++queries;
                served += tracked->counters()[work::node_visits] == before;
            }
        }
    }));
    CHECK(served > queries / 4);
}

TEST_CASE("a front is planned after two nearby queries, and later if earlier fronts served no query") {
    const box bounds{{-1, -1, -1}, {1, 1, 1}};
    const model_pair models{{1, 2}, {3, 4}};
    const auto at = [&](double x) { return relative_pose({}, shifted({x, 0, 0}), bounds).to_boxes(); };
    bvtt_front front;
    front.reset(models);
    const auto is_planned = [&](double x) { return front.record_query(models, at(x), bounds, 1).margin.has_value(); };
    CHECK_FALSE(is_planned(0));
    CHECK_FALSE(is_planned(0.01));
    CHECK(is_planned(0.02));
    // A fast mesh that is queried twice at each pose is never near twice.
    for (int i = 1; i < 5; ++i) {
        CHECK_FALSE(is_planned(i));
        CHECK_FALSE(is_planned(i));
    }
    // A mesh in another state counts as another mesh.
    CHECK_FALSE(is_planned(6));
    for (const bool planned : {false, false, true})
        CHECK(front.record_query({{1, 2}, {3, 5}}, at(6), bounds, 1).margin.has_value() == planned);

    // Each front is invalid at the next query.
    front.reset(models);
    std::vector<int> planned;
    for (int i = 0; i < 100; ++i)
        if (is_planned(0.03 * i)) {
            planned.push_back(i);
            front.build(models, at(0.03 * i), 0.001, [](std::vector<front_pair>&) { return true; });
        }
    CHECK(planned == std::vector{2, 4, 8, 16, 32, 64});
    // A front that is too large is not kept.
    front.reset(models);
    static_cast<void>(is_planned(0));
    static_cast<void>(is_planned(0));
    CHECK(is_planned(0));
    CHECK_FALSE(front.build(models, at(0), 0.1, [](std::vector<front_pair>&) { return false; }));
    CHECK_FALSE(front.record_query(models, at(0), bounds, 1).is_valid);
}

TEST_CASE("a front contains all intersecting triangles at the limits of float, which margins exceed") {
    constexpr float largest = std::numeric_limits<float>::max();
    const auto sheet = [](bool upright) {
        return sheet_of(16, [&](std::uint32_t i, std::uint32_t j) -> vec3f {
            const float x = (static_cast<float>(i) / 8 - 1) * largest;
            const float y = (static_cast<float>(j) / 8 - 1) * largest;
            return upright ? vec3f{x, 0, y} : vec3f{x, y, 0};
        });
    };
    const std::array meshes{sheet(false), sheet(true)};
    const auto tracked = stage_of(with_front(), meshes);
    const auto untracked = stage_of(without_front(), meshes);
    std::vector<index_pair> expected;
    untracked->all_pairs(0, {}, 1, {}, expected);
    CHECK(expected.size() > 16);
    for (int query = 0; query < 5; ++query) {
        std::vector<index_pair> pairs;
        tracked->all_pairs(0, {}, 1, {}, pairs);
        CHECK(sorted(pairs) == sorted(expected));
    }
}

TEST_CASE("a front is built in the third query of slow meshes, and later queries open no nodes") {
    const mesh m = waves(40, 0.1F);
    counted_queries queries(m);
    const auto at = [](double x) { return moved({0.05 + x, 0.02, 0.03}, 0.2); };
    for (int i = 0; i < 3; ++i) CHECK(queries.nodes_opened(at(0)) > 0);
    CHECK(queries.nodes_opened(at(0)) == 0);
    CHECK(queries.nodes_opened(at(1e-6)) == 0);
    queries.refit();
    CHECK(queries.nodes_opened(at(0)) > 0);
    // Further than the margin of any front.
    for (int i = 1; i < 10; ++i) CHECK(queries.nodes_opened(at(0.01 * i)) > 0);
}

TEST_CASE("objects that share meshes have their own fronts, in any query order") {
    const mesh m = waves(20, 0.1F);
    counted_queries queries(m);
    const auto object = [](int i) {
        const int row = i / 40;
        return moved({0.05 + 0.02 * (i % 40), 0.02 * row, 0.03}, 0.2 + 0.02 * i);
    };
    for (int frame = 0; frame < 3; ++frame)
        for (int i = 0; i < 20; ++i) CHECK(queries.nodes_opened(object(i)) > 0);
    for (int i = 0; i < 20; ++i) CHECK(queries.nodes_opened(object(i)) == 0);
    for (int i = 20; i-- > 0;) CHECK(queries.nodes_opened(object(7 * i % 20)) == 0);
    // Many more objects follow than fronts are kept; those that are queried again keep theirs.
    const int capacity = front_cache::most;
    for (int i = 20; i < 3 * capacity; ++i) {
        queries.nodes_opened(object(i));
        if (i % 40 == 0)
            for (int k = 0; k < 20; ++k) REQUIRE(queries.nodes_opened(object(k)) == 0);
    }
    CHECK(queries.nodes_opened(object(20)) > 0);
}

TEST_CASE("a reused front forgets the pair that intersected") {
    const std::array<mesh, 2> meshes{waves(40, 0.1F), waves(12, 0.1F)};
    const auto tracked = stage_of(with_front(), meshes);
    const auto first = [&](std::uint32_t model, std::size_t i, double step) {
        const std::size_t row = i / 40;
        const vec3d by{step * static_cast<double>(i % 40), step * static_cast<double>(row), 0.03};
        return tracked->first_pair(model, {}, model, moved(by, 0.2));
    };
    const std::size_t capacity = front_cache::most;
    std::array<std::size_t, 2> intersecting{};
    for (std::size_t i = 0; i < capacity; ++i) intersecting[0] += first(0, i, 0.003).has_value();
    for (std::size_t i = 0; i < 80; ++i)
        if (const std::optional<index_pair> pair = first(1, i, 0.01)) {
            ++intersecting[1];
            REQUIRE(std::max(pair->a, pair->b) < meshes[1].triangle_count());
        }
    CHECK(intersecting[0] > capacity / 2);
    CHECK(intersecting[1] > 20);
}

TEST_CASE("the last intersecting pair is tested first, and disjoint meshes are not searched again") {
    const mesh m = waves(40, 0.1F);
    counted_queries queries(m);
    const pose intersecting = moved({0.05, 0.02, 0.03}, 0.2);
    CHECK(queries.nodes_opened_for_first(intersecting) > 0);
    CHECK(queries.nodes_opened_for_first(intersecting) == 0);
    pose disjoint = moved({0, 0, 0.21}, 0);
    for (int i = 0; i < 3; ++i) CHECK(queries.nodes_opened_for_first(disjoint) > 0);
    CHECK(queries.nodes_opened_for_first(disjoint) == 0);
    disjoint.translation[2] -= 1e-6;
    CHECK(queries.nodes_opened_for_first(disjoint) == 0);

    // Meshes that intersected and were separated.
    const auto at = [](double z) { return moved({0.17, 0.11, z}, 0); };
    double z = 0.21;
    const auto untracked = stage_of(without_front(), {&m, 1});
    while (!untracked->first_pair(0, {}, 0, at(z))) z -= 1e-4;
    counted_queries parting(m);
    CHECK(parting.nodes_opened_for_first(at(z)) > 0);
    CHECK(parting.nodes_opened_for_first(at(z)) == 0);
    CHECK(parting.nodes_opened_for_first(at(z + 1e-4)) > 0);
    CHECK(parting.nodes_opened_for_first(at(z + 1e-4)) == 0);
}

TEST_CASE("an inexact triangle test uses no front") {
    const mesh m = waves(40, 0.1F);
    const auto stage =
        stage_of(composed({{strategy_kind::tree, "implicit:front=kept"}, {strategy_kind::triangle, "moller"}}), {&m, 1},
                 instrumentation::counters);
    for (int i = 0; i < 5; ++i) {
        const std::uint64_t before = stage->counters()[work::node_visits];
        static_cast<void>(stage->count_pairs(0, {}, 0, moved({0.05, 0.02, 0.03}, 0.2)));
        CHECK(stage->counters()[work::node_visits] > before);
    }
}
