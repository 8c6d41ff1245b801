// Every composition and engine, with every way to leave out pairs.
#include <random>
#include <set>

#include "../compositions.hpp"
#include "../meshes.hpp"
#include "filtered_scenes.hpp"

import aabb.validation;

using namespace aabb;

TEST_CASE("every composition finds exactly the pairs that a filter keeps, as objects come, move, rest and go",
          "[long]") {
    const std::vector<aabb::composition> compositions = global_compositions();
    REQUIRE(compositions.size() > 50);
    std::size_t kept = 0, left_out = 0;
    for (const std::string& kind : filter_kinds) {
        for (const filtered_scene& scene : filtered_scenes(kind))
            for (const filtered_scene::frame& frame : scene.frames) {
                kept += frame.pairs.size();
                left_out += overlapping(frame.boxes).size() - frame.pairs.size();
            }
        for (const aabb::composition& composition : compositions)
            for (std::size_t s = 0; s < filtered_scenes(kind).size(); ++s) {
                INFO(text_of_global(composition) << ", " << kind << ", scene " << s);
                REQUIRE(first_wrong_frame(global_of(composition), filtered_scenes(kind)[s]) == -1);
            }
    }
    CHECK(kept > 10'000);
    CHECK(left_out > 10'000);
}

TEST_CASE("every engine finds exactly the pairs that a filter keeps") {
    std::size_t tried = 0;
    for (const engine_info& engine : engines()) {
        if (!engine.searches_boxes || !engine.exact) continue;
        for (const std::string& kind : filter_kinds)
            for (std::size_t s = 0; s < filtered_scenes(kind).size(); ++s) {
                INFO(engine.name << ", " << kind << ", scene " << s);
                for (const auto when : {filtering::early, filtering::late})
                    REQUIRE(first_wrong_frame(make_box_engine(engine.name), filtered_scenes(kind)[s], when) == -1);
            }
        ++tried;
    }
    CHECK(tried > 2);
}

TEST_CASE("objects at rest may be searched as well") {
    for (const std::string& kind : filter_kinds)
        for (std::size_t s = 0; s < filtered_scenes(kind).size(); ++s) {
            INFO(kind << ", scene " << s);
            REQUIRE(first_wrong_frame(global_of({}), filtered_scenes(kind)[s], filtering::late) == -1);
        }
}

namespace {

struct mesh_frames {
    std::shared_ptr<manual_scene> scene;
    std::vector<std::vector<pose>> poses;
    std::vector<std::vector<contact>> contacts;  ///< of all pairs of objects
};

/// Tetrahedra and a long sheet, which is divided, that meet in many ways.
mesh_frames make_mesh_frames(std::uint32_t seed, std::uint32_t objects) {
    std::mt19937 random(seed);
    std::vector<std::uint32_t> mesh_of;
    for (std::uint32_t i = 0; i < objects; ++i) mesh_of.push_back(i % 4 == 0 ? 1 : 0);
    mesh_frames made{std::make_shared<manual_scene>(std::vector{tetrahedron(1), ripples(6)}, mesh_of), {}, {}};
    const auto global = global_of({});
    const auto local = local_of({});
    pipeline stages(*made.scene, *global, *local);
    std::vector<pose> poses(objects);
    for (int f = 0; f < 3; ++f) {
        for (pose& p : poses)
            if (f == 0 || random() % 2 == 0)
                for (int k = 0; k < 3; ++k) p.translation[k] = static_cast<double>(random() % 64) / 16;
        stages.update(poses);
        stages.search();
        stages.detect();
        made.poses.push_back(poses);
        made.contacts.push_back(sorted(stages.contacts()));
    }
    return made;
}

void check_contacts(const mesh_frames& made, const std::string& kind, std::uint32_t seed,
                    std::unique_ptr<global_stage> global, std::unique_ptr<local_stage> local, std::size_t& total) {
    std::mt19937 random(seed);
    stated_filter stated(made.scene->mesh_of.size());
    draw(stated, kind, random);
    collision_filter filter;
    stated.tell(filter);
    const auto stage = filtered(std::move(global), filter);
    pipeline stages(*made.scene, *stage, *local);
    for (std::size_t f = 0; f < made.poses.size(); ++f) {
        INFO(kind << ", seed " << seed << ", frame " << f);
        std::vector<contact> expected;
        for (const contact& c : made.contacts[f])
            if (stated.keeps(c.a, c.b)) expected.push_back(c);
        stages.update(made.poses[f]);
        stages.search();
        stages.detect();
        REQUIRE(sorted(stages.contacts()) == expected);
        REQUIRE(stages.count_contacts() == expected.size());
        REQUIRE(stages.first_contact().has_value() == !expected.empty());
        for (const index_pair p : stages.candidates()) REQUIRE(stated.keeps(p.a, p.b));
        total += expected.size();
    }
}

}  // namespace

TEST_CASE("every composition and engine of meshes finds exactly the contacts of the pairs that a filter keeps") {
    std::vector<aabb::composition> compositions = every_composition(stage::global_search);
    for (const char* size : {"0.3", "1"})
        compositions.emplace_back()[strategy_kind::prepare] = {"split_mesh", {{"size", size}}};
    std::size_t total = 0, divided = 0;
    for (std::uint32_t seed = 0; seed < 4; ++seed) {
        const mesh_frames made = make_mesh_frames(seed, 24);
        for (const std::string& kind : filter_kinds) {
            for (const aabb::composition& c : compositions) {
                if (!is_exact(c, stage::global_search)) continue;
                INFO(text_of_global(c));
                check_contacts(made, kind, seed, global_of(c), local_of({}), total);
                divided += needs_meshes(c).empty() ? 0 : 1;
            }
            for (const aabb::composition& c : every_composition(stage::local_detection)) {
                if (!is_exact(c, stage::local_detection)) continue;
                INFO(text_of_local(c));
                check_contacts(made, kind, seed, global_of({}), local_of(c), total);
            }
            for (const engine_info& engine : engines()) {
                if (!engine.collides_meshes || !engine.exact) continue;
                INFO(engine.name);
                check_contacts(made, kind, seed, global_of({}), make_mesh_engine(engine.name), total);
            }
        }
    }
    CHECK(total > 10'000);
    CHECK(divided > 0);
}

TEST_CASE("the ground truth leaves out what the filter leaves out") {
    for (const std::string& kind : filter_kinds) {
        std::mt19937 random(5);
        stated_filter stated(24);
        draw(stated, kind, random);
        collision_filter filter;
        stated.tell(filter);
        const mesh_frames made = make_mesh_frames(7, 24);
        ground_truth truth(24, made.scene.get(), &filter), whole(24, made.scene.get());
        posed_boxes boxes(*made.scene);
        for (const std::vector<pose>& poses : made.poses) {
            boxes.update(poses);
            for (ground_truth* t : {&truth, &whole})
                t->compute({.boxes = boxes.boxes(), .poses = poses, .arrivals = {}, .departures = {}});
            std::vector<index_pair> pairs = whole.pairs();
            std::erase_if(pairs, [&](index_pair p) { return !stated.keeps(p.a, p.b); });
            std::vector<contact> contacts = whole.contacts();
            std::erase_if(contacts, [&](const contact& c) { return !stated.keeps(c.a, c.b); });
            CHECK(truth.pairs() == pairs);
            CHECK(truth.contacts() == contacts);
            CHECK(whole.contacts().size() > contacts.size());
        }
    }
}
