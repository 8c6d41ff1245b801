// Counts every allocation of the process but those of large arrays (`large_vector`), which no scene here needs: once
// the buffers have grown to the scene, neither stage may allocate.

#include "../compositions.hpp"
#include "../meshes.hpp"
#include "counted_new.hpp"

import aabb.distance;
import aabb.distance_stages;

using namespace aabb;

namespace {

/// Boxes on circles around their places, so that lists change their order and return to it; some boxes rest.
std::vector<box> orbiting(int frame) {
    std::vector<box> boxes;
    for (int i = 0; i < 300; ++i) {
        const float angle = (i % 5 == 0 ? 0 : 0.7F) * static_cast<float>(frame) + static_cast<float>(i);
        const vec3f at{static_cast<float>(i * 37 % 101) + std::cos(angle),
                       static_cast<float>(i * 53 % 97) + std::sin(angle), static_cast<float>(i * 29 % 89)};
        boxes.push_back({at, at + vec3f{4, 4, 4}});
    }
    return boxes;
}

}  // namespace

TEST_CASE("global search allocates nothing in steady state") {
    std::vector<std::vector<box>> frames;
    for (int frame = 0; frame < 9; ++frame) frames.push_back(orbiting(frame));
    for (const aabb::composition& composition : global_compositions()) {
        INFO(text_of_global(composition));
        const auto stage = global_of(composition, instrumentation::none);
        for (std::uint32_t id = 0; id < frames[0].size(); ++id) stage->insert(id);
        std::vector<index_pair> pairs;
        bool are_absent = false;
        std::size_t new_allocations = 0;
        // A thread needs more memory when it first takes a larger group, which may be late. So may be a Verlet list of
        // other boxes than the lists before, and columns that are planned from a frame from which none were planned
        // before.
        const bool may_be_late = composition[strategy_kind::prepare] == strategy_choice{"neighbour_list", {}} ||
                                 composition[strategy_kind::partition].name == "columns";
        const int rounds = may_be_late ? 200 : 4;
        for (int round = 0; round < rounds && (round < 4 || new_allocations > 0); ++round) {
            const std::size_t before = allocations.made;
            for (const auto& boxes : frames) {
                for (const std::uint32_t id : {7U, 30U, 299U}) are_absent ? stage->insert(id) : stage->remove(id);
                are_absent = !are_absent;
                pairs.clear();
                stage->update(boxes);
                stage->search(pairs);
            }
            new_allocations = allocations.made - before;
        }
        CHECK(new_allocations == 0);
        CHECK_FALSE(pairs.empty());
    }
}

TEST_CASE("a filter allocates nothing in steady state, though indices are built and sets joined again and again") {
    // Most boxes rest in the first half of a round; in the second, more than half of them wake. Both ways are worth it
    // at once.
    cost_model costs;
    costs.refit_box = costs.open_node = 1e-9;
    set_machine_costs(costs);
    constexpr std::uint32_t n = 300;
    constexpr int frames = 24;
    for (const char* kind : {"rest", "sets"}) {
        const bool has_sets = std::string_view(kind) == "sets";
        INFO(kind);
        collision_filter filter;
        for (std::uint32_t id = 0; id < n; ++id)
            filter.set(id, {.set = !has_sets ? object_set::none : id % 10 == 0 ? object_set::a : object_set::b});
        filter.add_exceptions(std::vector<index_pair>{{1, 2}, {3, 40}});
        const auto stage = filtered(global_of({}), filter);
        for (std::uint32_t id = 0; id < n; ++id) stage->insert(id);
        std::vector<std::vector<box>> boxes;
        for (int frame = 0; frame < frames; ++frame) {
            boxes.push_back(orbiting(has_sets ? frame % 3 : 0));
            for (std::uint32_t id = 0; id < n; id += 10) boxes.back()[id] = orbiting(frame)[id];
        }
        std::vector<index_pair> pairs;
        std::size_t new_allocations = 0, changes = 0;
        for (int round = 0; round < 200 && (round < 4 || new_allocations > 0); ++round) {
            new_allocations = changes = 0;
            std::size_t indexed_before = 0;
            for (int frame = 0; frame < frames; ++frame) {
                const std::size_t before = allocations.made;
                for (std::uint32_t id = 0; id < n && !has_sets; ++id)
                    filter.set(id, {.rests = id % 10 != 0 && (frame < frames / 2 || (id % 2 != 0 && id % 10 != 1))});
                // Then a join has another index.
                if (frame % 4 == 0 && has_sets) frame % 8 == 0 ? stage->remove(7) : stage->insert(7);
                pairs.clear();
                stage->update(boxes[static_cast<std::size_t>(frame)]);
                stage->search(pairs);
                new_allocations += allocations.made - before;
                std::size_t indexed = 0;
                for (const stage_plan& plan : stage->plans())
                    if (plan.kind == (has_sets ? plan_kind::set_join : plan_kind::resting_index))
                        indexed = static_cast<std::size_t>(plan.decision[has_sets ? "stored" : "indexed"]);
                changes += indexed != indexed_before && indexed > 0 ? 1 : 0;
                indexed_before = indexed;
            }
        }
        CHECK(new_allocations == 0);
        CHECK(changes >= 2);
        CHECK_FALSE(pairs.empty());
    }
    set_machine_costs({});
}

