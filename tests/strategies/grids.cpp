// Grids: which boxes share a cell, and what is kept between frames.

#include "searches.hpp"

using namespace aabb;

namespace {

struct frame_work {
    std::uint64_t comparisons, moves, tests, copies;
    std::vector<index_pair> pairs;
};

/// A search with a partition, which counts the work of each frame.
class grid_search {
public:
    grid_search(const char* sort, const char* partition, const char* sweep, std::size_t objects)
        : stage_(search_of(
              composed(
                  {{strategy_kind::sort, sort}, {strategy_kind::partition, partition}, {strategy_kind::sweep, sweep}}),
              objects)) {}
    grid_search(const char* partition, std::size_t objects) : grid_search("std", partition, "one_axis", objects) {}

    frame_work run(const std::vector<box>& boxes) {
        const work_counters before = stage_->counters();
        frame_work spent{};
        spent.pairs = found_by(*stage_, boxes);
        const work_counters after = stage_->counters();
        const auto count = [&](work what) { return after[what] - before[what]; };
        spent.comparisons = count(work::comparisons);
        spent.moves = count(work::moves);
        spent.tests = count(work::box_tests);
        spent.copies = count(work::subset_copies);
        return spent;
    }
    [[nodiscard]] global_stage& stage() { return *stage_; }
    [[nodiscard]] std::size_t grid_bytes() const { return bytes_of_part(stage_->bytes(), "partition"); }

private:
    std::unique_ptr<global_stage> stage_;
};

/// Unit cubes, and one cube in a hundred as long as this.
std::vector<box> of_two_sizes(std::size_t n, float width, float large) {
    std::vector<box> boxes = cubes(n, {width, width, width});
    for (std::size_t i = 0; i < n; i += 100)
        for (int k = 0; k < 3; ++k) boxes[i].max[k] = boxes[i].min[k] + large;
    return boxes;
}

}  // namespace

TEST_CASE("a hierarchical grid tests small boxes against few others, whatever the large ones") {
    const std::vector<box> boxes = of_two_sizes(4000, 60, 16);
    const std::vector<index_pair> expected = overlapping(boxes);
    grid_search levels("hierarchical_grid", boxes.size());
    grid_search one_level("hierarchical_grid:levels=1", boxes.size());
    const frame_work spent = levels.run(boxes);
    const frame_work spent_on_one = one_level.run(boxes);
    CHECK(spent.pairs == expected);
    CHECK(spent_on_one.pairs == expected);
    CHECK(5 * spent.tests < spent_on_one.tests);
    // Each box is stored once, however large.
    CHECK(spent.copies == boxes.size());
    CHECK(leaves_out(levels.stage(), absence::sort));
    // Of one size, one level serves all.
    const std::vector<box> equal = cubes(4000, {60, 60, 60});
    CHECK(levels.run(equal).tests == one_level.run(equal).tests);
}

TEST_CASE("a hierarchical grid takes no memory for space, and finds what lies far from the origin") {
    std::vector<box> boxes = cubes(500, {20, 20, 20});
    grid_search near("hierarchical_grid", 500);
    CHECK(near.run(boxes).pairs == overlapping(boxes));
    for (std::size_t i = 0; i < 250; ++i) boxes[i] = moved(boxes[i], {-1e6F, 3e6F, 1e6F});
    grid_search far("hierarchical_grid", 500);
    CHECK(far.run(boxes).pairs == overlapping(boxes));
    CHECK(far.grid_bytes() < near.grid_bytes() * 11 / 10);
    // Sizes from the smallest float to the largest: levels end before they are reached.
    boxes[0] = {{0, 0, 0}, {1e-45F, 0, 0}};
    boxes[1] = {{-3e38F, -1, -1}, {3e38F, 1, 1}};
    boxes[2] = cube(3e38F, 0);
    for (const char* partition : {"hierarchical_grid", "hierarchical_grid:levels=2", "hierarchical_grid:levels=32"})
        CHECK(grid_search(partition, 500).run(boxes).pairs == overlapping(boxes));
}

