module aabblab.atlas;

import aabblab.fmt;
import aabblab.numbers;

namespace aabblab {

namespace {

// The labels of the compositions and engines, and what they stand for.
const std::string columns = "bucket + columns + simd";
const std::string verlet_list = "neighbour_list:margin=0.1 + bucket + columns + simd";
const std::string incremental = "insertion + incremental";
const std::string subdivided = "insertion + subdivided";
const std::string segmented = "insertion + segmented";
const std::string segmented_list = "insertion + segmented:regions=1";
const std::string one_axis = "insertion + one_axis";
const std::string x_axis = "insertion + one_axis:axis=x";
const std::string simd_sweep = "insertion + simd";
const std::string two_axis = "insertion + two_axis";
const std::string grid_on_two_axes = "std + uniform_grid:axes=2 + one_axis";
const std::string grid_on_three_axes = "std + uniform_grid + one_axis";
const std::string sorted_grid = "insertion + sorted_grid + one_axis:axis=x";
const std::string cells_on_two_axes = "radix + axial_cut:axes=2 + one_axis";
const std::string hierarchical_grid = "std + hierarchical_grid + one_axis";
const std::string grid_of_one_level = "std + hierarchical_grid:levels=1 + one_axis";
const std::string dynamic_tree = "bullet_dbvt";
const std::string bullet_sap = "bullet_sap";

// Sources of several statements.
const std::string tracy =
    "Tracy, Buss and Woods 2009, Efficient Large-Scale Sweep and Prune Methods with AABB Insertion and Removal, IEEE "
    "Virtual Reality, abstract";
const std::string nordby = "Nordby 2011, BEPUphysics, v0.16.0 Broad Phase Benchmarks";
const std::string link_to_nordby = "https://www.bepuentertainment.com/blog/2011/6/5/v0160-broad-phase-benchmarks.html";
const std::string broadmark = "Serpa and Rodrigues 2020, Broadmark, README";
const std::string link_to_broadmark = "https://ppgia-unifor.github.io/Broadmark/";

/// Matches the scenes of the map with these values of parameters. All boxes move, unless a value says otherwise.
scene_filter map_with(std::map<std::string_view, double> values) {
    values.try_emplace("moving", 1);
    return [values = std::move(values)](const atlas_scene& s) {
        return s.scene.kind == "cloud" &&
               std::ranges::all_of(values, [&](const auto& v) { return s.number(v.first) == v.second; });
    };
}

/// Matches the scenes of the map in which all boxes move by this displacement per frame.
scene_filter moved(double objects, double displacement) {
    return map_with({{"objects", objects}, {"displacement", displacement}});
}

scene_filter boxes(double objects) {
    return map_with({{"objects", objects}});
}

scene_filter sizes_to(double ratio, double objects) {
    return map_with({{"objects", objects}, {"ratio", ratio}});
}

scene_filter clouds(double count, double objects) {
    return map_with({{"objects", objects}, {"clouds", count}});
}

scene_filter density(double value, double objects) {
    return map_with({{"objects", objects}, {"density", value}});
}

/// Matches the scenes of the map in which only a share of the boxes moves.
scene_filter partly_moving(double objects, double moving) {
    return map_with({{"objects", objects}, {"moving", moving}});
}

scene_filter kind_is(std::string kind) {
    return [kind = std::move(kind)](const atlas_scene& s) { return s.scene.kind == kind; };
}

/// The ratio of a candidate to a baseline for each pair of number of boxes and displacement.
std::vector<statement_ratio> by_motion(const std::string& candidate, const std::string& baseline,
                                       std::initializer_list<std::pair<double, double>> cases) {
    std::vector<statement_ratio> ratios;
    for (const auto& [objects, displacement] : cases)
        ratios.push_back({fmt::format("{} boxes, by {:g}", grouped(static_cast<std::uint64_t>(objects)), displacement),
                          candidate, baseline, moved(objects, displacement)});
    return ratios;
}

/// The ratio of a candidate to a baseline for each number of boxes.
std::vector<statement_ratio> by_count(const std::string& candidate, const std::string& baseline,
                                      std::initializer_list<double> sizes, expectation expected = expectation::less,
                                      double band = equivalence_band) {
    std::vector<statement_ratio> ratios;
    for (const double objects : sizes)
        ratios.push_back({grouped(static_cast<std::uint64_t>(objects)) + " boxes", candidate, baseline, boxes(objects),
                          /*reference_scenes=*/nullptr, expected, band});
    return ratios;
}

}  // namespace

/// A ratio is that of the candidate expected to be faster over another, in the scenes of a filter. With two filters,
/// the ratio in the first scenes is divided by that in the second.
const std::vector<statement>& statements() {
    static const std::vector<statement> published{
        {{"B1", "Bullet's wiki, Broadphase", "http://bulletphysics.org/mediawiki-1.5.8/index.php/Broadphase",
          "best performance [...] where most objects have little or no motion",
          "Sweep and prune is faster if most objects rest, the dynamic tree if many move.",
          "Bullet's sweep; its tree, but searched as a whole in each frame, not only for boxes that moved",
          /*is_proxy=*/true},
         {{"10,000 boxes, a hundredth move", bullet_sap, dynamic_tree, partly_moving(10000, 0.01)},
          {"10,000 boxes, a tenth moves", bullet_sap, dynamic_tree, partly_moving(10000, 0.1)},
          {"1,000 boxes, all move by 1", dynamic_tree, bullet_sap, moved(1000, 1)},
          {"10,000 boxes, all move by 1", dynamic_tree, bullet_sap, moved(10000, 1)}}},
        {{"B2", "Terdiman 2018, PhysX-3.4, issue 96", "https://github.com/NVIDIAGameWorks/PhysX-3.4/issues/96",
          "nothing will beat SAP [all sleep]; [MBP] will be much faster [...] when all objects are moving",
          "If everything rests, nothing beats incremental sweep and prune; if everything moves, box pruning in regions "
          "is much faster.",
          "incremental for SAP, which is not told what rests; cells on two axes, swept anew, for MBP",
          /*is_proxy=*/true},
         {{"1,000 boxes at rest", incremental, cells_on_two_axes, partly_moving(1000, 0)},
          {"10,000 boxes at rest", incremental, cells_on_two_axes, partly_moving(10000, 0)},
          {"10,000 boxes at rest", incremental, columns, partly_moving(10000, 0)},
          {"10,000 boxes at rest", incremental, verlet_list, partly_moving(10000, 0)},
          {"1,000 boxes, all move by 1", cells_on_two_axes, incremental, moved(1000, 1)},
          {"10,000 boxes, all move by 1", cells_on_two_axes, incremental, moved(10000, 1)}}},
        {{"B3", tracy, "", "these techniques provide higher performance than previous sweep and prune methods",
          "Subdivision and segmented interval lists make sweep and prune faster.",
          "segmented, after the authors' program; incremental for the methods before", /*is_proxy=*/false},
         by_motion(segmented, incremental,
                   {{1000, 0.001}, {10000, 0.001}, {1000, 0.1}, {10000, 0.1}, {1000, 1}, {10000, 1}})},
        {{"B4", tracy, "", "perform better than octrees in temporally coherent environments",
          "With coherence, segmented sweep and prune beats octrees.",
          "segmented as in B3; Bullet's dynamic tree and Embree's refitted one for octrees", /*is_proxy=*/true},
         {{"1,000 boxes, by 0.01", segmented, dynamic_tree, moved(1000, 0.01)},
          {"10,000 boxes, by 0.01", segmented, dynamic_tree, moved(10000, 0.01)},
          {"10,000 boxes, by 0.01", segmented, "embree_refit", moved(10000, 0.01)},
          {"10,000 boxes, a hundredth moves", segmented, dynamic_tree, partly_moving(10000, 0.01)}}},
        {{"B5", "Ericson 2005, Real-Time Collision Detection (Morgan Kaufmann), 7.1.1", "",
          "cells can be too large for the smaller objects while too small for the largest objects",
          "A uniform grid suits boxes of similar size but not of very different sizes, which a hierarchy of grids "
          "suits.",
          "hierarchical_grid, the book's, with as many levels as it chooses and with one", /*is_proxy=*/false},
         {{"10,000 boxes of one size", grid_of_one_level, hierarchical_grid, sizes_to(1, 10000),
           /*reference_scenes=*/nullptr, expectation::not_more},
          {"10,000 boxes, sizes 1 to 100", hierarchical_grid, grid_of_one_level, sizes_to(100, 10000)},
          {"the lead of the hierarchy, sizes 1 to 100 over one size", hierarchical_grid, grid_of_one_level,
           sizes_to(100, 10000), sizes_to(1, 10000)}}},
        {{"B6", nordby, link_to_nordby,
          "The grid helps prevent the clustering problem associated with fixed one-axis approaches",
          "A sweep along a fixed axis suffers from clustered boxes; a grid on the other two axes does not.",
          "SortAndSweep1D (one_axis:axis=x) and Grid2DSortAndSweep (sorted_grid), as described", /*is_proxy=*/false},
         {{"1,000 boxes, 20 clouds over one", sorted_grid, x_axis, clouds(20, 1000), clouds(1, 1000)},
          {"10,000 boxes, 20 clouds over one", sorted_grid, x_axis, clouds(20, 10000), clouds(1, 10000)}}},
        {{"B7", nordby, link_to_nordby, "SAS1D starts out great (in fact, the fastest at 100 objects)",
          "A sweep along one axis is the fastest with 100 boxes; with many, a grid on two axes with a sweep along the "
          "third beats a dynamic hierarchy.",
          "the sweep and the grid as described; Bullet's tree for the hierarchy; one thread",
          /*is_proxy=*/true},
         {{"100 boxes", x_axis, dynamic_tree, boxes(100)},
          {"100 boxes", x_axis, sorted_grid, boxes(100)},
          {"10,000 boxes", sorted_grid, dynamic_tree, boxes(10000)},
          {"30,000 boxes", sorted_grid, dynamic_tree, boxes(30000)}}},
        {{"B8", "Deltodesco 2012, Nape, nape.space.Broadphase",
          "https://joecreates.github.io/napephys/docs/types/nape/space/Broadphase.html",
          "[slower if] lots of objects are moving very quickly or [...] a large variety in the size",
          "A sweep along x is slower at fast motion and with many sizes; a dynamic tree suffers from neither.",
          "Nape's sweep (SweepPhase: insertion sort along x), in space; Bullet's tree for Nape's", /*is_proxy=*/true},
         {{"1,000 boxes, by 1 over by 0.001", dynamic_tree, x_axis, moved(1000, 1), moved(1000, 0.001)},
          {"10,000 boxes, by 1 over by 0.001", dynamic_tree, x_axis, moved(10000, 1), moved(10000, 0.001)},
          {"10,000 boxes, sizes 1 to 100 over one size", dynamic_tree, x_axis, sizes_to(100, 10000),
           sizes_to(1, 10000)}}},
        {{"B9",
          "Chitalu, Dubach and Komura 2020, Binary Ostensibly-Implicit Trees for Fast Collision Detection, Computer "
          "Graphics Forum 39(2), abstract",
          "https://doi.org/10.1111/cgf.13948", "it is actually faster than refitting and more memory efficient",
          "Rebuilding a hierarchy in every frame is faster than refitting it.",
          "Embree's trees on a processor for the source's on a graphics card", /*is_proxy=*/true},
         by_motion("embree", "embree_refit",
                   {{1000, 0.001}, {1000, 0.1}, {1000, 1}, {10000, 0.001}, {10000, 0.1}, {10000, 1}})},
        {{"B10", "Bittle 2016, dyn4j 3.3, package collision.broadphase",
          "http://docs.dyn4j.org/v3.3.0/org/dyn4j/collision/broadphase/package-summary.html",
          "Generally, they have similar performance.",
          "A sweep along x and a dynamic tree take about the same time: the tree at most twice as long.",
          "insertion sort for dyn4j's red-black tree of lower ends; Bullet's tree for dyn4j's; in space",
          /*is_proxy=*/true},
         by_count(dynamic_tree, x_axis, {100, 1000, 10000}, expectation::not_more, /*band=*/1.0)},
        {{"B11", "Unity 6, manual, Select a broad phase pruning algorithm",
          "https://docs.unity3d.com/6000.6/Documentation/Manual/physics-optimization-cpu-broad-phase.html",
          "SAP can generate false positives in large, flat worlds with many colliders",
          "In flat worlds sweep and prune on three axes is slow, and a grid whose cells are swept helps.",
          "Bullet's sweep on three axes for PhysX's; cells on two axes, swept anew, for its MBP", /*is_proxy=*/true},
         {{"flat", cells_on_two_axes, bullet_sap, kind_is("flat")},
          {"flat over cubic", cells_on_two_axes, bullet_sap, kind_is("flat"), /*in a cube*/ kind_is("brownian")}}},
        {{"B13", broadmark, link_to_broadmark,
          "Best variants are BF SIMD Parallel, SAP SIMD Parallel and Grid 3D SAP Parallel.",
          "The best sweep is the vectorised one.", "our sweeps with and without vectors, on one thread",
          /*is_proxy=*/true},
         by_count(simd_sweep, one_axis, {100, 1000, 10000})},
        {{"B14", "Capannini and Larsson 2016, EGPGV, abstract", "",
          "gracefully handles high-density scenarios, including challenging clustering behavior",
          "A sweep of two axes copes with density and clusters: its lead over one axis grows with both.",
          "two_axis, on one thread, with a bitmap for the source's succinct tree", /*is_proxy=*/true},
         {{"10,000 boxes, density 1 over 0.01", two_axis, one_axis, density(1, 10000), density(0.01, 10000)},
          {"10,000 boxes, 20 clouds over one", two_axis, one_axis, clouds(20, 10000), clouds(1, 10000)}}},
        {{"B15", "Capannini and Larsson 2016, Output Sensitive Collision Detection for Unisize Boxes, SIGRAD, abstract",
          "", "can gain improved performance for the special class [...] of the same size",
          "A sweep of two axes gains if all boxes have one size.",
          "two_axis, without the source's changes for boxes of one size", /*is_proxy=*/true},
         {{"1,000 boxes, one size over sizes 1 to 100", two_axis, one_axis, sizes_to(1, 1000), sizes_to(100, 1000)},
          {"10,000 boxes, one size over sizes 1 to 100", two_axis, one_axis, sizes_to(1, 10000),
           sizes_to(100, 10000)}}},
        {{"B16", tracy, "", "well-suited to large environments in which many objects are not moving at once",
          "Segmented interval lists suit large environments in which few objects move at a time.",
          "segmented on one list, \"this algorithm\" of the abstract", /*is_proxy=*/false},
         {{"10,000 boxes, a hundredth moves", segmented_list, incremental, partly_moving(10000, 0.01)},
          {"10,000 boxes, a tenth moves", segmented_list, incremental, partly_moving(10000, 0.1)},
          {"10,000 boxes, a hundredth moves", segmented_list, one_axis, partly_moving(10000, 0.01)},
          {"its lead, 10,000 boxes over 1,000, a tenth moves", segmented_list, incremental, partly_moving(10000, 0.1),
           partly_moving(1000, 0.1)}}},
        {{"B17", broadmark, link_to_broadmark,
          "Best variants are BF SIMD Parallel, SAP SIMD Parallel and Grid 3D SAP Parallel.",
          "Among grids with a sweep in their cells, one on three axes is better than one on two.",
          "uniform_grid on three and on two axes, with smaller cells and on one thread", /*is_proxy=*/true},
         by_count(grid_on_three_axes, grid_on_two_axes, {1000, 10000, 30000})},
        {{"B18", "Catto 2007, Box2D, b2BroadPhase.cpp", "",
          "it is not great for huge worlds (use a multi-SAP instead), it is not great for large objects",
          "Incremental sweep and prune suffers in a huge world, where one per region is better, and from large boxes.",
          "three axes for Box2D's two; subdivided for multi-SAP; Bullet's tree as what does not suffer",
          /*is_proxy=*/true},
         {{"10,000 boxes, density 0.01", subdivided, incremental, density(0.01, 10000)},
          {"10,000 boxes, density 0.01 over 1", subdivided, incremental, density(0.01, 10000), density(1, 10000)},
          {"10,000 boxes, sizes 1 to 100 over one size", dynamic_tree, incremental, sizes_to(100, 10000),
           sizes_to(1, 10000)}}}};
    return published;
}

/// The labels of all candidates that the statements compare, each once: a test checks that the atlas times them.
std::vector<std::string> labels_in_statements() {
    std::vector<std::string> labels;
    for (const statement& s : statements())
        for (const statement_ratio& r : s.ratios)
            for (const std::string& label : {r.candidate, r.baseline})
                if (std::ranges::find(labels, label) == labels.end()) labels.push_back(label);
    return labels;
}

}  // namespace aabblab
