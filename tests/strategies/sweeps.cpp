// What distinguishes each sweep; global_compositions.cpp tests that all of them find the pairs.

#include "searches.hpp"

using namespace aabb;

namespace {

struct work_of_frame {
    std::uint64_t comparisons, moves, swaps, restarts, box_tests, pairs;
};

/// A search that reports the work of each frame.
class counted_search {
public:
    counted_search(const composition& c, std::size_t objects) : stage_(search_of(c, objects)) {}

    work_of_frame run(const std::vector<box>& boxes) {
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

composition with_sweep(const char* sweep) {
    return composed({{strategy_kind::sweep, sweep}});
}
/// With a sweep that keeps its pairs.
composition with_coherent(const std::string& sweep) {
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

/// Removes some of the objects, and inserts others again.
void come_and_go(global_stage& stage, std::vector<bool>& present, std::mt19937& random, std::uint32_t one_in) {
    for (std::uint32_t id = 0; id < present.size(); ++id)
        if (random() % one_in == 0) {
            present[id] ? stage.remove(id) : stage.insert(id);
            present[id] = !present[id];
        }
}

}  // namespace

TEST_CASE("all_axes visits each pair of an axis once, in any number of blocks") {
    // The bits of the pairs of 13,000 take more than the 16 MiB of one block.
    for (const std::size_t n : {3000UL, 13'000UL}) {
        CAPTURE(n);
        std::mt19937 random(1);
        const std::vector<box> boxes = lattice_boxes(random, n, 400, 8);
        counted_search all_axes(with_sweep("all_axes"), n);
        counted_search one_axis(with_sweep("one_axis"), n);
        const work_of_frame spent = all_axes.run(boxes);
        one_axis.run(boxes);
        CHECK(spent.pairs > 10);
        CHECK(all_axes.pairs() == one_axis.pairs());
        // The first list is not swept: it is known where each box's overlaps end in it.
        CHECK(spent.box_tests == pairs_on(boxes, {1}) + pairs_on(boxes, {2}));
    }
}

TEST_CASE("two_axis tests only boxes that can overlap on two axes, and a long box adds no tests of others") {
    std::vector<box> boxes = cubes(5000, {60, 50, 40});
    counted_search two_axis(with_sweep("two_axis"), 5000);
    counted_search one_axis(with_sweep("one_axis"), 5000);
    const work_of_frame two_axis_work = two_axis.run(boxes);
    const work_of_frame one_axis_work = one_axis.run(boxes);
    CHECK(two_axis.pairs() == one_axis.pairs());
    CHECK(two_axis_work.pairs > 500);
    const std::uint64_t on_both = pairs_on(boxes, {0, 1});
    CHECK(two_axis_work.box_tests >= on_both);
    // It also tests boxes that have ended, once each, and some in the words at the ends of its range.
    CHECK(two_axis_work.box_tests < 2 * (on_both + boxes.size()));
    CHECK(8 * two_axis_work.box_tests < one_axis_work.box_tests);
    CHECK(leaves_out(two_axis.stage(), absence::z_list));
    // A box that is long on the second axis is tested against all.
    boxes.push_back({{20, 0, 0}, {40, 50, 40}});
    counted_search with_long(with_sweep("two_axis"), 5001);
    const work_of_frame work_with_long = with_long.run(boxes);
    CHECK(with_long.pairs() == overlapping(boxes));
    CHECK(work_with_long.box_tests >= two_axis_work.box_tests);
    CHECK(work_with_long.box_tests < two_axis_work.box_tests + 2 * boxes.size());
}

TEST_CASE("coherent sweeps do no work in a frame in which nothing moved") {
    for (const char* sweep : {"incremental", "subdivided", "segmented"}) {
        CAPTURE(sweep);
        const std::vector<box> boxes = scattered(500, 20);
        counted_search search(with_coherent(sweep), 500);
        const work_of_frame first = search.run(boxes);
        CHECK(first.box_tests > 0);
        CHECK(first.pairs > 100);
        CHECK(first.restarts == 0);
        const work_of_frame second = search.run(boxes);
        CHECK(second.box_tests == 0);
        CHECK(second.comparisons == 0);
        CHECK(second.moves == 0);
        CHECK(second.pairs == first.pairs);
    }
}

TEST_CASE("incremental tests no pairs if boxes move past no interval ends") {
    std::vector<box> boxes = scattered(500, 20);
    counted_search search(with_coherent("incremental"), 500);
    const work_of_frame before = search.run(boxes);
    for (box& b : boxes) b = moved(b, {0.5F, 0.5F, 0.5F});
    const work_of_frame together = search.run(boxes);
    CHECK(together.box_tests == 0);
    CHECK(together.comparisons > 0);
    CHECK(together.restarts == 0);
    CHECK(together.pairs == before.pairs);
}

TEST_CASE("incremental follows no more swaps in a frame than a restart takes steps") {
    constexpr std::uint32_t n = 2000;
    counted_search search(with_coherent("incremental"), n);
    std::uint32_t seed = 0;
    const auto run_teleported = [&] { return search.run(cubes(n, {100, 100, 100}, ++seed)); };
    const work_of_frame first = run_teleported();
    CHECK(first.restarts == 0);
    for (int frame = 0; frame < 3; ++frame) {
        const work_of_frame teleported = run_teleported();
        CHECK(teleported.restarts == 1);
        CHECK(teleported.swaps < 2 * (first.box_tests + 3 * 2 * n * 12));
        // Without the limit there would be four million swaps per axis.
        CHECK(teleported.box_tests < 4 * first.box_tests);
    }
    // A frame in which all boxes overlap does not raise the limit for good.
    CHECK(search.run(std::vector<box>(n, cube(0, 1))).pairs == n * (n - 1) / 2);
    run_teleported();
    run_teleported();
    CHECK(run_teleported().swaps < 4 * (first.box_tests + 3 * 2 * n * 12));
}

TEST_CASE("incremental finds the pairs after a restart, as objects come and go and axes are added") {
    std::mt19937 random(1);
    std::uint64_t restarts = 0;
    for (int scene = 0; scene < 40; ++scene) {
        constexpr std::uint32_t n = 100;
        counted_search search(with_coherent("incremental"), n);
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
            restarts += search.run(boxes).restarts;
            REQUIRE(search.pairs() == overlapping(boxes, present));
        }
    }
    CHECK(restarts > 40);
}

TEST_CASE("boxes at rest are not sorted again") {
    for (const char* sort : {"insertion", "shell", "std"}) {
        CAPTURE(sort);
        std::vector<box> boxes = scattered(1000, 20);
        counted_search search(composed({{strategy_kind::sort, sort}, {strategy_kind::sweep, "all_axes"}}), 1000);
        search.run(boxes);
        CHECK(search.run(boxes).comparisons == 0);
        boxes[17] = moved(boxes[17], {1, 0, 0});
        // One object finds its place on one axis by doubling steps, then halving them.
        CHECK(search.run(boxes).comparisons <= 2 * 10 + 2);
    }
}

TEST_CASE("incremental has no list of an axis while all boxes overlap on it") {
    std::vector<box> boxes = scattered(300, 20);
    for (box& b : boxes) b.min[1] = 0, b.max[1] = 50;
    counted_search search(with_coherent("incremental"), 300);
    search.run(boxes);
    CHECK(leaves_out(search.stage(), absence::y_list));
    boxes[0].min[1] = 60;
    boxes[0].max[1] = 70;
    search.run(boxes);
    CHECK_FALSE(leaves_out(search.stage(), absence::y_list));
}

TEST_CASE("coherent sweeps reject sorts and partitions that they cannot follow, with a reason") {
    for (const char* sweep : {"incremental", "subdivided", "segmented"}) {
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
    const composition tree =
        composed({{strategy_kind::partition, "kd_tree"}, {strategy_kind::sweep, "temporal_kd_tree"}});
    CHECK(std::string(rejection_of(tree, stage::global_search)).ends_with("it can be combined with none only"));
}

TEST_CASE("a single move costs sweeps in regions only swaps nearby") {
    for (const char* sweep : {"subdivided", "segmented"}) {
        CAPTURE(sweep);
        std::mt19937 random(1);
        std::vector<box> boxes = lattice_boxes(random, 4000, 100, 6);
        counted_search search(with_coherent(sweep), 4000);
        search.run(boxes);
        // Across the whole world, whose lists have 8,000 ends; also by a little, which no insertion finds.
        boxes[17].min[0] += 200 - 2 * boxes[17].min[0];
        boxes[17].max[0] = boxes[17].min[0] + 3;
        boxes[18] = moved(boxes[18], {1, 1, 1});
        const work_of_frame spent = search.run(boxes);
        CHECK(spent.restarts == 0);
        CHECK_BETWEEN(0, spent.swaps, 1500);
        CHECK(search.pairs() == overlapping(boxes));
    }
}

TEST_CASE("an object enters and leaves lists in segments by moving a segment of each, and by tests nearby") {
    constexpr std::uint32_t n = 4000;
    std::vector<box> boxes = cubes(n, {400, 40, 40});
    counted_search search(with_coherent("segmented:regions=1"), n);
    search.run(boxes);
    search.stage().remove(17);
    const work_of_frame left = search.run(boxes);
    search.stage().insert(17);
    boxes[17] = moved(cube(20, 1), {180, 0, 0});
    const work_of_frame entered = search.run(boxes);
    CHECK(search.pairs() == overlapping(boxes));
    for (const work_of_frame& spent : {left, entered}) {
        CHECK(spent.restarts == 0);
        CHECK(spent.comparisons == 0);
        CHECK_BETWEEN(0, spent.moves, 6 * 64 + 1);
        // On the marked axis about n / 200 boxes overlap it, or n / 100 that end in its segment.
        CHECK_BETWEEN(0, spent.box_tests, 200);
    }
    // Lists of other sweeps are merged with arrivals, which are tested against all that overlap on an axis.
    counted_search merged(with_coherent("incremental"), n);
    merged.run(boxes);
    merged.stage().remove(17);
    merged.run(boxes);
    merged.stage().insert(17);
    CHECK(merged.run(boxes).pairs == entered.pairs);
}

TEST_CASE("sweeps in regions find the pairs as objects cross regions, come and go") {
    std::mt19937 random(2);
    std::uint64_t followed = 0;
    std::uint64_t restarts = 0;
    for (unsigned scene = 0; scene < 120; ++scene) {
        constexpr std::uint32_t n = 150;
        const std::string parameters = std::array{"", ":regions=1", ":regions=7", ":regions=256"}[scene % 4];
        // Of the 256 cubed regions over three axes, a box overlaps too many.
        const bool is_segmented = scene % 2 == 1 && parameters != ":regions=256";
        counted_search search(with_coherent((is_segmented ? "segmented" : "subdivided") + parameters), n);
        std::vector<bool> present(n, true);
        std::vector<box> boxes(n);
        for (int frame = 0; frame < 15; ++frame) {
            const std::uint32_t moving = std::array{0U, 3U, 20U, n}[random() % 4];
            // Beyond the grid, too.
            const std::uint32_t side = 20 + random() % 60;
            for (box& b : boxes)
                if (frame == 0 || random() % n < moving) b = lattice_box(random, side, 12);
            if (frame > 0) come_and_go(search.stage(), present, random, 40);
            const work_of_frame spent = search.run(boxes);
            followed += spent.swaps > 0 && spent.restarts == 0 ? 1 : 0;
            restarts += spent.restarts;
            REQUIRE(search.pairs() == overlapping(boxes, present));
        }
    }
    CHECK(followed > 200);
    CHECK(restarts > 80);
}

TEST_CASE("subdivided fits its grid to the number of present objects") {
    std::mt19937 random(3);
    constexpr std::uint32_t n = 4000;
    std::vector<box> boxes = lattice_boxes(random, n, 1000, 6);
    counted_search search(with_coherent("subdivided"), n);
    const work_of_frame many = search.run(boxes);
    counted_search grown(with_coherent("subdivided"), 10);
    grown.run(boxes);
    for (std::uint32_t id = 10; id < n; ++id) {
        grown.stage().insert(id);
        if (id % 100 == 0) grown.run(boxes);
    }
    grown.run(boxes);
    CHECK(grown.pairs() == search.pairs());
    const auto run_moved = [&](counted_search& moved_search) {
        for (std::uint32_t id = 0; id < n; id += 10) boxes[id] = moved(boxes[id], {1, 0, 0});
        return moved_search.run(boxes);
    };
    const std::uint64_t swaps = run_moved(search).swaps;
    CHECK(swaps < many.box_tests + n * 10);
    grown.run(boxes);
    // A region's lists hold at most half as many objects more.
    CHECK(run_moved(grown).swaps < 3 * swaps);
}

TEST_CASE("sweeps in regions find the pairs as many objects leave, frames get smaller and boxes grow") {
    std::mt19937 random(4);
    for (const std::string sweep : {"subdivided", "subdivided:regions=1", "subdivided:regions=9", "segmented",
                                    "segmented:regions=1", "segmented:regions=5"}) {
        std::uint32_t n = 400;
        counted_search search(with_coherent(sweep), n);
        std::vector<box> boxes(n);
        for (int frame = 0; frame < 24; ++frame) {
            // From points to boxes of half the world.
            for (box& b : boxes) b = lattice_box(random, 60, 1 + static_cast<std::uint32_t>(frame % 8) * 4);
            search.run(boxes);
            REQUIRE(search.pairs() == overlapping(boxes));
            if (frame % 8 == 3) {
                for (std::uint32_t id = n / 2; id < n; ++id) search.stage().remove(id);
                n /= 2;
                boxes.resize(n);
            } else if (frame % 8 == 7) {
                // Objects come back in new places.
                for (std::uint32_t id = n; id < 2 * n; ++id) search.stage().insert(id);
                n *= 2;
                boxes.resize(n);
            }
        }
        boxes[7].max[0] = boxes[7].min[0] - 1;
        search.stage().remove(3);
        CHECK_THROWS_AS(search.run(boxes), input_error);
        boxes[7].max[0] = boxes[7].min[0] + 1;
        search.run(boxes);
        std::vector<bool> present(n, true);
        present[3] = false;
        REQUIRE(search.pairs() == overlapping(boxes, present));
    }
}