TEST_CASE("a hierarchical grid finds the pairs on all levels as sizes change") {
    std::mt19937 random(1);
    for (const char* partition : {"hierarchical_grid", "hierarchical_grid:levels=1", "hierarchical_grid:levels=4"}) {
        CAPTURE(partition);
        grid_search search(partition, 300);
        for (int frame = 0; frame < 30; ++frame) {
            std::vector<box> boxes(300);
            for (box& b : boxes) b = lattice_box(random, 100, 1 + (1U << random() % (1 + frame % 6)));
            REQUIRE(search.run(boxes).pairs == overlapping(boxes));
        }
    }
}

TEST_CASE("a hierarchical grid rejects sorts and sweeps, which it does not use") {
    for (const auto& [sort, sweep] : {std::pair{"insertion", "one_axis"}, {"std", "simd"}, {"std", "all_axes"}}) {
        const composition c = composed({{strategy_kind::sort, sort},
                                        {strategy_kind::partition, "hierarchical_grid"},
                                        {strategy_kind::sweep, sweep}});
        CHECK(rejection_of(c, stage::global_search) ==
              "hierarchical_grid neither sorts nor sweeps; it can be combined with std and one_axis only");
    }
    CHECK(text_of_global(composed({{strategy_kind::partition, "hierarchical_grid"}})) ==
          "std + hierarchical_grid + one_axis");
}

TEST_CASE("cells keep their lists, so that a frame at rest sorts nothing and motion swaps only within cells") {
    constexpr std::size_t n = 4000;
    std::vector<box> boxes = cubes(n, {40, 80, 80});
    grid_search grid("insertion", "sorted_grid", "one_axis:axis=x", n);
    grid_search whole("insertion", "none", "one_axis:axis=x", n);
    grid.run(boxes);
    whole.run(boxes);
    const frame_work at_rest = grid.run(boxes);
    CHECK(at_rest.comparisons == 0);
    CHECK(at_rest.moves == 0);
    CHECK(at_rest.pairs == overlapping(boxes));
    std::mt19937 random(1);
    for (box& b : boxes) b = moved(b, {static_cast<float>(random() % 64) / 64, 0, 0});
    const frame_work in_cells = grid.run(boxes);
    const frame_work in_all = whole.run(boxes);
    CHECK(in_cells.pairs == in_all.pairs);
    CHECK(in_cells.comparisons > n);
    CHECK(20 * in_cells.moves < in_all.moves);
    CHECK(20 * in_cells.tests < in_all.tests);
}

TEST_CASE("a box that changes its cell moves entries of two cells, and empty cells are used again") {
    constexpr std::size_t n = 1000;
    std::vector<box> boxes = cubes(n, {30, 30, 30});
    grid_search grid("insertion", "sorted_grid:cell_size=4", "one_axis:axis=x", n);
    grid.run(boxes);
    boxes[17] = moved(boxes[17], {0, 4, 0});
    const frame_work spent = grid.run(boxes);
    CHECK(spent.pairs == overlapping(boxes));
    // A cell has about 25 entries; the box lies in up to four.
    CHECK_BETWEEN(0, spent.moves, 150);
    // A swarm that flies on leaves no cells behind.
    const std::size_t before = grid.grid_bytes();
    for (int frame = 0; frame < 300; ++frame) {
        for (box& b : boxes) b = moved(b, {0.5F, 3, -3});
        grid.stage().update(boxes);
    }
    CHECK(found_by(grid.stage(), boxes) == overlapping(boxes));
    CHECK(grid.grid_bytes() < 4 * before);
}

