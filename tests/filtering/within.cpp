// Filters of pairs within a distance, which need not overlap.
#include <rapidcheck.h>

#include <random>
#include <set>

#include "../compositions.hpp"
#include "../meshes.hpp"
#include "../strategies/costs.hpp"
#include "../strategies/searches.hpp"
#include "filtered_scenes.hpp"

import aabb.build.median;
import aabb.distance;
import aabb.partition.none;
import aabb.prepare.neighbour_list;
import aabb.sort.insertion;
import aabb.sweep.one_axis;
import aabb.tree.implicit;
import aabb.validation;

using namespace aabb;

namespace {

using plain_search = global_search<insertion_sort, none_partition, one_axis_sweep>;

/// The scenes of a kind with the pairs at a distance of at most d that the filter keeps.
std::vector<filtered_scene> scenes_within(const std::string& kind, double d, box_metric metric) {
    std::vector<filtered_scene> scenes = filtered_scenes(kind);
    for (filtered_scene& scene : scenes) {
        std::vector<bool> present;
        for (filtered_scene::frame& frame : scene.frames) {
            present.resize(frame.boxes.size());
            for (const std::uint32_t id : frame.toggled) present[id] = !present[id];
            frame.pairs.clear();
            for (std::uint32_t a = 0; a < present.size(); ++a)
                for (std::uint32_t b = a + 1; b < present.size(); ++b)
                    if (present[a] && present[b] && are_within(frame.boxes[a], frame.boxes[b], d, metric) &&
                        frame.filter.keeps(a, b))
                        frame.pairs.push_back({a, b});
        }
    }
    return scenes;
}

/// Runs a scene by a search that is composed at compile time and has a filter in it.
template <class Make>
int first_wrong_frame_of(const filtered_scene& scene, Make make) {
    collision_filter filter;
    auto search = make(filter);
    return first_wrong_frame(search, filter, scene, [] {});
}

/// Whether a stage behind a filter does not find the pairs of some scene.
template <class Make>
bool is_wrong_in_any(const std::vector<filtered_scene>& scenes, Make make) {
    return std::ranges::any_of(scenes,
                               [&](const filtered_scene& scene) { return first_wrong_frame(make(), scene) >= 0; });
}

}  // namespace

TEST_CASE("every composition and engine finds exactly the pairs within a distance that a filter keeps", "[long]") {
    const scoped_costs costs(costs_for_indices());
    const std::vector<aabb::composition> compositions = global_compositions();
    for (const char* kind : {"rest", "sets", "together"})
        for (const box_metric metric : {box_metric::euclidean, box_metric::axis}) {
            const std::vector<filtered_scene> scenes = scenes_within(kind, 1.5, metric);
            const auto within = [metric](std::unique_ptr<global_stage> search) {
                return std::make_unique<within_stage>(std::move(search), 1.5, metric);
            };
            for (std::size_t s = 0; s < scenes.size(); ++s) {
                INFO(kind << ", scene " << s);
                for (std::size_t c = s % 4; c < compositions.size(); c += 4) {
                    INFO(text_of_global(compositions[c]));
                    REQUIRE(first_wrong_frame(within(global_of(compositions[c])), scenes[s]) == -1);
                }
                for (const engine_info& engine : engines())
                    if (engine.searches_boxes && engine.exact)
                        REQUIRE(first_wrong_frame(within(make_box_engine(engine.name)), scenes[s]) == -1);
            }
            // The scenes tell these searches from one of overlaps, and from one by the other metric.
            const box_metric other = metric == box_metric::axis ? box_metric::euclidean : box_metric::axis;
            CHECK(is_wrong_in_any(scenes, [] { return global_of({}); }));
            CHECK(
                is_wrong_in_any(scenes, [other] { return std::make_unique<within_stage>(global_of({}), 1.5, other); }));
        }
}

TEST_CASE("a filter may be around or within a search for pairs within a distance, and around a Verlet list") {
    const scoped_costs costs(costs_for_indices());
    using near_search = prepared_search<near_boxes, plain_search>;
    using listed_search = prepared_search<neighbour_list_prepare, plain_search>;
    using inner_filter = filtered_search<plain_search>;
    for (const char* kind : {"rest", "sets", "together"}) {
        const std::vector<filtered_scene> near = scenes_within(kind, 1, box_metric::euclidean);
        for (std::size_t s = 0; s < near.size(); ++s) {
            INFO(kind << ", scene " << s);
            REQUIRE(first_wrong_frame_of(near[s], [](const collision_filter& filter) {
                        return filtered_search<near_search>(filter, near_search(near_boxes{1}));
                    }) == -1);
            REQUIRE(first_wrong_frame_of(near[s], [](const collision_filter& filter) {
                        return prepared_search<near_boxes, inner_filter>(near_boxes{1}, inner_filter(filter));
                    }) == -1);
            REQUIRE(first_wrong_frame_of(filtered_scenes(kind)[s], [](const collision_filter& filter) {
                        return filtered_search<listed_search>(filter);
                    }) == -1);
        }
    }
}

TEST_CASE("a filter keeps triangles within a distance of objects that rest or are in sets") {
    const scoped_costs costs(costs_for_indices());
    using grown_search = prepared_search<grow_boxes, plain_search>;
    using near_triangles = within_detection<median_build, implicit_tree>;
    constexpr double d = 0.5;
    constexpr std::uint32_t n = 20;
    const mesh tetra = tetrahedron(1);
    std::size_t total = 0, unfiltered = 0;
    for (const char* kind : {"rest", "sets", "together"}) {
        std::mt19937 random(9);
        stated_filter stated(n);
        draw(stated, kind, random);
        collision_filter filter;
        stated.tell(filter);
        const std::vector<std::uint32_t> mesh_of(n, 0);
        detector<grown_search, near_triangles> whole({tetra}, mesh_of, grown_search(grow_boxes{d}), near_triangles(d));
        detector<filtered_search<grown_search>, near_triangles> tested(
            {tetra}, mesh_of, filtered_search<grown_search>(filter, grown_search(grow_boxes{d})), near_triangles(d));
        std::vector<pose> poses(n);
        for (int frame = 0; frame < 12; ++frame) {
            for (std::uint32_t id = 0; id < n; ++id)
                if (frame == 0 || !stated.rests[id])
                    for (int k = 0; k < 3; ++k) poses[id].translation[k] = static_cast<double>(random() % 64) / 16;
            std::vector<contact> expected = sorted(whole.contacts(poses));
            unfiltered += expected.size();
            std::erase_if(expected, [&](const contact& c) { return !stated.keeps(c.a, c.b); });
            CHECK(sorted(tested.contacts(poses)) == expected);
            total += expected.size();
        }
    }
    CHECK(total > 100);
    CHECK(unfiltered > total + 100);
}
