#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "../compositions.hpp"

using namespace aabb;

namespace {

/// Unit cubes in a box that is longest along x, and shortest along z.
std::vector<box> cubes(std::size_t n) {
    std::mt19937 random(1);
    std::vector<box> boxes(n);
    const vec3f widths{60, 50, 40};
    for (box& b : boxes)
        for (int k = 0; k < 3; ++k) {
            b.min[k] = widths[k] * static_cast<float>(random() % 65536) / 65536;
            b.max[k] = b.min[k] + 1;
        }
    return boxes;
}

struct found {
    std::vector<index_pair> pairs;
    std::uint64_t tests;
    std::vector<omission> left_out;
};

found found_by(const char* sweep, const std::vector<box>& boxes) {
    const auto stage = global_of(composed({{strategy_kind::sweep, sweep}}), instrumentation::counters);
    for (std::uint32_t id = 0; id < boxes.size(); ++id) stage->insert(id);
    found f;
    stage->update(boxes);
    stage->search(f.pairs);
    std::ranges::sort(f.pairs);
    f.tests = stage->counters()[work::box_tests];
    f.left_out = stage->left_out();
    return f;
}

}  // namespace

TEST_CASE("two_axis tests boxes that can meet on two axes only") {
    const std::vector<box> boxes = cubes(5000);
    const found two = found_by("two_axis", boxes);
    const found one = found_by("one_axis", boxes);
    CHECK(two.pairs == one.pairs);
    CHECK(two.pairs.size() > 500);
    std::uint64_t on_both = 0;
    for (std::size_t a = 0; a < boxes.size(); ++a)
        for (std::size_t b = a + 1; b < boxes.size(); ++b)
            on_both += boxes[a].min[0] <= boxes[b].max[0] && boxes[b].min[0] <= boxes[a].max[0] &&
                       boxes[a].min[1] <= boxes[b].max[1] && boxes[b].min[1] <= boxes[a].max[1];
    CHECK(two.tests >= on_both);
    // Beside these, those that have ended, once each, and of the words at the ends of what it can reach.
    CHECK(two.tests < 2 * (on_both + boxes.size()));
    CHECK(8 * two.tests < one.tests);
    // The axis on which boxes vary least has no list.
    CHECK(std::ranges::count(two.left_out, "no projection list of the z axis", &omission::what) == 1);
}

TEST_CASE("a box that is long on the second axis is tested against all, and makes others test no more") {
    std::vector<box> boxes = cubes(5000);
    const std::uint64_t without = found_by("two_axis", boxes).tests;
    boxes.push_back({{20, 0, 0}, {40, 50, 40}});
    const found two = found_by("two_axis", boxes);
    CHECK(two.pairs == found_by("one_axis", boxes).pairs);
    CHECK(two.tests >= without);
    CHECK(two.tests < without + 2 * boxes.size());
}
