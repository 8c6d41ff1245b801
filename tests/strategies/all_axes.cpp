#include <algorithm>
#include <catch2/catch_test_macros.hpp>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "../compositions.hpp"

using namespace aabb;

namespace {

std::vector<box> any_boxes(std::size_t n) {
    std::mt19937 random(1);
    std::vector<box> boxes(n);
    for (box& b : boxes)
        for (int k = 0; k < 3; ++k) {
            // On a lattice, so that many tie.
            b.min[k] = static_cast<float>(random() % 400);
            b.max[k] = b.min[k] + static_cast<float>(random() % 8);
        }
    return boxes;
}

/// How many pairs overlap on an axis.
std::uint64_t pairs_on(std::vector<box> boxes, int axis) {
    std::ranges::sort(boxes, {}, [&](const box& b) { return b.min[axis]; });
    std::uint64_t pairs = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        const auto past = std::ranges::upper_bound(boxes.begin() + static_cast<std::ptrdiff_t>(i), boxes.end(),
                                                   boxes[i].max[axis], {}, [&](const box& b) { return b.min[axis]; });
        pairs += static_cast<std::uint64_t>(past - boxes.begin()) - i - 1;
    }
    return pairs;
}

std::vector<index_pair> pairs_found(global_stage& stage, const std::vector<box>& boxes) {
    for (std::uint32_t id = 0; id < boxes.size(); ++id) stage.insert(id);
    std::vector<index_pair> pairs;
    stage.update(boxes);
    stage.search(pairs);
    std::ranges::sort(pairs);
    return pairs;
}

}  // namespace

TEST_CASE("all_axes visits each pair of an axis once, however many blocks the pairs take") {
    // The bits of the pairs of 13,000 take more than the 16 MiB of one block.
    for (const std::size_t n : {3000UL, 13'000UL}) {
        CAPTURE(n);
        const std::vector<box> boxes = any_boxes(n);
        const auto all_axes = global_of(composed({{strategy_kind::sweep, "all_axes"}}), instrumentation::counters);
        const auto one_axis = global_of(composed({{strategy_kind::sweep, "one_axis"}}));
        const std::vector<index_pair> pairs = pairs_found(*all_axes, boxes);
        CHECK(pairs.size() > 10);
        CHECK(pairs == pairs_found(*one_axis, boxes));
        // The first list is not walked: where each box's overlaps end in it is known.
        CHECK(all_axes->counters()[work::box_tests] == pairs_on(boxes, 1) + pairs_on(boxes, 2));
    }
}
