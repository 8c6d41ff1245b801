#include <catch2/catch_test_macros.hpp>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "../compositions.hpp"

using namespace aabb;

namespace {

struct work_of_frame {
    std::uint64_t comparisons, moves, box_tests, pairs;
};

/// A counted search that says what a frame took.
class counted_search {
public:
    explicit counted_search(const aabb::composition& c, std::uint32_t objects)
        : stage_(compose_global_search(c, instrumentation::counters)) {
        for (std::uint32_t id = 0; id < objects; ++id) stage_->insert(id);
    }

    work_of_frame play(const std::vector<box>& boxes) {
        const work_counters before = stage_->counters();
        pairs_.clear();
        stage_->update(boxes);
        stage_->search(pairs_);
        const work_counters after = stage_->counters();
        const auto spent = [&](work what) { return after[what] - before[what]; };
        return {spent(work::comparisons), spent(work::moves), spent(work::box_tests), pairs_.size()};
    }

    [[nodiscard]] global_stage& stage() { return *stage_; }

private:
    std::unique_ptr<global_stage> stage_;
    std::vector<index_pair> pairs_;
};

composition with_incremental(const char* sort, const char* partition) {
    composition c;
    c[strategy_kind::sort].name = sort;
    c[strategy_kind::partition].name = partition;
    c[strategy_kind::sweep].name = "incremental";
    return c;
}
const composition incremental = with_incremental("insertion", "none");

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
    CHECK(together.pairs == before.pairs);
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
        for (const std::string& sentence : search.stage().left_out()) all += sentence + "; ";
        return all;
    };
    CHECK(left_out().find("no projection list of the y axis") != std::string::npos);
    boxes[0].min[1] = 60;
    boxes[0].max[1] = 70;
    search.play(boxes);
    CHECK(left_out().find("no projection list of the y axis") == std::string::npos);
}

TEST_CASE("incremental is refused with what it cannot follow, and says why") {
    for (const char* sort : {"shell", "std"})
        CHECK(std::string(refusal_of(with_incremental(sort, "none"), stage::global_search))
                  .ends_with("it goes with insertion only"));
    for (const char* partition : {"axial_cut", "uniform_grid"})
        CHECK(std::string(refusal_of(with_incremental("insertion", partition), stage::global_search))
                  .ends_with("it goes with none only"));
    CHECK(refusal_of(incremental, stage::global_search).empty());
}
