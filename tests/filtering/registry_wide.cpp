// Every composition and engine, with every part of a filter.
#include <rapidcheck.h>

#include <random>
#include <set>

#include "../compositions.hpp"
#include "../meshes.hpp"
#include "../strategies/costs.hpp"
#include "filtered_scenes.hpp"

import aabb.distance;
import aabb.validation;

using namespace aabb;

namespace {

/// A composition or an engine.
struct box_method {
    std::string name;
    std::function<std::unique_ptr<global_stage>()> make;
};

/// Every exact method that finds pairs of boxes.
std::vector<box_method> box_methods() {
    std::vector<box_method> methods;
    for (const aabb::composition& c : global_compositions())
        methods.push_back({text_of_global(c), [c] { return global_of(c); }});
    REQUIRE(methods.size() > 50);
    const std::size_t compositions = methods.size();
    for (const engine_info& engine : engines())
        if (engine.searches_boxes && engine.exact)
            methods.push_back({engine.name, [name = engine.name] { return make_box_engine(name); }});
    REQUIRE(methods.size() > compositions + 2);
    return methods;
}

/// The costs of a scene: in every other one an index and a join are worth it at once.
cost_model costs_of_scene(std::size_t scene) {
    return scene % 2 == 1 ? costs_for_indices() : cost_model();
}

/// An index is for objects at rest, and a join for sets.
void check_usage(const std::string& kind, const filter_usage& used, std::size_t least) {
    const bool has_rest = kind == "rest" || kind == "together", has_sets = kind == "sets" || kind == "together";
    CHECK((used.indexed > 0) == has_rest);
    CHECK((used.joined > 0) == has_sets);
    if (kind == "rest") CHECK(used.indexed >= least);
    if (kind == "sets") CHECK(used.joined >= least);
}

}  // namespace

