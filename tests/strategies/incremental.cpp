#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "../compositions.hpp"
#include "counted_search.hpp"
#include "overlapping.hpp"

using namespace aabb;

namespace {

const composition incremental = composed({{strategy_kind::sort, "insertion"}, {strategy_kind::sweep, "incremental"}});

std::vector<box> scattered(std::uint32_t n) {
    std::vector<box> boxes;
    for (std::uint32_t i = 0; i < n; ++i) {
        const vec3f at{static_cast<float>(i * 37 % 101), static_cast<float>(i * 53 % 97),
                       static_cast<float>(i * 29 % 89)};
        boxes.push_back({at, at + vec3f{20, 20, 20}});
    }
    return boxes;
}

}  // namespace

TEST_CASE("a frame in which nothing moved costs incremental no test of a pair and no comparison") {
    const std::vector<box> boxes = scattered(500);
    counted_search search(incremental, 500);
    const work_of_frame first = search.play(boxes);
    CHECK(first.box_tests > 0);
    CHECK(first.pairs > 100);
    const work_of_frame second = search.play(boxes);
    CHECK(second.box_tests == 0);
    CHECK(second.comparisons == 0);
    CHECK(second.moves == 0);
    CHECK(second.pairs == first.pairs);
}

TEST_CASE("a move that passes no end costs incremental no test of a pair") {
    std::vector<box> boxes = scattered(500);
    counted_search search(incremental, 500);
    const work_of_frame before = search.play(boxes);
    for (box& b : boxes)
        for (int k = 0; k < 3; ++k) {
            b.min[k] += 0.5F;
            b.max[k] += 0.5F;
        }
    const work_of_frame together = search.play(boxes);
    CHECK(together.box_tests == 0);
    CHECK(together.comparisons > 0);
    CHECK(together.restarts == 0);
    CHECK(together.pairs == before.pairs);
}

TEST_CASE("incremental follows no more swaps in a frame than starting anew takes steps") {
    constexpr std::uint32_t n = 2000;
    counted_search search(incremental, n);
    std::mt19937 random(1);
    const auto play = [&](auto far) {
        std::vector<box> boxes(n);
        for (box& b : boxes)
            for (int k = 0; k < 3; ++k) {
                b.min[k] = far();
                b.max[k] = b.min[k] + 1;
            }
        return search.play(boxes);
    };
    const auto anywhere = [&] { return static_cast<float>(random() % 100'000) / 1000; };
    const work_of_frame first = play(anywhere);
    CHECK(first.restarts == 0);
    for (int frame = 0; frame < 3; ++frame) {
        const work_of_frame teleported = play(anywhere);
        CHECK(teleported.restarts == 1);
        CHECK(teleported.swaps < 2 * (first.box_tests + 3 * 2 * n * 12));
        // Followed to the end there would be four million swaps an axis.
        CHECK(teleported.box_tests < 4 * first.box_tests);
    }
    // After a frame in which all overlap, as many steps are not allowed for ever.
    CHECK(play([] { return 0.0F; }).pairs == n * (n - 1) / 2);
    play(anywhere);
    play(anywhere);
    CHECK(play(anywhere).swaps < 4 * (first.box_tests + 3 * 2 * n * 12));
}

TEST_CASE("incremental started anew finds the pairs, whoever comes, goes or begins an axis in that frame") {
    std::mt19937 random(1);
    const auto below = [&](std::uint32_t end) { return static_cast<std::uint32_t>(random() % end); };
    std::uint64_t restarts = 0;
    for (int scene = 0; scene < 40; ++scene) {
        constexpr std::uint32_t n = 100;
        counted_search search(incremental, n);
        std::vector<bool> present(n, true);
        std::vector<box> boxes(n);
        for (int frame = 0; frame < 12; ++frame) {
            const std::uint32_t moving = std::array{0U, 10U, n}[below(3)];
            const bool flat = below(3) == 0;
            for (std::uint32_t id = 0; id < n; ++id) {
                if (frame == 0 || below(n) < moving)
                    for (int k = 0; k < 3; ++k) {
                        boxes[id].min[k] = static_cast<float>(below(40));
                        boxes[id].max[k] = boxes[id].min[k] + static_cast<float>(below(12));
                    }
                if (flat) boxes[id].min[1] = 0, boxes[id].max[1] = 60;
                if (frame > 0 && below(10) == 0) {
                    present[id] ? search.stage().remove(id) : search.stage().insert(id);
                    present[id] = !present[id];
                }
            }
            restarts += search.play(boxes).restarts;
            REQUIRE(search.pairs() == overlapping(boxes, present));
        }
    }
    CHECK(restarts > 40);
}

TEST_CASE("what stands still is never sorted again") {
    for (const char* sort : {"insertion", "shell", "std"}) {
        CAPTURE(sort);
        std::vector<box> boxes = scattered(1000);
        counted_search search(composed({{strategy_kind::sort, sort}, {strategy_kind::sweep, "all_axes"}}), 1000);
        search.play(boxes);
        CHECK(search.play(boxes).comparisons == 0);
        boxes[17].min[0] += 1;
        boxes[17].max[0] += 1;
        // One object finds its place on one axis by doubling steps and halving.
        CHECK(search.play(boxes).comparisons <= 2 * 10 + 2);
    }
}

TEST_CASE("incremental holds no list of an axis on which all boxes overlap, until some do not") {
    std::vector<box> boxes = scattered(300);
    for (box& b : boxes) b.min[1] = 0, b.max[1] = 50;
    counted_search search(incremental, 300);
    search.play(boxes);
    const auto left_out = [&] {
        std::string all;
        for (const omission& one : search.stage().left_out()) all += to_text(one) + "; ";
        return all;
    };
    CHECK(left_out().find("no projection list of the y axis") != std::string::npos);
    boxes[0].min[1] = 60;
    boxes[0].max[1] = 70;
    search.play(boxes);
    CHECK(left_out().find("no projection list of the y axis") == std::string::npos);
}

TEST_CASE("sweeps that keep their pairs are refused with what they cannot follow, and say why") {
    for (const char* sweep : {"incremental", "subdivided"}) {
        const auto refusal = [&](const char* sort, const char* partition) {
            return std::string(refusal_of(composed({{strategy_kind::sort, sort},
                                                    {strategy_kind::partition, partition},
                                                    {strategy_kind::sweep, sweep}}),
                                          stage::global_search));
        };
        for (const char* sort : {"shell", "std"}) CHECK(refusal(sort, "none").ends_with("it goes with insertion only"));
        for (const char* partition : {"axial_cut", "uniform_grid"})
            CHECK(refusal("insertion", partition).ends_with("it goes with none only"));
        CHECK(refusal("insertion", "none").empty());
    }
}
