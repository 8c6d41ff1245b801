module;
#include <fmt/format.h>

module aabblab.atlas;

import :statement;
import aabblab.numbers;

namespace aabblab {

namespace {

// Who plays, as it is labelled.
const std::string columns = "bucket + columns + simd";
const std::string kept_list = "neighbour_list:margin=0.1 + bucket + columns + simd";
const std::string incremental = "insertion + incremental";
const std::string in_regions = "insertion + subdivided";
const std::string one_axis = "insertion + one_axis";
const std::string simd_sweep = "insertion + simd";
const std::string two_axis = "insertion + two_axis";
const std::string grid = "std + uniform_grid + simd";
const std::string kd_tree = "radix + kd_tree + simd";
const std::string grids = "ode_hash";
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

/// All move by so much a frame.
scene_filter moved(double objects, double displacement) {
    return map_with({{"objects", objects}, {"displacement", displacement}});
}
std::string where_moved(double objects, double displacement) {
    return fmt::format("{} boxes, by {:g}", grouped(static_cast<std::uint64_t>(objects)), displacement);
}

/// How many times more it is here than there.
stated_ratio compared(std::string where, std::string arm, std::string base, scene_filter here, scene_filter there) {
    stated_ratio one{std::move(where), std::move(arm), std::move(base), std::move(here)};
    one.over = std::move(there);
    return one;
}

scene_filter resting(double objects, double moving) {
    return map_with({{"objects", objects}, {"moving", moving}}, false);
}

scene_filter kind_is(std::string kind) {
    return [kind = std::move(kind)](const atlas_scene& s) { return s.scene.kind == kind; };
}

statement little_motion() {
    return {"B1",
            "Bullet's manual and wiki, \"Broadphase\"",
            "Sweep and prune is fastest where most objects rest; the dynamic tree where many move.",
            {{"10,000 boxes, a hundredth move", bullet_sap, dynamic_tree, resting(10000, 0.01)},
             {"10,000 boxes, a tenth moves", bullet_sap, dynamic_tree, resting(10000, 0.1)},
             {"1,000 boxes, all move by 1", dynamic_tree, bullet_sap, moved(1000, 1)},
             {"10,000 boxes, all move by 1", dynamic_tree, bullet_sap, moved(10000, 1)}}};
}

statement all_asleep() {
    return {"B2",
            "P. Terdiman, PhysX issue 96, and PhysX's manual, PxBroadPhaseType",
            "With everything asleep nothing beats incremental sweep and prune; with everything moving pruning in "
            "boxes is much faster.",
            {{"1,000 boxes at rest", incremental, columns, resting(1000, 0)},
             {"10,000 boxes at rest", incremental, columns, resting(10000, 0)},
             {"10,000 boxes at rest", incremental, kept_list, resting(10000, 0)},
             {"1,000 boxes, all move by 1", columns, incremental, moved(1000, 1)},
             {"10,000 boxes, all move by 1", columns, incremental, moved(10000, 1)}}};
}

statement subdivided() {
    statement s{"B3",
                "D. Tracy, S. Buss, B. Woods, IEEE VR 2009, abstract",
                "Sweep and prune that is subdivided is faster than sweep and prune before it.",
                {}};
    for (const double displacement : {0.001, 0.1, 1.0})
        for (const double objects : {1000.0, 10000.0})
            s.ratios.push_back(
                {where_moved(objects, displacement), in_regions, incremental, moved(objects, displacement)});
    return s;
}

statement coherent_sweep() {
    return {"B4",
            "D. Tracy, S. Buss, B. Woods, IEEE VR 2009, abstract (of octrees)",
            "With coherence, subdivided sweep and prune beats hierarchies.",
            {{"1,000 boxes, by 0.01", in_regions, dynamic_tree, moved(1000, 0.01)},
             {"10,000 boxes, by 0.01", in_regions, dynamic_tree, moved(10000, 0.01)},
             {"10,000 boxes, by 0.01", in_regions, "embree_refit", moved(10000, 0.01)},
             {"10,000 boxes, a hundredth moves", in_regions, dynamic_tree, resting(10000, 0.01)}}};
}

statement few_at_a_time() {
    return {"B16",
            "D. Tracy, S. Buss, B. Woods, IEEE VR 2009, abstract",
            "Subdivided sweep and prune suits large environments in which few objects move at a time.",
            {{"10,000 boxes, a hundredth moves", in_regions, incremental, resting(10000, 0.01)},
             {"10,000 boxes, a tenth moves", in_regions, incremental, resting(10000, 0.1)},
             {"10,000 boxes, a hundredth moves", in_regions, one_axis, resting(10000, 0.01)},
             compared("its lead, 10,000 boxes over 1,000, a tenth moves", in_regions, incremental, resting(10000, 0.1),
                      resting(1000, 0.1))}};
}

statement grid_of_sizes() {
    return {
        "B5",
        "C. Ericson, Real-Time Collision Detection, 7.1 and 7.2",
        "A uniform grid suits boxes of similar size; where sizes vary greatly it does not, and a hierarchy of grids "
        "does.",
        {{"10,000 boxes of one size", grid, grids, map_with({{"objects", 10000}, {"ratio", 1}})},
         {"10,000 boxes, sizes 1 to 100", grids, grid, map_with({{"objects", 10000}, {"ratio", 100}})},
         compared("the lead of the hierarchy, sizes 1 to 100 over one size", grids, grid,
                  map_with({{"objects", 10000}, {"ratio", 100}}), map_with({{"objects", 10000}, {"ratio", 1}}))}};
}

statement clustered_sweep() {
    return {"B6",
            "C. Ericson, Real-Time Collision Detection, 7.5; the manual of BEPUphysics",
            "Sweep and prune suffers where boxes are clustered, which a hierarchy does not.",
            {compared("1,000 boxes, 20 clouds over one", dynamic_tree, one_axis,
                      map_with({{"objects", 1000}, {"clouds", 20}}), map_with({{"objects", 1000}, {"clouds", 1}})),
             compared("10,000 boxes, 20 clouds over one", dynamic_tree, one_axis,
                      map_with({{"objects", 10000}, {"clouds", 20}}), map_with({{"objects", 10000}, {"clouds", 1}}))}};
}

statement few_boxes() {
    return {"B7",
            "Benchmark of BEPUphysics 0.16, 2011",
            "A sweep along one axis is the fastest of all with 100 boxes; with many, a grid of two axes with a sweep "
            "along the third beats a dynamic hierarchy.",
            {{"100 boxes", simd_sweep, dynamic_tree, map_with({{"objects", 100}})},
             {"100 boxes", simd_sweep, columns, map_with({{"objects", 100}})},
             {"10,000 boxes", columns, dynamic_tree, map_with({{"objects", 10000}})},
             {"30,000 boxes", columns, dynamic_tree, map_with({{"objects", 30000}})}}};
}

statement fast_motion() {
    return {
        "B8",
        "The manual of Nape; comments of Box2D 2.0, b2BroadPhase",
        "Sweep and prune is poor at fast motion and at many sizes; a dynamic tree suffers from neither.",
        {compared("1,000 boxes, by 1 over by 0.001", dynamic_tree, incremental, moved(1000, 1), moved(1000, 0.001)),
         compared("10,000 boxes, by 1 over by 0.001", dynamic_tree, incremental, moved(10000, 1), moved(10000, 0.001)),
         compared("10,000 boxes, sizes 1 to 100 over one size", dynamic_tree, incremental,
                  map_with({{"objects", 10000}, {"ratio", 100}}), map_with({{"objects", 10000}, {"ratio", 1}}))}};
}

statement rebuilt() {
    statement s{"B9",
                "F. Chitalu, C. Dubach, T. Komura, Computer Graphics Forum 2020, abstract (of a tree on a GPU)",
                "To build a hierarchy anew in every frame is faster than to refit it.",
                {}};
    for (const double objects : {1000.0, 10000.0})
        for (const double displacement : {0.001, 0.1, 1.0})
            s.ratios.push_back(
                {where_moved(objects, displacement), "embree", "embree_refit", moved(objects, displacement)});
    return s;
}

statement alike() {
    statement s{"B10",
                "The manual of dyn4j",
                "A sweep along one axis and a dynamic tree take about the same time: the slower of them, which is the "
                "tree, at most twice.",
                {}};
    for (const double objects : {100.0, 1000.0, 10000.0})
        s.ratios.push_back({grouped(static_cast<std::uint64_t>(objects)) + " boxes", dynamic_tree, one_axis,
                            map_with({{"objects", objects}}), expectation::not_more, 1.0});
    return s;
}

statement flat_worlds() {
    return {"B11",
            "The manual of Unity, Physics, broadphase type",
            "In large flat worlds sweep and prune finds many false overlaps, and a grid over it helps.",
            {{"flat", columns, simd_sweep, kind_is("flat")},
             compared("more than in a cube", columns, simd_sweep, kind_is("flat"), kind_is("brownian"))}};
}

statement kd_trees() {
    return {"B12",
            "Y. Serpa, M. Rodrigues, Computer Graphics Forum 38, 2019, title",
            "A kd-tree that makes use of where boxes were before is fast and scales.",
            {{"10,000 boxes", kd_tree, simd_sweep, map_with({{"objects", 10000}})},
             {"10,000 boxes", kd_tree, grid, map_with({{"objects", 10000}})},
             {"10,000 boxes", kd_tree, dynamic_tree, map_with({{"objects", 10000}})},
             compared("its lead over a sweep, 10,000 boxes over 1,000", kd_tree, simd_sweep,
                      map_with({{"objects", 10000}}), map_with({{"objects", 1000}}))}};
}

statement best_variants() {
    statement s{"B13",
                "README of Broadmark (Y. Serpa, M. Rodrigues), \"Best variants\" (which are parallel, too)",
                "Of sweeps the one that tests by vectors is the best.",
                {}};
    for (const double objects : {100.0, 1000.0, 10000.0})
        s.ratios.push_back({grouped(static_cast<std::uint64_t>(objects)) + " boxes", simd_sweep, one_axis,
                            map_with({{"objects", objects}})});
    return s;
}

statement grids_of_three_axes() {
    statement s{"B17",
                "README of Broadmark (Y. Serpa, M. Rodrigues), \"Best variants\" (which are parallel, too)",
                "Of grids with a sweep in their cells the one over three axes is better than the one over two.",
                {}};
    for (const double objects : {1000.0, 10000.0, 30000.0})
        s.ratios.push_back(
            {grouped(static_cast<std::uint64_t>(objects)) + " boxes", grid, columns, map_with({{"objects", objects}})});
    return s;
}

statement two_axes() {
    return {"B14",
            "G. Capannini, T. Larsson, SCCG 2016 and IEEE TVCG 2018, titles (the latter on several threads)",
            "A sweep of two axes is efficient, and for massive scenes.",
            {{"1,000 boxes", two_axis, one_axis, map_with({{"objects", 1000}})},
             {"30,000 boxes", two_axis, one_axis, map_with({{"objects", 30000}})},
             compared("30,000 boxes over 1,000", two_axis, one_axis, map_with({{"objects", 30000}}),
                      map_with({{"objects", 1000}}))}};
}

statement one_size() {
    statement s{"B15",
                "G. Capannini, T. Larsson, SIGRAD 2016, abstract (of a form for boxes of one size alone)",
                "A sweep of two axes gains where all boxes have one size.",
                {}};
    for (const double objects : {1000.0, 10000.0})
        s.ratios.push_back(compared(
            grouped(static_cast<std::uint64_t>(objects)) + " boxes, one size over sizes 1 to 100", two_axis, one_axis,
            map_with({{"objects", objects}, {"ratio", 1}}), map_with({{"objects", objects}, {"ratio", 100}})));
    return s;
}

}  // namespace

const std::vector<statement>& statements() {
    static const std::vector<statement> all{
        little_motion(), all_asleep(),  subdivided(), coherent_sweep(), grid_of_sizes(),      clustered_sweep(),
        few_boxes(),     fast_motion(), rebuilt(),    alike(),          flat_worlds(),        kd_trees(),
        best_variants(), two_axes(),    one_size(),   few_at_a_time(),  grids_of_three_axes()};
    return all;
}

}  // namespace aabblab
