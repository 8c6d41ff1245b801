// What sets each sweep apart; global_compositions.cpp has that all of them find the pairs.

#include "searches.hpp"

using namespace aabb;

namespace {

struct work_of_frame {
    std::uint64_t comparisons, moves, swaps, restarts, box_tests, pairs;
};

/// A counted search that says what a frame took.
class counted_search {
public:
    counted_search(const composition& c, std::size_t objects) : stage_(search_of(c, objects)) {}

    work_of_frame play(const std::vector<box>& boxes) {
        const work_counters before = stage_->counters();
        pairs_ = found_by(*stage_, boxes);
        const work_counters after = stage_->counters();
        const auto spent = [&](work what) { return after[what] - before[what]; };
        return {spent(work::comparisons), spent(work::moves),     spent(work::inversions),
                spent(work::restarts),    spent(work::box_tests), pairs_.size()};
    }

    [[nodiscard]] const std::vector<index_pair>& pairs() const { return pairs_; }
    [[nodiscard]] global_stage& stage() { return *stage_; }

private:
    std::unique_ptr<global_stage> stage_;
    std::vector<index_pair> pairs_;
};

composition sweeping(const char* sweep) {
    return composed({{strategy_kind::sweep, sweep}});
}
/// Of those that keep their pairs.
composition keeping(const std::string& sweep) {
    return composed({{strategy_kind::sort, "insertion"}, {strategy_kind::sweep, sweep.c_str()}});
}

/// How many pairs overlap on all of these axes.
std::uint64_t pairs_on(const std::vector<box>& boxes, const std::vector<int>& axes) {
    std::uint64_t pairs = 0;
    for (std::size_t a = 0; a < boxes.size(); ++a)
        for (std::size_t b = a + 1; b < boxes.size(); ++b)
            pairs += std::ranges::all_of(
                axes, [&](int k) { return boxes[a].min[k] <= boxes[b].max[k] && boxes[b].min[k] <= boxes[a].max[k]; });
    return pairs;
}

/// Some of the objects leave, others come back.
void come_and_go(global_stage& stage, std::vector<bool>& present, std::mt19937& random, std::uint32_t one_in) {
    for (std::uint32_t id = 0; id < present.size(); ++id)
        if (random() % one_in == 0) {
            present[id] ? stage.remove(id) : stage.insert(id);
            present[id] = !present[id];
        }
}

}  // namespace