TEST_CASE("automatic cells follow the sizes of boxes, and never copy them too often") {
    constexpr std::size_t n = 1000;
    grid_search grid("sorted_grid", n);
    std::vector<box> boxes = cubes(n, {30, 30, 30});
    grid.run(boxes);
    for (const float scale : {100.0F, 0.01F}) {
        CAPTURE(scale);
        std::vector<box> scaled = boxes;
        for (box& b : scaled)
            for (int k = 0; k < 3; ++k) b.min[k] *= scale, b.max[k] *= scale;
        grid_search anew("sorted_grid", n);
        const frame_work spent = grid.run(scaled);
        CHECK(spent.pairs == overlapping(scaled));
        CHECK(spent.copies == anew.run(scaled).copies);
    }
    // Few boxes that are much longer than the mean, at once and grown later.
    std::vector<box> some_long = boxes;
    for (std::size_t i = 0; i < n; i += 20) some_long[i].max = {1e4F, 1e4F, 1e4F};
    grid_search with_long("sorted_grid", n);
    CHECK(with_long.run(some_long).copies <= 8 * n);
    grid_search grown("sorted_grid", n);
    grown.run(boxes);
    for (std::size_t i = 0; i < n; i += 500) boxes[i].max = {400, 400, 400};
    const frame_work after = grown.run(boxes);
    CHECK(after.copies <= 16 * n);
    CHECK(after.pairs == overlapping(boxes));
}

TEST_CASE("sorted cells find the pairs as boxes cross them, come and go, with any sort and sweep") {
    std::mt19937 random(1);
    for (int scene = 0; scene < 60; ++scene) {
        constexpr std::uint32_t n = 150;
        const char* const sort = std::array{"insertion", "radix", "shell"}[random() % 3];
        const char* const sweep = std::array{"one_axis", "all_axes", "two_axis", "one_axis:axis=z"}[random() % 4];
        const char* const partition =
            std::array{"sorted_grid", "sorted_grid:cell_size=0.5", "sorted_grid:cell_size=7"}[random() % 3];
        CAPTURE(sort, partition, sweep);
        grid_search search(sort, partition, sweep, n);
        std::vector<bool> present(n, true);
        std::vector<box> boxes(n);
        for (int frame = 0; frame < 12; ++frame) {
            const std::uint32_t moving = std::array{0U, 5U, n}[random() % 3];
            const bool flat = random() % 4 == 0;
            for (box& b : boxes) {
                if (frame == 0 || random() % n < moving) b = lattice_box(random, 20 + random() % 40, 12);
                if (flat) b.min[0] = 0, b.max[0] = 30;
            }
            for (std::uint32_t id = 0; id < n && frame > 0; ++id)
                if (random() % 20 == 0) {
                    present[id] ? search.stage().remove(id) : search.stage().insert(id);
                    present[id] = !present[id];
                }
            REQUIRE(search.run(boxes).pairs == overlapping(boxes, present));
        }
        // A box that is invalid, or cells that are too small, leave the next frame exact.
        std::vector<box> inverted = boxes;
        inverted[3].max[0] = inverted[3].min[0] - 1;
        CHECK_THROWS_AS(search.stage().update(inverted), input_error);
        REQUIRE(search.run(boxes).pairs == overlapping(boxes, present));
    }
}

TEST_CASE("a uniform grid over two axes has columns along the swept axis") {
    const std::vector<box> boxes = cubes(2000, {64, 64, 64});
    for (const char* sweep : {"one_axis:axis=x", "one_axis:axis=y", "one_axis:axis=z", "all_axes"}) {
        CAPTURE(sweep);
        grid_search columns("std", "uniform_grid:axes=2,cell_size=4", sweep, boxes.size());
        grid_search cells("std", "uniform_grid:cell_size=4", sweep, boxes.size());
        const frame_work in_columns = columns.run(boxes);
        const frame_work in_cells = cells.run(boxes);
        CHECK(in_columns.pairs == overlapping(boxes));
        CHECK(in_cells.pairs == in_columns.pairs);
        // A box of a quarter of a cell overlaps 1.25 cells per cut axis on average.
        CHECK_BETWEEN(3000, in_columns.copies, 3300);
        CHECK_BETWEEN(3700, in_cells.copies, 4200);
        CHECK(columns.stage().counters()[work::subsets] <= 17 * 17);
    }
}
