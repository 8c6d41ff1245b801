#include <benchmark/benchmark.h>

#include "stages.hpp"

import aabb.local_detection;
import aabb.std;
import aabb.strategies;
import aabb.tree.implicit;
import aabblab.cases;
import aabblab.processor;
import aabblab.scenes;
import aabblab.statistics;
import aabblab.stopwatch;

namespace aabblab {

namespace {

/// The sizes are those of the meshes in `experiments/configs/peers/builds.toml`.
constexpr std::array<std::string_view, 2> built_meshes = {"noise_sphere:triangles=75000",
                                                          "torus_knot:triangles=870000"};

constexpr int turns = 5;

/// Times the build of a tree by one thread, by two, and two builds at once, in turn. `two_threads` is the speedup of a
/// build by two threads, `two_builds` that of two independent builds, the most that this machine allows.
template <class Build>
void time_build(benchmark::State& state, const aabb::mesh& m) {
    Build sequential;
    Build parallel;
    parallel.threads = 2;
    const auto build = [&](const Build& strategy) {
        const aabb::model<aabb::implicit_tree> built(m, aabb::as_tree_builder(strategy));
        benchmark::DoNotOptimize(&built);
    };
    const auto ms_of = [](const auto& work) {
        const wall_stopwatch watch;
        work();
        return watch.ms();
    };
    // Warm-up: starts the threads. TBB determines the available processors on its first use.
    build(parallel);
    std::vector<double> two_threads, two_builds;
    for (auto _ : state) {
        double total = 0;
        for (int turn = 0; turn < turns; ++turn) {
            // The build by two threads comes last, as its threads linger.
            const double one_thread = ms_of([&] { build(sequential); });
            two_builds.push_back(2 * one_thread / ms_of([&] {
                                     const std::jthread other([&] { build(sequential); });
                                     build(sequential);
                                 }));
            two_threads.push_back(one_thread / ms_of([&] { build(parallel); }));
            total += one_thread;
        }
        state.SetIterationTime(total / turns / 1000);
    }
    state.counters["two_threads"] = quartiles_of(two_threads).median;
    state.counters["two_builds"] = quartiles_of(two_builds).median;
}

}  // namespace

/// Adds a benchmark per build and mesh. The thread is not pinned while it builds, as new threads would inherit that.
void add_build_benchmarks(const idlest_processor& pinned) {
    for_each_strategy(aabb::builds{}, [&]<class Build>(aabb::type_list<Build>) {
        for (const std::string_view mesh : built_meshes)
            benchmark::RegisterBenchmark(("build/" + std::string(Build::name) + "/" + std::string(mesh)).c_str(),
                                         [&pinned, mesh](benchmark::State& state) {
                                             const aabb::mesh m = make_mesh(mesh).mesh;
                                             pinned.without([&] { time_build<Build>(state, m); });
                                         })
                ->UseManualTime()
                ->Unit(benchmark::kMillisecond);
    });
}

}  // namespace aabblab
