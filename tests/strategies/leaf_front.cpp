#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "../compositions.hpp"
#include "../random_poses.hpp"

import aabb;
import aabb.registry;
import aabb.triangle.exact;

using namespace aabb;

namespace {

std::vector<index_pair> sorted(std::vector<index_pair> pairs) {
    std::ranges::sort(pairs);
    return pairs;
}

composition keeping() {
    return composed({{strategy_kind::build, "sah"}, {strategy_kind::tree, "implicit:front=kept"}});
}
composition forgetting() {
    return composed({{strategy_kind::build, "sah"}, {strategy_kind::tree, "implicit"}});
}

/// A sheet of 2 edges² triangles, as long and broad as 1, in waves.
mesh waves(std::uint32_t edges, float height) {
    mesh m;
    for (std::uint32_t i = 0; i <= edges; ++i)
        for (std::uint32_t j = 0; j <= edges; ++j) {
            const float x = static_cast<float>(i) / static_cast<float>(edges);
            const float y = static_cast<float>(j) / static_cast<float>(edges);
            m.vertices.push_back({x, y, height * std::sin(9 * x) * std::cos(7 * y)});
        }
    for (std::uint32_t i = 0; i < edges; ++i)
        for (std::uint32_t j = 0; j < edges; ++j) {
            const std::uint32_t v = i * (edges + 1) + j;
            m.triangles.push_back({v, v + 1, v + edges + 1});
            m.triangles.push_back({v + 1, v + edges + 2, v + edges + 1});
        }
    return m;
}

pose moved(const std::array<double, 3>& by, double turn) {
    return turned_by({1, turn, -turn / 2, turn / 3}, {by[0], by[1], by[2]});
}

}  // namespace

TEST_CASE("images of a vertex under two poses are no further apart than is said, nor much less") {
    REQUIRE(rc::check([] {
        const float size = *rc::gen::element(1e-30F, 1e-3F, 1.0F, 1e30F);
        const box reach{{-size, 0, size / 2}, {size, size, size}};
        const auto any = [&](double turn) {
            return turned_by({1, uniform(-turn, turn), uniform(-turn, turn), uniform(-turn, turn)},
                             {uniform(-2, 2) * size, uniform(-2, 2) * size, uniform(-2, 2) * size});
        };
        const double turn = *rc::gen::element(0.0, 1e-9, 1e-3, 1.0);
        const pose a = any(1);
        const pose b = any(turn);
        pose c = *rc::gen::arbitrary<bool>() ? any(turn) : b;
        if (*rc::gen::arbitrary<bool>()) c.rotation = b.rotation;
        const relative_pose p(a, b, reach);
        const relative_pose q(a, c, reach);
        const double said = most_apart(p.to_boxes(), q.to_boxes(), reach);
        double most = 0;
        for (int i = 0; i < 40; ++i) {
            vec3f x;
            for (int k = 0; k < 3; ++k)
                x[k] = i < 8 ? (i >> k & 1 ? reach.max[k] : reach.min[k])
                             : static_cast<float>(uniform(reach.min[k], reach.max[k]));
            const vec3f from = p(x);
            const vec3f to = q(x);
            double squares = 0;
            for (int k = 0; k < 3; ++k) squares += std::pow((double{to[k]} - double{from[k]}) / size, 2);
            most = std::max(most, std::sqrt(squares) * size);
        }
        RC_ASSERT(most <= said);
        RC_ASSERT(said <= 3 * most + 1e-5 * size);
    }));
}

// The margin of a front is a few hundredths of a leaf, so a step in ten or so ends it.
TEST_CASE("kept pairs of leaves hold all that meets, however meshes creep, stop and jump") {
    REQUIRE(rc::check([] {
        const auto edges = *rc::gen::inRange(2U, 14U);
        mesh a = waves(edges, 0.2F);
        const mesh b = waves(*rc::gen::inRange(2U, 14U), 0.1F);
        const auto kept = local_of(keeping());
        const auto fresh = local_of(forgetting());
        for (const auto* stage : {&kept, &fresh}) {
            (*stage)->add_model(a);
            (*stage)->add_model(b);
        }
        std::array<double, 3> at{uniform(-0.2, 0.2), uniform(-0.2, 0.2), uniform(-0.2, 0.2)};
        std::array<double, 3> way{};
        double turn = uniform(-0.5, 0.5);
        double turned = 0;
        const double leaf = std::sqrt(8.0) / edges;
        for (int query = 0; query < 40; ++query) {
            if (*rc::gen::weightedElement<bool>({{5, false}, {1, true}})) {
                const double speed = *rc::gen::element(0.0, 1e-9, 1e-3, 1e-2, 5e-2, 1.0) * leaf;
                for (double& w : way) w = uniform(-speed, speed);
                turned = uniform(-speed, speed);
            }
            for (std::size_t k = 0; k < 3; ++k) at[k] += way[k];
            turn += turned;
            if (*rc::gen::weightedElement<bool>({{15, false}, {1, true}})) {
                a.vertices[*rc::gen::inRange<std::size_t>(0, a.vertices.size())][2] += 0.1F;
                kept->refit(0);
                fresh->refit(0);
            }
            const pose pose_b = moved(at, turn);
            std::vector<index_pair> truth;
            fresh->all_pairs(0, {}, 1, pose_b, truth);
            truth = sorted(truth);
            const int how = *rc::gen::inRange(0, 3);
            if (how == 0) {
                std::vector<index_pair> found;
                kept->all_pairs(0, {}, 1, pose_b, found);
                RC_ASSERT(sorted(found) == truth);
            } else if (how == 1) {
                RC_ASSERT(kept->count_pairs(0, {}, 1, pose_b) == truth.size());
            } else {
                const std::optional<index_pair> first = kept->first_pair(0, {}, 1, pose_b);
                RC_ASSERT(first.has_value() == !truth.empty());
                if (first) RC_ASSERT(std::ranges::binary_search(truth, *first));
            }
        }
    }));
}