TEST_CASE("all_axes visits each pair of an axis once, however many blocks the pairs take") {
    // The bits of the pairs of 13,000 take more than the 16 MiB of one block.
    for (const std::size_t n : {3000UL, 13'000UL}) {
        CAPTURE(n);
        std::mt19937 random(1);
        const std::vector<box> boxes = lattice_boxes(random, n, 400, 8);
        counted_search all_axes(sweeping("all_axes"), n);
        counted_search one_axis(sweeping("one_axis"), n);
        const work_of_frame spent = all_axes.play(boxes);
        one_axis.play(boxes);
        CHECK(spent.pairs > 10);
        CHECK(all_axes.pairs() == one_axis.pairs());
        // The first list is not walked: where each box's overlaps end in it is known.
        CHECK(spent.box_tests == pairs_on(boxes, {1}) + pairs_on(boxes, {2}));
    }
}

TEST_CASE("two_axis tests boxes that can meet on two axes only, and a long one makes others test no more") {
    std::vector<box> boxes = cubes(5000, {60, 50, 40});
    counted_search two_axis(sweeping("two_axis"), 5000);
    counted_search one_axis(sweeping("one_axis"), 5000);
    const work_of_frame two = two_axis.play(boxes);
    const work_of_frame one = one_axis.play(boxes);
    CHECK(two_axis.pairs() == one_axis.pairs());
    CHECK(two.pairs > 500);
    const std::uint64_t on_both = pairs_on(boxes, {0, 1});
    CHECK(two.box_tests >= on_both);
    // Beside these, those that have ended, once each, and of the words at the ends of what it can reach.
    CHECK(two.box_tests < 2 * (on_both + boxes.size()));
    CHECK(8 * two.box_tests < one.box_tests);
    CHECK(leaves_out(two_axis.stage(), absence::z_list));
    // One that is long on the second axis is tested against all.
    boxes.push_back({{20, 0, 0}, {40, 50, 40}});
    counted_search with_long(sweeping("two_axis"), 5001);
    const work_of_frame more = with_long.play(boxes);
    CHECK(with_long.pairs() == overlapping(boxes));
    CHECK(more.box_tests >= two.box_tests);
    CHECK(more.box_tests < two.box_tests + 2 * boxes.size());
}

TEST_CASE("a frame in which nothing moved costs a sweep that keeps its pairs nothing") {
    for (const char* sweep : {"incremental", "subdivided"}) {
        CAPTURE(sweep);
        const std::vector<box> boxes = scattered(500, 20);
        counted_search search(keeping(sweep), 500);
        const work_of_frame first = search.play(boxes);
        CHECK(first.box_tests > 0);
        CHECK(first.pairs > 100);
        CHECK(first.restarts == 0);
        const work_of_frame second = search.play(boxes);
        CHECK(second.box_tests == 0);
        CHECK(second.comparisons == 0);
        CHECK(second.moves == 0);
        CHECK(second.pairs == first.pairs);
    }
}

TEST_CASE("a move that passes no end costs incremental no test of a pair") {
    std::vector<box> boxes = scattered(500, 20);
    counted_search search(keeping("incremental"), 500);
    const work_of_frame before = search.play(boxes);
    for (box& b : boxes) b = moved(b, {0.5F, 0.5F, 0.5F});
    const work_of_frame together = search.play(boxes);
    CHECK(together.box_tests == 0);
    CHECK(together.comparisons > 0);
    CHECK(together.restarts == 0);
    CHECK(together.pairs == before.pairs);
}

TEST_CASE("incremental follows no more swaps in a frame than starting anew takes steps") {
    constexpr std::uint32_t n = 2000;
    counted_search search(keeping("incremental"), n);
    std::uint32_t seed = 0;
    const auto play_anywhere = [&] { return search.play(cubes(n, {100, 100, 100}, ++seed)); };
    const work_of_frame first = play_anywhere();
    CHECK(first.restarts == 0);
    for (int frame = 0; frame < 3; ++frame) {
        const work_of_frame teleported = play_anywhere();
        CHECK(teleported.restarts == 1);
        CHECK(teleported.swaps < 2 * (first.box_tests + 3 * 2 * n * 12));
        // Followed to the end there would be four million swaps an axis.
        CHECK(teleported.box_tests < 4 * first.box_tests);
    }
    // After a frame in which all overlap, as many steps are not allowed for ever.
    CHECK(search.play(std::vector<box>(n, cube(0, 1))).pairs == n * (n - 1) / 2);
    play_anywhere();
    play_anywhere();
    CHECK(play_anywhere().swaps < 4 * (first.box_tests + 3 * 2 * n * 12));
}

TEST_CASE("incremental started anew finds the pairs, whoever comes, goes or begins an axis in that frame") {
    std::mt19937 random(1);
    std::uint64_t restarts = 0;
    for (int scene = 0; scene < 40; ++scene) {
        constexpr std::uint32_t n = 100;
        counted_search search(keeping("incremental"), n);
        std::vector<bool> present(n, true);
        std::vector<box> boxes(n);
        for (int frame = 0; frame < 12; ++frame) {
            const std::uint32_t moving = std::array{0U, 10U, n}[random() % 3];
            const bool flat = random() % 3 == 0;
            for (box& b : boxes) {
                if (frame == 0 || random() % n < moving) b = lattice_box(random, 40, 12);
                if (flat) b.min[1] = 0, b.max[1] = 60;
            }
            if (frame > 0) come_and_go(search.stage(), present, random, 10);
            restarts += search.play(boxes).restarts;
            REQUIRE(search.pairs() == overlapping(boxes, present));
        }
    }
    CHECK(restarts > 40);
}

TEST_CASE("what stands still is never sorted again") {
    for (const char* sort : {"insertion", "shell", "std"}) {
        CAPTURE(sort);
        std::vector<box> boxes = scattered(1000, 20);
        counted_search search(composed({{strategy_kind::sort, sort}, {strategy_kind::sweep, "all_axes"}}), 1000);
        search.play(boxes);
        CHECK(search.play(boxes).comparisons == 0);
        boxes[17] = moved(boxes[17], {1, 0, 0});
        // One object finds its place on one axis by doubling steps and halving.
        CHECK(search.play(boxes).comparisons <= 2 * 10 + 2);
    }
}

TEST_CASE("incremental holds no list of an axis on which all boxes overlap, until some do not") {
    std::vector<box> boxes = scattered(300, 20);
    for (box& b : boxes) b.min[1] = 0, b.max[1] = 50;
    counted_search search(keeping("incremental"), 300);
    search.play(boxes);
    CHECK(leaves_out(search.stage(), absence::y_list));
    boxes[0].min[1] = 60;
    boxes[0].max[1] = 70;
    search.play(boxes);
    CHECK_FALSE(leaves_out(search.stage(), absence::y_list));
}

TEST_CASE("sweeps that keep their pairs are refused with what they cannot follow, and say why") {
    for (const char* sweep : {"incremental", "subdivided"}) {
        const auto rejection = [&](const char* sort, const char* partition) {
            return std::string(rejection_of(composed({{strategy_kind::sort, sort},
                                                      {strategy_kind::partition, partition},
                                                      {strategy_kind::sweep, sweep}}),
                                            stage::global_search));
        };
        for (const char* sort : {"shell", "std"})
            CHECK(rejection(sort, "none").ends_with("it can be combined with insertion only"));
        for (const char* partition : {"axial_cut", "uniform_grid"})
            CHECK(rejection("insertion", partition).ends_with("it can be combined with none only"));
        CHECK(rejection("insertion", "none").empty());
    }
}

TEST_CASE("one move costs subdivided what lies near it") {
    std::mt19937 random(1);
    std::vector<box> boxes = lattice_boxes(random, 4000, 100, 6);
    counted_search search(keeping("subdivided"), 4000);
    search.play(boxes);
    // Across all of the world, whose lists have 8,000 ends.
    boxes[17].min[0] += 200 - 2 * boxes[17].min[0];
    boxes[17].max[0] = boxes[17].min[0] + 3;
    const work_of_frame spent = search.play(boxes);
    CHECK(spent.restarts == 0);
    CHECK_BETWEEN(0, spent.swaps, 1000);
    CHECK(search.pairs() == overlapping(boxes));
}

TEST_CASE("subdivided finds the pairs, whoever crosses regions, comes and goes") {
    std::mt19937 random(2);
    std::uint64_t followed = 0;
    std::uint64_t restarts = 0;
    for (unsigned scene = 0; scene < 60; ++scene) {
        constexpr std::uint32_t n = 150;
        const std::string parameters = std::array{"", ":regions=1", ":regions=7", ":regions=256"}[scene % 4];
        counted_search search(keeping("subdivided" + parameters), n);
        std::vector<bool> present(n, true);
        std::vector<box> boxes(n);
        for (int frame = 0; frame < 15; ++frame) {
            const std::uint32_t moving = std::array{0U, 3U, 20U, n}[random() % 4];
            // Beyond the grid, too.
            const std::uint32_t side = 20 + random() % 60;
            for (box& b : boxes)
                if (frame == 0 || random() % n < moving) b = lattice_box(random, side, 12);
            if (frame > 0) come_and_go(search.stage(), present, random, 40);
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
    std::mt19937 random(3);
    constexpr std::uint32_t n = 4000;
    std::vector<box> boxes = lattice_boxes(random, n, 1000, 6);
    counted_search search(keeping("subdivided"), n);
    const work_of_frame many = search.play(boxes);
    counted_search grown(keeping("subdivided"), 10);
    grown.play(boxes);
    for (std::uint32_t id = 10; id < n; ++id) {
        grown.stage().insert(id);
        if (id % 100 == 0) grown.play(boxes);
    }
    grown.play(boxes);
    CHECK(grown.pairs() == search.pairs());
    const auto play_moved = [&](counted_search& of) {
        for (std::uint32_t id = 0; id < n; id += 10) boxes[id] = moved(boxes[id], {1, 0, 0});
        return of.play(boxes);
    };
    const std::uint64_t swaps = play_moved(search).swaps;
    CHECK(swaps < many.box_tests + n * 10);
    grown.play(boxes);
    // At most half as many objects in a region's lists again.
    CHECK(play_moved(grown).swaps < 3 * swaps);
}

TEST_CASE("subdivided finds the pairs where many leave, frames end earlier, and boxes grow") {
    std::mt19937 random(4);
    for (const std::string parameters : {"", ":regions=1", ":regions=9"}) {
        std::uint32_t n = 400;
        counted_search search(keeping("subdivided" + parameters), n);
        std::vector<box> boxes(n);
        for (int frame = 0; frame < 24; ++frame) {
            // From points to boxes of half the world.
            for (box& b : boxes) b = lattice_box(random, 60, 1 + static_cast<std::uint32_t>(frame % 8) * 4);
            search.play(boxes);
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
        search.play(boxes);
        std::vector<bool> present(n, true);
        present[3] = false;
        REQUIRE(search.pairs() == overlapping(boxes, present));
    }
}
