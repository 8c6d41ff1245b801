// Segment trees, alone and where columns hand over to them: boxes for which sweeps and grids take quadratic time.

#include "searches.hpp"

using namespace aabb;

namespace {

/// Rods through the whole world along every axis. Those of two directions share an axis across both, on which they
/// begin at multiples of 6, or 3 beyond these: so they do not meet.
std::vector<box> rods(std::uint32_t n) {
    std::mt19937 random(1);
    const std::uint32_t places = n / 6 + 1;
    std::vector<box> boxes(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        const int along = static_cast<int>(i % 3);
        for (int k = 0; k < 3; ++k) {
            const auto at = static_cast<float>(6 * (random() % places) + (k == (along + 1) % 3 ? 0 : 3));
            boxes[i].min[k] = k == along ? 0 : at;
            boxes[i].max[k] = k == along ? 6 * static_cast<float>(places) : at + 1;
        }
    }
    return boxes;
}

/// The six sides of cubes within cubes, without thickness; they end before the edges, so that none touch.
std::vector<box> shells(std::uint32_t n) {
    std::vector<box> boxes(n);
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t cube_number = i / 6;
        const float radius = 2 * static_cast<float>(cube_number) + 2;
        boxes[i] = {{1 - radius, 1 - radius, 1 - radius}, {radius - 1, radius - 1, radius - 1}};
        const int across = static_cast<int>(i % 3);
        boxes[i].min[across] = boxes[i].max[across] = i % 6 < 3 ? -radius : radius;
    }
    return boxes;
}

/// They lie apart on y alone; on z they vary more, and each overlaps half of the others.
std::vector<box> plates(std::uint32_t n) {
    std::vector<box> boxes;
    for (std::uint32_t i = 0; i < n; ++i) {
        const auto at = static_cast<float>(i);
        boxes.push_back({{-at, at, 2 * at}, {at, at + 0.5F, 2 * at + static_cast<float>(n)}});
    }
    return boxes;
}

/// All begin at one place, so that no coordinate divides them; some end there too.
std::vector<box> one_place(std::uint32_t n) {
    std::vector<box> boxes;
    for (std::uint32_t i = 0; i < n; ++i)
        boxes.push_back({{0, 0, 0}, {static_cast<float>(i % 2), static_cast<float>(i % 3), 0}});
    return boxes;
}

using construction = std::vector<box> (*)(std::uint32_t);

struct work_of_search {
    double tests_in_vain, copies;
    std::vector<index_pair> pairs;
};

work_of_search work_on(const std::vector<box>& boxes, const composition& c) {
    const std::unique_ptr<global_stage> search = search_of(c, boxes.size());
    std::vector<index_pair> pairs = found_by(*search, boxes);
    const work_counters spent = search->counters();
    return {static_cast<double>(spent[work::box_tests]) - static_cast<double>(pairs.size()),
            static_cast<double>(spent[work::subset_copies]), std::move(pairs)};
}

const composition segment_tree = composed({{strategy_kind::sweep, "segment_tree"}});

}  // namespace

TEST_CASE("segment trees find the pairs of boxes for which sweeps and grids take long") {
    for (const construction construct : {rods, shells, plates, one_place})
        for (const std::uint32_t n : {0U, 1U, 2U, 7U, 300U, 1000U}) {
            CAPTURE(n);
            const std::vector<box> boxes = construct(n);
            CHECK(work_on(boxes, segment_tree).pairs == overlapping(boxes));
        }
}

TEST_CASE("work of segment trees grows like n log n where that of a sweep grows like its square") {
    for (const construction construct : {rods, shells, plates}) {
        const auto work_for = [&](std::uint32_t n, const char* sweep) {
            const work_of_search w = work_on(construct(n), composed({{strategy_kind::sweep, sweep}}));
            return std::pair{w.tests_in_vain / (n * std::log2(n)), w.copies / n};
        };
        const auto [tests, copies] = work_for(1000, "segment_tree");
        const auto [tests_of_more, copies_of_more] = work_for(16'000, "segment_tree");
        CHECK(tests_of_more <= 2 * tests);
        CHECK(copies_of_more <= 4 * copies);  // 16 times the boxes have 1.4 times the levels on each of two axes
        CHECK(work_for(16'000, "one_axis").first > 8 * work_for(1000, "one_axis").first);
    }
}

TEST_CASE("columns hand over to segment trees where their sweeps take long, also in groups") {
    // Two sets of shells, a group each, and rods through both, which all meet.
    constexpr std::uint32_t half = 100'000, all_rods = 50;
    std::vector<box> boxes = shells(half);
    for (const box& b : shells(half)) boxes.push_back(moved(b, {200'000, 0, 0}));
    for (std::uint32_t i = 0; i < all_rods; ++i)
        boxes.push_back({{0, static_cast<float>(i), 0}, {200'000, all_rods, 1}});
    // Shells meet none of each other.
    std::vector<index_pair> pairs;
    for (std::uint32_t b = 2 * half; b < boxes.size(); ++b)
        for (std::uint32_t a = 0; a < b; ++a)
            if (overlaps(boxes[a], boxes[b])) pairs.push_back({a, b});
    pairs = sorted(pairs);
    const auto search = search_of(composed({{strategy_kind::partition, "columns:group=100000"}}), boxes.size());
    CHECK(found_by(*search, boxes) == pairs);
    const std::uint64_t tests = search->counters()[work::box_tests];
    boxes[0] = moved(boxes[0], {0.25F, 0, 0});  // the next frame begins with the trees
    CHECK(found_by(*search, boxes) == pairs);
    CHECK(search->counters()[work::box_tests] - tests < tests / 4);
}