namespace {

/// Of one stage, what a query adds.
class counted_queries {
public:
    explicit counted_queries(const mesh& m) : stage_(local_of(keeping(), instrumentation::counters)) {
        stage_->add_model(m);
    }

    [[nodiscard]] std::uint64_t nodes_opened(const pose& pose_b) {
        const std::uint64_t before = visits();
        static_cast<void>(stage_->count_pairs(0, {}, 0, pose_b));
        return visits() - before;
    }
    [[nodiscard]] std::uint64_t nodes_opened_for_first(const pose& pose_b) {
        const std::uint64_t before = visits();
        static_cast<void>(stage_->first_pair(0, {}, 0, pose_b));
        return visits() - before;
    }
    void refit() { stage_->refit(0); }

private:
    [[nodiscard]] std::uint64_t visits() const { return stage_->counters()[work::node_visits]; }

    std::unique_ptr<local_stage> stage_;
};

}  // namespace

TEST_CASE("a front is made in the second query of meshes that hardly move, and opens no nodes from then on") {
    const mesh m = waves(40, 0.1F);
    counted_queries queries(m);
    const auto at = [](double x) { return moved({0.05 + x, 0.02, 0.03}, 0.2); };
    CHECK(queries.nodes_opened(at(0)) > 0);
    CHECK(queries.nodes_opened(at(0)) > 0);
    CHECK(queries.nodes_opened(at(0)) == 0);
    CHECK(queries.nodes_opened(at(1e-6)) == 0);
    queries.refit();
    CHECK(queries.nodes_opened(at(0)) > 0);
    // Further than any front may reach.
    for (int i = 1; i < 10; ++i) CHECK(queries.nodes_opened(at(0.01 * i)) > 0);
}

TEST_CASE("objects of the same meshes have fronts of their own, in whatever order they come") {
    const mesh m = waves(40, 0.1F);
    counted_queries queries(m);
    const auto object = [](int i) { return moved({0.05 + 0.02 * i, 0.02, 0.03}, 0.2 + 0.1 * i); };
    for (int frame = 0; frame < 2; ++frame)
        for (int i = 0; i < 20; ++i) CHECK(queries.nodes_opened(object(i)) > 0);
    for (int i = 0; i < 20; ++i) CHECK(queries.nodes_opened(object(i)) == 0);
    for (int i = 20; i-- > 0;) CHECK(queries.nodes_opened(object(7 * i % 20)) == 0);
    // As many as are kept, one after the other: the oldest is forgotten.
    for (int i = 20; i < 1040; ++i) static_cast<void>(queries.nodes_opened(object(i)));
    CHECK(queries.nodes_opened(object(1039)) > 0);
    CHECK(queries.nodes_opened(object(0)) > 0);
}

TEST_CASE("the pair that met last is tried first, and what did not meet is not searched again") {
    const mesh m = waves(40, 0.1F);
    counted_queries queries(m);
    const pose meeting = moved({0.05, 0.02, 0.03}, 0.2);
    CHECK(queries.nodes_opened_for_first(meeting) > 0);
    CHECK(queries.nodes_opened_for_first(meeting) == 0);
    pose apart = moved({0, 0, 0.21}, 0);
    CHECK(queries.nodes_opened_for_first(apart) > 0);
    CHECK(queries.nodes_opened_for_first(apart) > 0);
    CHECK(queries.nodes_opened_for_first(apart) == 0);
    apart.translation[2] -= 1e-6;
    CHECK(queries.nodes_opened_for_first(apart) == 0);
}