TEST_CASE("local detection allocates nothing in steady state") {
    for (const aabb::composition& composition : local_compositions()) {
        INFO(text_of_local(composition));
        // Fronts are kept only for meshes with at least this many leaves.
        mesh m = ripples(keeps_fronts(composition) ? 12 : 6);
        const auto stage = local_of(composition, instrumentation::none);
        const auto model = stage->add_model(m);
        std::vector<index_pair> pairs;
        std::size_t before = 0;
        for (int round = 0; round < 2; ++round) {
            if (round == 1) before = allocations.made;
            for (int step = 0; step < 5; ++step) {
                const pose moved = shifted({0.3 * step, 0.2, 0.1});
                pairs.clear();
                stage->all_pairs(model, {}, model, moved, pairs);
                if (!stage->first_pair(model, {}, model, moved)) std::abort();
                if (stage->count_pairs(model, {}, model, moved) != pairs.size()) std::abort();
                stage->self_pairs(model, pairs);
                std::size_t visited = 0;
                stage->each_self_pair(model, [&](index_pair) { return ++visited == 0; });
                if (visited == 0) std::abort();
                stage->refit(model);
            }
        }
        const std::size_t new_allocations = allocations.made - before;
        CHECK(new_allocations == 0);
        CHECK_FALSE(pairs.empty());
    }
}

TEST_CASE("distances allocate nothing in steady state") {
    const std::vector<box> boxes = orbiting(0);
    within_stage near_boxes(global_of(composed({{strategy_kind::sort, "insertion"}})), 3);
    for (std::uint32_t id = 0; id < boxes.size(); ++id) near_boxes.insert(id);
    for (const strategy_info& tree : strategies(strategy_kind::tree)) {
        CAPTURE(tree.name);
        const aabb::composition c = composed({{strategy_kind::tree, tree.name.c_str()}});
        mesh m = ripples(6);
        const auto near = compose_within(c, 2);
        const auto model = near->add_model(m);
        const auto measured = compose_distance(c);
        measured->add_model(m);
        std::vector<index_pair> pairs;
        std::size_t before = 0;
        for (int round = 0; round < 2; ++round) {
            if (round == 1) before = allocations.made;
            for (int step = 0; step < 5; ++step) {
                const pose moved = shifted({0.3 * step, 0.2, 2.25});
                pairs.clear();
                near->all_pairs(model, {}, model, moved, pairs);
                if (!near->first_pair(model, {}, model, moved)) std::abort();
                if (near->count_pairs(model, {}, model, moved) != pairs.size()) std::abort();
                near->refit(model);
                if (measured->distance(0, {}, 0, moved).distance > 2) std::abort();
                pairs.clear();
                near_boxes.update(boxes);
                near_boxes.search(pairs);
            }
        }
        const std::size_t new_allocations = allocations.made - before;
        CHECK(new_allocations == 0);
        CHECK_FALSE(pairs.empty());
    }
}
