#include <benchmark/benchmark.h>

#include <cstdlib>
#include <iostream>

#include "stages.hpp"

import aabb.std;
import aabblab.processor;

namespace {

constexpr int bad_input = 2;

/// Replaces the default handler, which prints the help and exits with 0 even on an invalid value.
void reject_value() {
    std::cerr << "aabblab: benchmark: the value of an option is invalid; see ./aabblab benchmark --help\n";
    std::exit(bad_input);
}

}  // namespace

/// Runs the micro-benchmarks that the command line selects, all of them by default, on the least busy processor.
int main(int argc, char** argv) {
    // The default makes all benchmarks take about 100 s; a time on the command line follows and overrides it.
    char min_time[] = "--benchmark_min_time=" AABBLAB_MIN_TIME;
    std::vector<char*> arguments(argv, argv + argc);
    arguments.insert(arguments.begin() + 1, min_time);
    arguments.push_back(nullptr);
    int count = argc + 1;
    const bool wants_help = std::any_of(argv, argv + argc, [](std::string_view a) { return a == "--help"; });
    benchmark::Initialize(&count, arguments.data(), wants_help ? benchmark::PrintDefaultHelp : reject_value);
    if (count > 1) {
        std::cerr << "aabblab: benchmark: cannot use '" << arguments[1] << "'; see ./aabblab benchmark --help\n";
        return bad_input;
    }
    const aabblab::idlest_processor pinned;
    aabblab::add_build_benchmarks(pinned);
    aabblab::add_sort_benchmarks();
    aabblab::add_partition_benchmarks();
    aabblab::add_sweep_benchmarks();
    aabblab::add_leaf_test_benchmarks();
    aabblab::add_triangle_test_benchmarks();
    aabblab::add_posed_triangle_benchmarks();
    aabblab::add_distance_benchmarks();
    aabblab::add_side_benchmarks();
    try {
        // Google Benchmark itself reports that no benchmark matches a filter.
        return benchmark::RunSpecifiedBenchmarks() == 0 ? bad_input : EXIT_SUCCESS;
    } catch (const std::logic_error& error) {  // a benchmarked function gives wrong results
        std::cerr << "aabblab: benchmark: " << error.what() << '\n';
        return EXIT_FAILURE;
    }
}