TEST_CASE(
    "every composition and engine finds exactly the pairs that a filter keeps, as objects come, move, rest and go",
    "[long]") {
    const std::vector<box_method> methods = box_methods();
    std::size_t kept = 0, removed = 0, combinations = 0;
    for (const std::string& kind : filter_kinds) {
        const std::vector<filtered_scene>& scenes = filtered_scenes(kind);
        for (const filtered_scene& scene : scenes)
            for (const filtered_scene::frame& frame : scene.frames) {
                kept += frame.pairs.size();
                removed += overlapping(frame.boxes).size() - frame.pairs.size();
            }
        for (const box_method& tested : methods) {
            filter_usage used;
            INFO(tested.name << ", " << kind);
            for (std::size_t s = 0; s < scenes.size(); ++s) {
                const scoped_costs costs(costs_of_scene(s));
                INFO("scene " << s);
                REQUIRE(first_wrong_frame(tested.make(), scenes[s], &used) == -1);
                ++combinations;
            }
            check_usage(kind, used, 80);
        }
    }
    CHECK(kept > 10'000);
    CHECK(removed > 10'000);
    CHECK(combinations == methods.size() * 6 * 20);
    WARN(combinations << " combinations of " << methods.size()
                      << " compositions and engines, 6 kinds of filter and 20 scenes of 12 frames are exact");
}

// With RC_PARAMS=max_success=100000 in the environment these are a hundred thousand scenes.
TEST_CASE("whatever work costs, any composition or engine finds exactly the pairs that any filter keeps", "[long]") {
    const std::vector<box_method> methods = box_methods();
    REQUIRE(rc::check([&] {
        const scoped_costs costs(*rc::gen::arbitrary<bool>() ? any_costs() : cost_model());
        const box_method& tested = methods[*rc::gen::inRange<std::size_t>(0, methods.size())];
        const std::string kind = *rc::gen::elementOf(filter_kinds);
        const std::uint32_t seed = *rc::gen::inRange(0U, 1'000'000'000U);
        RC_LOG(tested.name + ", " + kind);
        const filtered_scene scene = make_filtered_scene(kind, seed, *rc::gen::element(20U, 70U, 200U));
        RC_ASSERT(first_wrong_frame(tested.make(), scene) == -1);
    }));
}

TEST_CASE("all objects may be searched, whether they rest or are in sets") {
    for (const std::string& kind : filter_kinds)
        for (std::size_t s = 0; s < filtered_scenes(kind).size(); ++s) {
            const scoped_costs costs(costs_for_indices());
            INFO(kind << ", scene " << s);
            filter_usage used;
            // Those within a distance of 0 are those that overlap.
            auto search = std::make_unique<within_stage>(global_of({}), 0);
            REQUIRE(first_wrong_frame(std::move(search), filtered_scenes(kind)[s], &used) == -1);
            CHECK(used.indexed + used.joined == 0);
        }
}

namespace {

/// Objects of meshes that move, the filter, and the contacts that it keeps in each frame.
struct mesh_frames {
    std::shared_ptr<manual_scene> scene;
    stated_filter filter;
    std::vector<std::vector<pose>> poses;
    std::vector<std::vector<contact>> all_contacts, contacts;
};

/// Tetrahedra and long sheets, which are divided, that meet in many ways; of few triangles, since a filter sees objects
/// only. What rests stays where it is, for the most part.
mesh_frames make_mesh_frames(const std::string& kind, std::uint32_t seed) {
    constexpr std::uint32_t objects = 24;
    std::mt19937 random(seed);
    std::vector<std::uint32_t> mesh_of;
    for (std::uint32_t i = 0; i < objects; ++i) mesh_of.push_back(i % 4 == 0 ? 1 : 0);
    mesh_frames moving{.scene = std::make_shared<manual_scene>(std::vector{tetrahedron(1), ripples(2)}, mesh_of),
                       .filter = stated_filter(objects),
                       .poses = {},
                       .all_contacts = {},
                       .contacts = {}};
    draw(moving.filter, kind, random);
    const auto global = global_of({});
    const auto local = local_of({});
    pipeline stages(*moving.scene, *global, *local);
    std::vector<pose> poses(objects);
    for (int f = 0; f < 12; ++f) {
        for (std::uint32_t id = 0; id < objects; ++id)
            if (f == 0 || random() % (moving.filter.rests[id] ? 128 : 2) == 0)
                for (int k = 0; k < 3; ++k) poses[id].translation[k] = static_cast<double>(random() % 64) / 16;
        stages.update(poses);
        stages.search();
        stages.detect();
        moving.poses.push_back(poses);
        moving.all_contacts.push_back(sorted(stages.contacts()));
        moving.contacts.push_back(moving.all_contacts.back());
        std::erase_if(moving.contacts.back(), [&](const contact& c) { return !moving.filter.keeps(c.a, c.b); });
    }
    return moving;
}

std::size_t check_contacts(const mesh_frames& moving, std::unique_ptr<global_stage> global,
                           std::unique_ptr<local_stage> local, filter_usage& used) {
    collision_filter filter;
    moving.filter.tell(filter);
    const auto stage = filtered(std::move(global), filter);
    pipeline stages(*moving.scene, *stage, *local);
    std::size_t total = 0;
    for (std::size_t f = 0; f < moving.poses.size(); ++f) {
        INFO("frame " << f);
        stages.update(moving.poses[f]);
        stages.search();
        stages.detect();
        REQUIRE(sorted(stages.contacts()) == moving.contacts[f]);
        if (f % 2 == 0) REQUIRE(stages.count_contacts() == moving.contacts[f].size());  // takes as long as to detect
        REQUIRE(stages.first_contact().has_value() == !moving.contacts[f].empty());
        REQUIRE(std::ranges::all_of(stages.candidates(), [&](index_pair p) { return moving.filter.keeps(p.a, p.b); }));
        total += moving.contacts[f].size();
        used.add(*stage);
    }
    return total;
}

/// A method for both phases.
struct mesh_method {
    std::string name;
    std::function<std::unique_ptr<global_stage>()> make_global;
    std::function<std::unique_ptr<local_stage>()> make_local;
};

std::vector<mesh_method> mesh_methods() {
    std::vector<mesh_method> methods;
    std::vector<aabb::composition> compositions = every_composition(stage::global_search);
    for (const char* size : {"0.3", "1"})
        compositions.emplace_back()[strategy_kind::prepare] = {"split_mesh", {{"size", size}}};
    for (const aabb::composition& c : compositions)
        if (is_exact(c, stage::global_search))
            methods.push_back({text_of_global(c), [c] { return global_of(c); }, [] { return local_of({}); }});
    for (const aabb::composition& c : every_composition(stage::local_detection))
        if (is_exact(c, stage::local_detection))
            methods.push_back({text_of_local(c), [] { return global_of({}); }, [c] { return local_of(c); }});
    const std::size_t of_strategies = methods.size();
    for (const engine_info& engine : engines())
        if (engine.collides_meshes && engine.exact)
            methods.push_back(
                {engine.name, [] { return global_of({}); }, [name = engine.name] { return make_mesh_engine(name); }});
    REQUIRE(of_strategies > 50);
    REQUIRE(methods.size() > of_strategies);
    return methods;
}

/// With sanitizers, which are slow, few scenes.
constexpr std::uint32_t mesh_scenes =
#if __has_feature(address_sanitizer)
    2;
#else
    20;
#endif

}  // namespace

TEST_CASE("every composition and engine of meshes finds exactly the contacts of the pairs that a filter keeps",
          "[long]") {
    const std::vector<mesh_method> methods = mesh_methods();
    std::size_t total = 0, combinations = 0;
    for (const std::string& kind : filter_kinds) {
        std::vector<filter_usage> used(methods.size());
        for (std::uint32_t seed = 0; seed < mesh_scenes; ++seed) {
            const mesh_frames moving = make_mesh_frames(kind, seed);
            const scoped_costs costs(costs_of_scene(seed));
            for (std::size_t m = 0; m < methods.size(); ++m) {
                INFO(methods[m].name << ", " << kind << ", scene " << seed);
                total += check_contacts(moving, methods[m].make_global(), methods[m].make_local(), used[m]);
                ++combinations;
            }
        }
        for (std::size_t m = 0; m < methods.size(); ++m) {
            INFO(methods[m].name << ", " << kind);
            check_usage(kind, used[m], 4 * mesh_scenes);
        }
    }
    CHECK(total > 10'000);
    CHECK(combinations == methods.size() * 6 * mesh_scenes);
    WARN(combinations << " combinations of " << methods.size()
                      << " compositions and engines of meshes, 6 kinds of filter and " << mesh_scenes
                      << " scenes of 12 frames are exact");
}

TEST_CASE("the ground truth finds what the filter keeps") {
    for (const std::string& kind : filter_kinds) {
        const mesh_frames moving = make_mesh_frames(kind, 7);
        collision_filter filter;
        moving.filter.tell(filter);
        ground_truth truth(24, moving.scene.get(), &filter), whole(24, moving.scene.get());
        posed_boxes boxes(*moving.scene);
        std::size_t removed = 0;
        for (std::size_t f = 0; f < moving.poses.size(); ++f) {
            boxes.update(moving.poses[f]);
            for (ground_truth* t : {&truth, &whole})
                t->compute({.boxes = boxes.boxes(), .poses = moving.poses[f], .arrivals = {}, .departures = {}});
            std::vector<index_pair> pairs = whole.pairs();
            std::erase_if(pairs, [&](index_pair p) { return !moving.filter.keeps(p.a, p.b); });
            CHECK(truth.pairs() == pairs);
            CHECK(truth.contacts() == moving.contacts[f]);
            CHECK(whole.contacts() == moving.all_contacts[f]);
            removed += whole.contacts().size() - truth.contacts().size();
        }
        CHECK(removed > 0);
    }
}
