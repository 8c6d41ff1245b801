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

composition subdivided(const std::string& parameters = "") {
    return composed({{strategy_kind::sort, "insertion"}, {strategy_kind::sweep, ("subdivided" + parameters).c_str()}});
}

class random_boxes {
public:
    explicit random_boxes(unsigned seed) : random_(seed) {}

    std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(random_() % end); }

    /// With whole numbers, so that many touch.
    box in(std::uint32_t side, std::uint32_t extent) {
        box b{};
        for (int k = 0; k < 3; ++k) {
            b.min[k] = static_cast<float>(below(side));
            b.max[k] = b.min[k] + static_cast<float>(below(extent));
        }
        return b;
    }

private:
    std::mt19937 random_;
};

}  // namespace

TEST_CASE("a frame in which nothing moved costs subdivided nothing, and one move what lies near it") {
    random_boxes random(1);
    std::vector<box> boxes;
    for (int i = 0; i < 4000; ++i) boxes.push_back(random.in(100, 6));
    counted_search search(subdivided(), 4000);
    const work_of_frame first = search.play(boxes);
    CHECK(first.pairs > 100);
    CHECK(first.restarts == 0);
    const work_of_frame second = search.play(boxes);
    CHECK(second.box_tests == 0);
    CHECK(second.comparisons == 0);
    CHECK(second.pairs == first.pairs);
    // Across all of the world, whose lists have 8,000 ends.
    boxes[17].min[0] += 200 - 2 * boxes[17].min[0];
    boxes[17].max[0] = boxes[17].min[0] + 3;
    const work_of_frame third = search.play(boxes);
    CHECK(third.restarts == 0);
    CHECK(third.swaps > 0);
    CHECK(third.swaps < 1000);
    CHECK(search.pairs() == overlapping(boxes));
}

TEST_CASE("subdivided finds the pairs, whoever crosses regions, comes and goes") {
    random_boxes random(2);
    std::uint64_t followed = 0;
    std::uint64_t restarts = 0;
    for (unsigned scene = 0; scene < 60; ++scene) {
        constexpr std::uint32_t n = 150;
        counted_search search(subdivided(std::array{"", ":regions=1", ":regions=7", ":regions=256"}[scene % 4]), n);
        std::vector<bool> present(n, true);
        std::vector<box> boxes(n);
        for (int frame = 0; frame < 15; ++frame) {
            const std::uint32_t moving = std::array{0U, 3U, 20U, n}[random.below(4)];
            // Beyond the grid, too.
            const std::uint32_t side = 20 + random.below(60);
            for (std::uint32_t id = 0; id < n; ++id) {
                if (frame == 0 || random.below(n) < moving) boxes[id] = random.in(side, 12);
                if (frame > 0 && random.below(40) == 0) {
                    present[id] ? search.stage().remove(id) : search.stage().insert(id);
                    present[id] = !present[id];
                }
            }
            const work_of_frame spent = search.play(boxes);
            followed += spent.swaps > 0 && spent.restarts == 0 ? 1 : 0;
            restarts += spent.restarts;
            REQUIRE(search.pairs() == overlapping(boxes, present));
        }
    }
    CHECK(followed > 100);
    CHECK(restarts > 40);
}

TEST_CASE("subdivided takes a grid for as many objects as are present") {
    random_boxes random(3);
    constexpr std::uint32_t n = 4000;
    std::vector<box> boxes;
    for (std::uint32_t i = 0; i < n; ++i) boxes.push_back(random.in(1000, 6));
    counted_search search(subdivided(), n);
    const work_of_frame many = search.play(boxes);
    counted_search grown(subdivided(), 10);
    grown.play(boxes);
    for (std::uint32_t id = 10; id < n; ++id) {
        grown.stage().insert(id);
        if (id % 100 == 0) grown.play(boxes);
    }
    grown.play(boxes);
    CHECK(grown.pairs() == search.pairs());
    const auto moved = [&](counted_search& of) {
        for (std::uint32_t id = 0; id < n; id += 10) boxes[id].min[0] += 1, boxes[id].max[0] += 1;
        return of.play(boxes);
    };
    const std::uint64_t swaps = moved(search).swaps;
    CHECK(swaps < many.box_tests + n * 10);
    grown.play(boxes);
    // At most half as many objects in a region's lists again.
    CHECK(moved(grown).swaps < 3 * swaps);
}

TEST_CASE("subdivided finds the pairs where many leave, frames end earlier, and boxes grow") {
    random_boxes random(4);
    for (const char* parameters : {"", ":regions=1", ":regions=9"}) {
        std::uint32_t n = 400;
        counted_search search(subdivided(parameters), n);
        std::vector<box> boxes(n);
        for (int frame = 0; frame < 24; ++frame) {
            // From points to boxes of half the world.
            for (box& b : boxes) b = random.in(60, 1 + static_cast<std::uint32_t>(frame % 8) * 4);
            (void)search.play(boxes);
            REQUIRE(search.pairs() == overlapping(boxes));
            if (frame % 8 == 3) {
                for (std::uint32_t id = n / 2; id < n; ++id) search.stage().remove(id);
                n /= 2;
                boxes.resize(n);
            } else if (frame % 8 == 7) {
                // Who comes back lies where it never was.
                for (std::uint32_t id = n; id < 2 * n; ++id) search.stage().insert(id);
                n *= 2;
                boxes.resize(n);
            }
        }
        boxes[7].max[0] = boxes[7].min[0] - 1;
        search.stage().remove(3);
        CHECK_THROWS_AS(search.play(boxes), input_error);
        boxes[7].max[0] = boxes[7].min[0] + 1;
        (void)search.play(boxes);
        std::vector<bool> present(n, true);
        present[3] = false;
        REQUIRE(search.pairs() == overlapping(boxes, present));
    }
}
