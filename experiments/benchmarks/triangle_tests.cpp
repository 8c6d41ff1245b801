#include <benchmark/benchmark.h>

#include "stages.hpp"
#include "time_tests.hpp"

import aabb.policy;
import aabb.std;
import aabb.strategies;
import aabblab.cases;
import aabblab.walked_pairs;

namespace aabblab {

namespace {

/// The triangle of B is carried into A's frame for the first of the triangles of A that it meets …
template <class Triangle>
struct carried_test {
    Triangle triangle;
    const walked_pairs& at;

    [[nodiscard, gnu::always_inline]] bool operator()(const met_triangles& p) const {
        return triangle.intersects(at.a().triangles().triangle(p.a), at.to_a()(at.b().triangles().triangle(p.b)));
    }
};

/// … and kept for those that follow.
template <class Triangle>
struct kept_test {
    Triangle triangle;
    const walked_pairs& at;

    [[nodiscard, gnu::always_inline]] bool operator()(const met_triangles& p) const {
        return triangle.intersects(at.a().triangles().triangle(p.a), p.b_image);
    }
};

template <class Test>
void add(const std::string& name, const aabb::strategy_choice& choice) {
    benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
        static const std::vector<met_triangles> pairs = in_random_order(walked().triangles());
        time_tests(state, pairs, Test{made<decltype(Test::triangle)>(choice), walked()});
    });
}

}  // namespace

void add_triangle_test_benchmarks() {
    for_each_strategy(aabb::triangles{}, []<class Triangle>(aabb::type_list<Triangle>) {
        for (const aabb::strategy_choice& choice : choices_of<Triangle>()) {
            const std::string name = "test/triangle/" + to_text(choice);
            add<carried_test<Triangle>>(name, choice);
            add<kept_test<Triangle>>(name + "/frame:a", choice);
        }
    });
}

}  // namespace aabblab
