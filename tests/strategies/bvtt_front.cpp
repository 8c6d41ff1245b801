#include <rapidcheck.h>

#include "../compositions.hpp"
#include "../meshes.hpp"
#include "../random_poses.hpp"

import aabb.strategies;
import aabb.wide_tree.child_pairs;
import aabb.wide_tree.bvtt_front;

using namespace aabb;

namespace {

composition keeping() {
    return composed({{strategy_kind::build, "sah"}, {strategy_kind::tree, "implicit:front=kept"}});
}
composition forgetting() {
    return composed({{strategy_kind::build, "sah"}, {strategy_kind::tree, "implicit"}});
}

std::unique_ptr<local_stage> stage_of(const composition& c, std::span<const mesh> models,
                                      instrumentation counted = instrumentation::none) {
    auto stage = local_of(c, counted);
    for (const mesh& m : models) stage->add_model(m);
    return stage;
}

/// A sheet of 2 edges² triangles, as long and broad as 1, in waves.
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

/// Of one stage, what a query adds.
class counted_queries {
public:
    explicit counted_queries(const mesh& m) : stage_(stage_of(keeping(), {&m, 1}, instrumentation::counters)) {}

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

TEST_CASE("images of a vertex under two poses are no further apart than is said, nor much less") {
    REQUIRE(rc::check([] {
        const float size = *rc::gen::element(1e-30F, 1e-3F, 1.0F, 1e30F);
        const box reach{{-size, 0, size / 2}, {size, size, size}};
        const auto any = [&](double turn) { return turned_up_to(turn, any_vector(2 * size)); };
        const double turn = *rc::gen::element(0.0, 1e-9, 1e-3, 1.0);
        const pose a = any(1);
        const pose b = any(turn);
        pose c = *rc::gen::arbitrary<bool>() ? any(turn) : b;
        if (*rc::gen::arbitrary<bool>()) c.rotation = b.rotation;
        const relative_pose p(a, b, reach);
        const relative_pose q(a, c, reach);
        const double said = displacement_bound(p.to_boxes(), q.to_boxes(), reach);
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

TEST_CASE("children within a margin of each other are found, however one node is turned against the other") {
    REQUIRE(rc::check([] {
        const double margin = uniform(0.01, 0.5);
        const double turn = *rc::gen::element(0.0, 0.01, 1.0);
        const pose pose_b = turned_up_to(turn, any_vector(2));
        // A leaf is one point, eight times.
        std::array<mesh, 2> meshes;
        for (std::uint32_t point = 0; point < 8; ++point) {
            vec3d here;
            vec3d away;
            double square = 0;
            for (int k = 0; k < 3; ++k) {
                here[k] = static_cast<float>(uniform(-1, 1));
                away[k] = uniform(-1, 1);
                square += away[k] * away[k];
            }
            vec3f back{};
            for (int j = 0; j < 3; ++j) {
                double sum = 0;
                for (int k = 0; k < 3; ++k)
                    sum += pose_b.rotation[3 * k + j] *
                           (here[k] + 0.999 * margin * away[k] / std::sqrt(square) - pose_b.translation[k]);
                back[j] = static_cast<float>(sum);
            }
            meshes[0].vertices.push_back(
                {static_cast<float>(here[0]), static_cast<float>(here[1]), static_cast<float>(here[2])});
            meshes[1].vertices.push_back(back);
            for (mesh& m : meshes) m.triangles.insert(m.triangles.end(), 8, {point, point, point});
        }
        const model<implicit_tree> a(meshes[0], as_tree_builder<median_build>());
        const model<implicit_tree> b(meshes[1], as_tree_builder<median_build>());
        child_pairs<implicit_tree> pairs;
        pairs.begin(a.tree(), b.tree(), relative_pose({}, pose_b, b.bounds()), a.bounds(), margin);
        no_counters counters;
        const std::array<std::uint32_t, 1> roots{0};
        const auto found = pairs.find_overlapping(a.tree().level(0), roots, b.tree().level(0), roots, counters);
        const std::uint64_t met = found.empty() ? 0 : found[0].mask;
        for (std::uint32_t i = 0; i < 8; ++i)
            for (std::uint32_t j = 0; j < 8; ++j)
                if (a.tree().triangle_at(8 * i) / 8 == b.tree().triangle_at(8 * j) / 8)
                    RC_ASSERT((met >> (8 * j + i) & 1U) != 0);
    }));
}

// The margin of a front is a few hundredths of a leaf, so a step in ten or so ends it. Several objects of several
// meshes of any size, far from their own origin and turned by what is hardly a rotation.
TEST_CASE("kept pairs of leaves hold all that meets, however meshes creep, stop, jump and change") {
    std::size_t asked = 0;
    std::size_t served = 0;
    REQUIRE(rc::check([&] {
        const float size = *rc::gen::element(1.0F, 1e-3F, 1e-30F, 1e-37F, 1e30F);
        const float off = *rc::gen::element(0.0F, 0.0F, 100.0F);
        std::vector<mesh> meshes;
        for (const float height : {0.2F, 0.1F, 0.05F}) {
            meshes.push_back(waves(*rc::gen::inRange(12U, 20U), height));
            for (vec3f& p : meshes.back().vertices)
                for (int k = 0; k < 3; ++k) p[k] = (p[k] + off) * size;
        }
        const auto kept = stage_of(keeping(), meshes, instrumentation::counters);
        const auto fresh = stage_of(forgetting(), meshes);
        struct object {
            std::array<std::uint32_t, 2> models;
            std::array<double, 3> at;
            std::array<double, 3> way;
            double turn;
            double turned;
            double skew;
        };
        const auto choose_way = [&](object& o) {
            const double speed = *rc::gen::element(0.0, 0.0, 1e-6, 1e-4, 1e-3, 1e-2, 5e-2) / 10;
            for (double& w : o.way) w = uniform(-speed, speed);
            o.turned = off == 0 ? uniform(-speed, speed) : 0;
        };
        std::vector<object> objects(*rc::gen::inRange<std::size_t>(1, 4));
        for (object& o : objects) {
            for (std::uint32_t& model : o.models) model = *rc::gen::inRange(0U, 3U);
            for (double& x : o.at) x = uniform(-0.2, 0.2);
            o.turn = off == 0 ? uniform(-0.5, 0.5) : 0;
            o.skew = *rc::gen::element(0.0, 4e-7, -4e-7);
            // Other meshes at the same place.
            if (*rc::gen::arbitrary<bool>()) {
                o.at = objects[0].at;
                o.turn = objects[0].turn;
            }
            choose_way(o);
        }
        for (int frame = 0; frame < 25; ++frame) {
            if (*rc::gen::weightedElement<bool>({{20, false}, {1, true}})) {
                const auto changed = *rc::gen::inRange<std::uint32_t>(0, 3);
                mesh& m = meshes[changed];
                m.vertices[*rc::gen::inRange<std::size_t>(0, m.vertices.size())][2] += 0.1F * size;
                kept->refit(changed);
                fresh->refit(changed);
            }
            for (object& o : objects) {
                if (*rc::gen::weightedElement<bool>({{12, false}, {1, true}})) choose_way(o);
                for (std::size_t k = 0; k < 3; ++k) o.at[k] += o.way[k];
                o.turn += o.turned;
                pose pose_b = moved({o.at[0] * size, o.at[1] * size, o.at[2] * size}, o.turn);
                for (const std::size_t r : {0U, 4U, 8U}) pose_b.rotation[r] *= 1 + o.skew;
                std::vector<index_pair> truth;
                fresh->all_pairs(o.models[0], {}, o.models[1], pose_b, truth);
                truth = sorted(truth);
                const std::uint64_t before = kept->counters()[work::node_visits];
                const int how = *rc::gen::inRange(0, 3);
                if (how == 0) {
                    std::vector<index_pair> found;
                    kept->all_pairs(o.models[0], {}, o.models[1], pose_b, found);
                    RC_ASSERT(sorted(found) == truth);
                } else if (how == 1) {
                    RC_ASSERT(kept->count_pairs(o.models[0], {}, o.models[1], pose_b) == truth.size());
                } else {
                    const std::optional<index_pair> first = kept->first_pair(o.models[0], {}, o.models[1], pose_b);
                    RC_ASSERT(first.has_value() == !truth.empty());
                    if (first) RC_ASSERT(std::ranges::binary_search(truth, *first));
                }
                ++asked;
                served += kept->counters()[work::node_visits] == before;
            }
        }
    }));
    CHECK(served > asked / 4);
}

TEST_CASE("a front is planned after two near queries, and less often after those that served nothing") {
    const box reach{{-1, -1, -1}, {1, 1, 1}};
    const model_pair of{{1, 2}, {3, 4}};
    const auto at = [&](double x) { return relative_pose({}, shifted({x, 0, 0}), reach).to_boxes(); };
    bvtt_front front;
    front.reset(of);
    const auto is_planned = [&](double x) { return front.record_query(of, at(x), reach, 1).margin.has_value(); };
    CHECK_FALSE(is_planned(0));
    CHECK_FALSE(is_planned(0.01));
    CHECK(is_planned(0.02));
    // Asked twice about every pose, what moves fast is never near twice.
    for (int i = 1; i < 5; ++i) {
        CHECK_FALSE(is_planned(i));
        CHECK_FALSE(is_planned(i));
    }
    // Of another state it is another mesh.
    CHECK_FALSE(is_planned(6));
    for (const bool planned : {false, false, true})
        CHECK(front.record_query({{1, 2}, {3, 5}}, at(6), reach, 1).margin.has_value() == planned);

    // Each front is left behind at once.
    front.reset(of);
    std::vector<int> planned;
    for (int i = 0; i < 100; ++i)
        if (is_planned(0.03 * i)) {
            planned.push_back(i);
            front.build(of, at(0.03 * i), 0.001, [](std::vector<front_pair>&) { return true; });
        }
    CHECK(planned == std::vector{2, 4, 8, 16, 32, 64});
    // One that holds too much is not kept.
    front.reset(of);
    static_cast<void>(is_planned(0));
    static_cast<void>(is_planned(0));
    CHECK(is_planned(0));
    CHECK_FALSE(front.build(of, at(0), 0.1, [](std::vector<front_pair>&) { return false; }));
    CHECK_FALSE(front.record_query(of, at(0), reach, 1).is_valid);
}

TEST_CASE("a front holds all that meets at the ends of the range of floats, which margins pass") {
    constexpr float most = std::numeric_limits<float>::max();
    const auto crossing = [](bool upright) {
        return sheet_of(16, [&](std::uint32_t i, std::uint32_t j) -> vec3f {
            const float x = (static_cast<float>(i) / 8 - 1) * most;
            const float y = (static_cast<float>(j) / 8 - 1) * most;
            return upright ? vec3f{x, 0, y} : vec3f{x, y, 0};
        });
    };
    const std::array meshes{crossing(false), crossing(true)};
    const auto kept = stage_of(keeping(), meshes);
    const auto forgotten = stage_of(forgetting(), meshes);
    std::vector<index_pair> wanted;
    forgotten->all_pairs(0, {}, 1, {}, wanted);
    CHECK(wanted.size() > 16);
    for (int query = 0; query < 5; ++query) {
        std::vector<index_pair> pairs;
        kept->all_pairs(0, {}, 1, {}, pairs);
        CHECK(sorted(pairs) == sorted(wanted));
    }
}

TEST_CASE("a front is made in the third query of meshes that hardly move, and opens no nodes from then on") {
    const mesh m = waves(40, 0.1F);
    counted_queries queries(m);
    const auto at = [](double x) { return moved({0.05 + x, 0.02, 0.03}, 0.2); };
    for (int i = 0; i < 3; ++i) CHECK(queries.nodes_opened(at(0)) > 0);
    CHECK(queries.nodes_opened(at(0)) == 0);
    CHECK(queries.nodes_opened(at(1e-6)) == 0);
    queries.refit();
    CHECK(queries.nodes_opened(at(0)) > 0);
    // Further than any front may reach.
    for (int i = 1; i < 10; ++i) CHECK(queries.nodes_opened(at(0.01 * i)) > 0);
}

TEST_CASE("objects of the same meshes have fronts of their own, in whatever order they come") {
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
    // Many more than are kept pass by, and those that are asked about again stay.
    const int kept = front_cache::most;
    for (int i = 20; i < 3 * kept; ++i) {
        queries.nodes_opened(object(i));
        if (i % 40 == 0)
            for (int k = 0; k < 20; ++k) REQUIRE(queries.nodes_opened(object(k)) == 0);
    }
    CHECK(queries.nodes_opened(object(20)) > 0);
}

TEST_CASE("a front that makes room forgets what met") {
    const std::array<mesh, 2> meshes{waves(40, 0.1F), waves(12, 0.1F)};
    const auto kept = stage_of(keeping(), meshes);
    const auto first = [&](std::uint32_t model, std::size_t i, double step) {
        const std::size_t row = i / 40;
        const vec3d by{step * static_cast<double>(i % 40), step * static_cast<double>(row), 0.03};
        return kept->first_pair(model, {}, model, moved(by, 0.2));
    };
    const std::size_t most = front_cache::most;
    std::array<std::size_t, 2> met{};
    for (std::size_t i = 0; i < most; ++i) met[0] += first(0, i, 0.003).has_value();
    for (std::size_t i = 0; i < 80; ++i)
        if (const std::optional<index_pair> of_small = first(1, i, 0.01)) {
            ++met[1];
            REQUIRE(std::max(of_small->a, of_small->b) < meshes[1].triangle_count());
        }
    CHECK(met[0] > most / 2);
    CHECK(met[1] > 20);
}

TEST_CASE("the pair that met last is tried first, and what did not meet is not searched again") {
    const mesh m = waves(40, 0.1F);
    counted_queries queries(m);
    const pose meeting = moved({0.05, 0.02, 0.03}, 0.2);
    CHECK(queries.nodes_opened_for_first(meeting) > 0);
    CHECK(queries.nodes_opened_for_first(meeting) == 0);
    pose apart = moved({0, 0, 0.21}, 0);
    for (int i = 0; i < 3; ++i) CHECK(queries.nodes_opened_for_first(apart) > 0);
    CHECK(queries.nodes_opened_for_first(apart) == 0);
    apart.translation[2] -= 1e-6;
    CHECK(queries.nodes_opened_for_first(apart) == 0);

    // What met and came apart.
    const auto at = [](double z) { return moved({0.17, 0.11, z}, 0); };
    double z = 0.21;
    const auto fresh = stage_of(forgetting(), {&m, 1});
    while (!fresh->first_pair(0, {}, 0, at(z))) z -= 1e-4;
    counted_queries parting(m);
    CHECK(parting.nodes_opened_for_first(at(z)) > 0);
    CHECK(parting.nodes_opened_for_first(at(z)) == 0);
    CHECK(parting.nodes_opened_for_first(at(z + 1e-4)) > 0);
    CHECK(parting.nodes_opened_for_first(at(z + 1e-4)) == 0);
}

TEST_CASE("an inexact triangle test answers as if nothing were kept") {
    const mesh m = waves(40, 0.1F);
    const auto kept =
        stage_of(composed({{strategy_kind::tree, "implicit:front=kept"}, {strategy_kind::triangle, "moller"}}), {&m, 1},
                 instrumentation::counters);
    for (int i = 0; i < 5; ++i) {
        const std::uint64_t before = kept->counters()[work::node_visits];
        static_cast<void>(kept->count_pairs(0, {}, 0, moved({0.05, 0.02, 0.03}, 0.2)));
        CHECK(kept->counters()[work::node_visits] > before);
    }
}
