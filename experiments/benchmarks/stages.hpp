#pragma once

import aabblab.processor;

namespace aabblab {

// The benchmarks of each stage of the broad phase. A name consists of the stage, the strategy as on the command line,
// and the case: "sort/shell:gaps=ciura/n:10000/displacement:0.1". Counters that end in "/n" are means per object, from
// a separate pass, so that counting does not slow down the timed code.

/// Sorts lists that were sorted one frame earlier; copying the list is not timed.
void add_sort_benchmarks();

/// The work of a partition per frame: it chooses axes, fits, and distributes one list, as for the sweep one_axis. A
/// column partition distributes boxes to columns instead, with the sort `bucket`.
void add_partition_benchmarks();

/// Sweeps the lists of a whole frame. Incremental sweeps, which keep their pairs, advance from frame to frame instead,
/// which includes sorting. `sweep_columns` sweeps the columns of a frame.
void add_sweep_benchmarks();

// The tests of the narrow phase, one per iteration. The pairs are those of a BVH traversal (`walked_pairs`), and each
// test includes reading the box from its tree or the triangle from its mesh. It transforms its operand of B into A's
// frame, unless "/frame:a" is appended to its name. The counter `hits` is the fraction of positive tests.

/// Tests a leaf, by its box, its triangle or the box of its triangle, against the box of a node.
void add_leaf_test_benchmarks();

/// Runs every triangle test on leaves whose boxes overlap.
void add_triangle_test_benchmarks();

/// The stages that decide pairs of triangles at poses, each alone, on meshes that cross, nearly touch (1e-9) or are
/// flush under one rotation, and on gears in mesh: filter in double on images, exact test, and six corners as integers
/// with the sides of three. The counter `decided` is the fraction that the stage decides, of `pairs` with overlapping
/// boxes. "posed/exact/flush"
void add_posed_triangle_benchmarks();

/// Distances of two meshes, and pairs of triangles within a distance, in turn with those of other libraries: the time
/// is that of a query of theirs, `ours_ms` and `ratio` (theirs to ours) are medians over the poses. `wrong` is the
/// share of their distances that are off by more than our error and 1e-12 of the size of the meshes, `worst` by how
/// much, relative to that size; `pairs` is the number of pairs, whose sets are the same. "distance/fcl/knots",
/// "within/embree/bunnies"
void add_distance_benchmarks();

/// Whether a point in the box of a closed surface lies inside, by `enclosure` and by CGAL's Side_of_triangle_mesh,
/// which must agree. The counter `inside` is the fraction of points that do. "side/cgal/query/torus_knot:…"
void add_side_benchmarks();

/// Every build of `implicit` by one thread, with the counters `two_threads`, the speedup by two threads, and
/// `two_builds`, the throughput of two builds at once: medians of five turns. "build/sah/torus_knot:…"
/// @param pinned pins this thread to one processor, except during builds
void add_build_benchmarks(const idlest_processor& pinned);

}  // namespace aabblab
