module;
#include <array>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

module aabblab.atlas;

import :statement;
import aabblab.statistics;

namespace aabblab {

namespace {

// Who plays, as it is labelled.
const std::string columns = "bucket + columns + simd";
const std::string kept_list = "neighbour_list:margin=0.1 + bucket + columns + simd";
const std::string incremental = "insertion + incremental";
const std::string one_axis = "insertion + one_axis";
const std::string simd_sweep = "insertion + simd";
const std::string grid = "std + uniform_grid + simd";
const std::string dynamic_tree = "bullet_dbvt";
const std::string bullet_sap = "bullet_sap";

/// In the map, where a parameter has a value.
struct setting_is {
    std::string_view parameter;
    double value;
};
scene_filter map_with(std::vector<setting_is> settings, bool all_move = true) {
    return [settings = std::move(settings), all_move](const atlas_scene& s) {
        if (s.scene.kind != "cloud" || (all_move && s.number("moving") != 1)) return false;
        for (const setting_is& one : settings)
            if (s.number(one.parameter) != one.value) return false;
        return true;
    };
}

scene_filter resting(double objects, double moving) {
    return map_with({{"objects", objects}, {"moving", moving}}, false);
}

scene_filter kind_is(std::string kind) {
    return [kind = std::move(kind)](const atlas_scene& s) { return s.scene.kind == kind; };
}

statement little_motion() {
    return {
        "B1",
        "Bullet's manual and wiki, \"Broadphase\"",
        "Sweep and prune is fastest where most objects rest; the dynamic tree where many move.",
        {{"10,000 boxes, a hundredth move", bullet_sap, dynamic_tree, resting(10000, 0.01)},
         {"10,000 boxes, a tenth moves", bullet_sap, dynamic_tree, resting(10000, 0.1)},
         {"1,000 boxes, all move by 0.001", bullet_sap, dynamic_tree,
          map_with({{"objects", 1000}, {"displacement", 0.001}})},
         {"1,000 boxes, all move by 1", dynamic_tree, bullet_sap, map_with({{"objects", 1000}, {"displacement", 1}})},
         {"10,000 boxes, all move by 1", dynamic_tree, bullet_sap,
          map_with({{"objects", 10000}, {"displacement", 1}})}}};
}

statement all_asleep() {
    return {
        "B2",
        "P. Terdiman, PhysX issue 96, and PhysX's manual, PxBroadPhaseType",
        "With everything asleep nothing beats incremental sweep and prune; with everything moving pruning in "
        "boxes is much faster.",
        {{"1,000 boxes at rest", incremental, columns, resting(1000, 0)},
         {"10,000 boxes at rest", incremental, columns, resting(10000, 0)},
         {"10,000 boxes at rest", incremental, kept_list, resting(10000, 0)},
         {"1,000 boxes, all move by 1", columns, incremental, map_with({{"objects", 1000}, {"displacement", 1}})},
         {"10,000 boxes, all move by 1", columns, incremental, map_with({{"objects", 10000}, {"displacement", 1}})}}};
}

statement subdivided() {
    statement s{"B3",
                "D. Tracy, S. Buss, B. Woods, IEEE VR 2009, abstract",
                "Sweep and prune that is subdivided is faster than plain sweep and prune, coherence or not.",
                {}};
    for (const double displacement : {0.001, 0.1, 1.0})
        for (const double objects : {1000.0, 10000.0}) {
            const std::string where = objects < 5000 ? "1,000 boxes, by " : "10,000 boxes, by ";
            const std::string by = displacement == 1 ? "1" : displacement == 0.1 ? "0.1" : "0.001";
            s.ratios.push_back(
                {where + by, columns, simd_sweep, map_with({{"objects", objects}, {"displacement", displacement}})});
        }
    s.ratios.push_back({"10,000 boxes, on a grid", "std + uniform_grid + one_axis", one_axis,
                        map_with({{"objects", 10000}, {"ratio", 1}})});
    return s;
}

statement coherent_sweep() {
    return {
        "B4",
        "D. Tracy, S. Buss, B. Woods, IEEE VR 2009, abstract",
        "With coherence, subdivided sweep and prune beats hierarchies of the whole space.",
        {{"1,000 boxes, by 0.01", columns, dynamic_tree, map_with({{"objects", 1000}, {"displacement", 0.01}})},
         {"10,000 boxes, by 0.01", columns, dynamic_tree, map_with({{"objects", 10000}, {"displacement", 0.01}})},
         {"10,000 boxes, by 0.01", columns, "embree_refit", map_with({{"objects", 10000}, {"displacement", 0.01}})}}};
}

statement grid_of_sizes() {
    return {"B5",
            "C. Ericson, Real-Time Collision Detection, 7.1",
            "A uniform grid suits boxes of similar size; where sizes vary greatly it does not, and a hierarchy does.",
            {{"10,000 boxes of one size", grid, dynamic_tree, map_with({{"objects", 10000}, {"ratio", 1}})},
             {"10,000 boxes, sizes 1 to 100", dynamic_tree, grid, map_with({{"objects", 10000}, {"ratio", 100}})},
             {"the lead of the tree, sizes 1 to 100 over one size", dynamic_tree, grid,
              map_with({{"objects", 10000}, {"ratio", 100}}), expectation::less, equivalence_band,
              map_with({{"objects", 10000}, {"ratio", 1}})}}};
}

statement clustered_sweep() {
    return {
        "B6",
        "C. Ericson, Real-Time Collision Detection, 7.5; the manual of BEPUphysics",
        "Sweep and prune suffers where boxes are clustered, which a hierarchy does not.",
        {{"1,000 boxes, 20 clouds over one", dynamic_tree, one_axis, map_with({{"objects", 1000}, {"clouds", 20}}),
          expectation::less, equivalence_band, map_with({{"objects", 1000}, {"clouds", 1}})},
         {"10,000 boxes, 20 clouds over one", dynamic_tree, one_axis, map_with({{"objects", 10000}, {"clouds", 20}}),
          expectation::less, equivalence_band, map_with({{"objects", 10000}, {"clouds", 1}})}}};
}

statement few_boxes() {
    return {"B7",
            "Benchmark of BEPUphysics 0.16, 2011",
            "A sweep along one axis is the fastest of all with 100 boxes; with many, a grid of two axes with a sweep "
            "along the third beats a dynamic hierarchy.",
            {{"100 boxes", one_axis, dynamic_tree, map_with({{"objects", 100}})},
             {"100 boxes", one_axis, columns, map_with({{"objects", 100}})},
             {"10,000 boxes", columns, dynamic_tree, map_with({{"objects", 10000}})},
             {"30,000 boxes", columns, dynamic_tree, map_with({{"objects", 30000}})}}};
}

statement fast_motion() {
    return {
        "B8",
        "The manual of Nape; comments of Box2D 2.0, b2BroadPhase",
        "Sweep and prune is poor at fast motion and at many sizes; a dynamic tree suffers from neither.",
        {{"1,000 boxes, by 1 over by 0.001", dynamic_tree, one_axis, map_with({{"objects", 1000}, {"displacement", 1}}),
          expectation::less, equivalence_band, map_with({{"objects", 1000}, {"displacement", 0.001}})},
         {"10,000 boxes, by 1 over by 0.001", dynamic_tree, one_axis,
          map_with({{"objects", 10000}, {"displacement", 1}}), expectation::less, equivalence_band,
          map_with({{"objects", 10000}, {"displacement", 0.001}})},
         {"10,000 boxes, sizes 1 to 100 over one size", dynamic_tree, one_axis,
          map_with({{"objects", 10000}, {"ratio", 100}}), expectation::less, equivalence_band,
          map_with({{"objects", 10000}, {"ratio", 1}})}}};
}

statement rebuilt() {
    statement s{"B9",
                "F. Chitalu, C. Dubach, T. Komura, Computer Graphics Forum 2020, abstract (of a tree on a GPU)",
                "To build a hierarchy anew in every frame is faster than to refit it.",
                {}};
    for (const double objects : {1000.0, 10000.0})
        for (const double displacement : {0.001, 0.1, 1.0})
            s.ratios.push_back({std::string(objects < 5000 ? "1,000" : "10,000") + " boxes, by " +
                                    (displacement == 1     ? "1"
                                     : displacement == 0.1 ? "0.1"
                                                           : "0.001"),
                                "embree", "embree_refit",
                                map_with({{"objects", objects}, {"displacement", displacement}})});
    return s;
}

statement alike() {
    statement s{"B10",
                "The manual of dyn4j",
                "A sweep along one axis and a dynamic tree take about the same time: the slower of them, which is the "
                "tree, at most twice.",
                {}};
    for (const double objects : {100.0, 1000.0, 10000.0})
        s.ratios.push_back({objects < 500    ? "100 boxes"
                            : objects < 5000 ? "1,000 boxes"
                                             : "10,000 boxes",
                            dynamic_tree, one_axis, map_with({{"objects", objects}}), expectation::not_more, 1.0});
    return s;
}

statement flat_worlds() {
    return {"B11",
            "The manual of Unity, Physics, broadphase type",
            "In large flat worlds sweep and prune finds many false overlaps, and a grid over it helps.",
            {{"flat", columns, simd_sweep, kind_is("flat")},
             {"more than in a cube", columns, simd_sweep, kind_is("flat"), expectation::less, equivalence_band,
              kind_is("far")}}};
}

}  // namespace

const std::vector<statement>& statements() {
    static const std::vector<statement> all{little_motion(), all_asleep(),      subdivided(), coherent_sweep(),
                                            grid_of_sizes(), clustered_sweep(), few_boxes(),  fast_motion(),
                                            rebuilt(),       alike(),           flat_worlds()};
    return all;
}

}  // namespace aabblab
