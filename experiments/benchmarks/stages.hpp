#pragma once

import aabblab.processor;

namespace aabblab {

// The benchmarks of each stage of global search. A name is the stage, the strategy as the command line takes it, and
// the case: "sort/shell:gaps=ciura/n:10000/displacement:0.1". Counters that end in "/n" are means for each object; they
// are counted in a pass of their own, since what is timed counts nothing.

/// A sort of a list that was sorted a frame ago; the copying of the list is not timed.
void add_sort_benchmarks();

/// All that a cutting partition does in a frame: it chooses axes, fits and distributes one list, which is what the
/// sweep one_axis asks for. One that cuts first puts boxes into groups or columns, with `bucket`.
void add_partition_benchmarks();

/// A sweep over the lists of a whole frame. One that keeps its pairs is brought from frame to frame instead, which
/// includes the sorting of its lists. Behind `sweep_columns`: one over the columns of a frame.
void add_sweep_benchmarks();

// The tests of local detection, one an iteration. The pairs are those that a walk tests (`walked_pairs`), which
// includes that it reads a box from its tree and a triangle from its mesh. A name is the test: "test/box". There what
// is tested of B is carried into A's frame as a part of the test; behind the same name and "/frame:a" nothing is. The
// counter `hits` is the share of pairs to which the test says yes.

/// A leaf that has just been reached against the box of a node: its box, its triangle, or the box of its triangle.
void add_leaf_test_benchmarks();

/// Every triangle test, of leaves whose boxes overlap.
void add_triangle_test_benchmarks();

/// Every build of `implicit` by one thread; the counter `two_threads` tells how many times as fast two build it, and
/// `two_builds` what two threads that build a tree each get done in the time of one: what the machine has to give. All
/// three are timed in turn, five times an iteration; counters are medians. A name is the build and the mesh:
/// "build/sah/torus_knot:…".
/// @param pinned keeps this thread on one processor, but not while it builds
void add_build_benchmarks(const idlest_processor& pinned);

}  // namespace aabblab
