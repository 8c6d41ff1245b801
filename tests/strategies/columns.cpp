#include <rapidcheck.h>

#include "searches.hpp"

import aabb.columns.groups;
import aabb.columns;
import aabb.strategies;

using namespace aabb;

namespace {

std::vector<box> random_boxes(std::size_t n, double world, double size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(0, world);
    std::vector<box> boxes(n);
    for (box& b : boxes)
        for (int k = 0; k < 3; ++k) {
            const double at = place(random);
            b.min[k] = static_cast<float>(at);
            b.max[k] = static_cast<float>(at + size * (random() % 8 == 0 ? 3 : 1));
        }
    return boxes;
}

/// By sweeping a single sorted list.
std::vector<index_pair> true_pairs(const std::vector<box>& boxes) {
    return found_by(*search_of(composed({{strategy_kind::sort, "std"}}), boxes.size()), boxes);
}

composition columns_with(const std::string& settings) {
    return composed({{strategy_kind::partition, ("columns" + settings).c_str()}});
}

struct search_by_columns : global_search<bucket_sort, columns_partition, simd_sweep, work_counters> {
    explicit search_by_columns(std::size_t objects, const columns_partition::config& config = {})
        : global_search({}, columns_partition(config), {}) {
        ::insert_all(*this, objects);
    }
};

/// The box tests of a frame, whose pairs must be exact.
std::uint64_t tests_of(search_by_columns& search, const std::vector<box>& boxes,
                       const std::vector<index_pair>& expected) {
    const std::uint64_t before = search.counters()[work::box_tests];
    CHECK(found_by(search, boxes) == expected);
    return search.counters()[work::box_tests] - before;
}

/// Sets of axes on which a frame is flat.
constexpr std::array<unsigned, 7> flat_axes{0, 0b001, 0b010, 0b100, 0b011, 0b101, 0b110};

std::vector<box> flattened(std::vector<box> boxes, unsigned axes) {
    for (box& b : boxes)
        for (int k = 0; k < 3; ++k)
            if (axes >> k & 1U) b.min[k] = -1, b.max[k] = 1;
    return boxes;
}

/// The side of a world in which n boxes of edge 1 have a few neighbours each.
double side_of(std::size_t n) {
    return 2 * std::cbrt(static_cast<double>(n));
}

/// Boxes that are spread evenly over clumps with the given corners; the further away, the larger, so that floats can
/// distinguish them.
template <class Corner>
std::vector<box> clumps_of(std::size_t n, std::size_t clumps, Corner corner) {
    std::vector<box> boxes = random_boxes(n, side_of(n / clumps), 1, 7);
    for (std::size_t i = 0; i < n; ++i) {
        double away = 0;
        for (int k = 0; k < 3; ++k) away = std::max(away, std::abs(corner(i % clumps, k)));
        const double scale = std::max(1.0, away / 1e6);
        for (int k = 0; k < 3; ++k) {
            boxes[i].min[k] = static_cast<float>(corner(i % clumps, k) + scale * double{boxes[i].min[k]});
            boxes[i].max[k] = static_cast<float>(corner(i % clumps, k) + scale * double{boxes[i].max[k]});
        }
    }
    return boxes;
}

/// The work per box of a frame, whose pairs must be exact.
double work_per_box(const std::vector<box>& boxes) {
    search_by_columns search(boxes.size());
    CHECK(found_by(search, boxes) == true_pairs(boxes));
    std::uint64_t sum = 0;
    for (const work what : {work::box_tests, work::moves, work::comparisons, work::subset_copies})
        sum += search.counters()[what];
    return static_cast<double>(sum) / static_cast<double>(boxes.size());
}

}  // namespace

TEST_CASE("groups of any size find the same pairs, in the same order on any number of threads") {
    const std::vector<box> boxes = random_boxes(20'000, 27, 0.7, 1);
    const std::vector<index_pair> expected = true_pairs(boxes);
    const std::vector<box> elsewhere = random_boxes(20'000, 27, 0.7, 2);
    REQUIRE(expected.size() > 20'000);
    for (const std::string group : {"auto", "1", "17", "400", "3000"}) {
        std::vector<index_pair> first;
        for (const std::string threads : {"1", "2", "3", "7", "256"}) {
            if (threads == "256" && group != "400") continue;
            INFO("group=" << group << ", threads=" << threads);
            const auto search = search_of(columns_with(":group=" + group + ",threads=" + threads), boxes.size());
            std::vector<index_pair> pairs;
            for (const std::vector<box>& frame : {boxes, elsewhere, boxes}) {
                pairs.clear();
                search->update(frame);
                search->search(pairs);
            }
            if (first.empty()) first = pairs;
            CHECK(pairs == first);
            CHECK(sorted(pairs) == expected);
        }
    }
}

TEST_CASE("many pairs per box are exact where different ends have the same code") {
    REQUIRE(rc::check([] {
        const std::size_t n = *rc::gen::inRange<std::size_t>(100, 700);
        std::mt19937 random(*rc::gen::arbitrary<unsigned>());
        // Ends lie within half a code, 2^-16 of the world, around five planes: many boxes are apart by less than that.
        const auto end_near = [&](std::uint32_t plane) {
            return std::ldexp(static_cast<float>(plane << 18) + static_cast<float>(random() % 16) - 8, -20);
        };
        std::vector<box> boxes(n);
        for (box& b : boxes)
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t first = random() % 5, last = std::min<std::uint32_t>(first + random() % 4, 4);
                b.min[k] = end_near(first);
                b.max[k] = std::max(b.min[k], end_near(last));
            }
        const auto search = search_of(columns_with(*rc::gen::element<std::string>("", ":group=60", ":few=0")), n);
        RC_ASSERT(found_by(*search, boxes) == overlapping(boxes));
    }));
}

TEST_CASE("boxes that exceed one group are divided into groups") {
    const std::vector<box> boxes = random_boxes(50'000, 80, 1, 2);
    CHECK(found_by(*search_of(columns_with(""), boxes.size()), boxes) == true_pairs(boxes));
}

TEST_CASE("share_of_update is the share of a search that cuts and sorts groups") {
    for (const auto& [boxes, in_groups] : {std::pair{20'000, false}, std::pair{50'000, true}})
        for (const char* prepare : {"none", "split_large"}) {
            INFO(boxes << " boxes, prepare=" << prepare);
            const auto search = global_of(composed({{strategy_kind::prepare, prepare}}));
            const auto n = static_cast<std::uint32_t>(boxes);
            insert_all(*search, n);
            const std::vector<box> frame = random_boxes(n, side_of(n), 1, 2);
            found_by(*search, frame);
            CHECK((search->share_of_update() > 0) == in_groups);
            CHECK(search->share_of_update() < 1);
            // Pairs that are kept from the previous frame have no such share.
            for (int again = 0; again < 2; ++again) found_by(*search, frame);
            CHECK(search->share_of_update() == 0);
        }
}

TEST_CASE("boxes up to the brute-force threshold are not cut, as objects come and go") {
    const std::vector<box> boxes = random_boxes(40, 3, 0.7, 3);
    const std::vector<index_pair> all_pairs = true_pairs(boxes);
    const auto search = global_of(columns_with(":few=20"), instrumentation::counters);
    std::vector<bool> present(boxes.size());
    // Numbers of boxes in the frames; the lowest ids are absent.
    for (const std::size_t n : {std::size_t{3}, std::size_t{20}, std::size_t{21}, std::size_t{40}, std::size_t{20},
                                std::size_t{17}, std::size_t{33}, std::size_t{0}, std::size_t{1}}) {
        INFO(n << " boxes");
        for (std::uint32_t id = 0; id < boxes.size(); ++id) {
            const bool is_present = id >= boxes.size() - n;
            if (is_present != present[id]) is_present ? search->insert(id) : search->remove(id);
            present[id] = is_present;
        }
        std::vector<index_pair> expected = all_pairs;
        std::erase_if(expected, [&](index_pair p) { return !present[p.a] || !present[p.b]; });
        const work_counters before = search->counters();
        CHECK(found_by(*search, boxes) == expected);
        const work_counters after = search->counters();
        CHECK((after[work::subsets] > before[work::subsets]) == (n > 20));
        CHECK((after[work::moves] > before[work::moves]) == (n > 20));
        for (const absence what : {absence::partition, absence::sort}) CHECK(leaves_out(*search, what) == (n <= 20));
    }
}

TEST_CASE("columns are planned again once boxes have moved") {
    const std::vector<box> heap = random_boxes(3000, 14, 1, 1);
    for (const double wide : {1.6, 4.0, 0.4})
        for (const float shift : {0.0F, 500.0F}) {
            std::vector<box> later = random_boxes(3000, 14 * wide, 1, 1);
            for (box& b : later) b = moved(b, {shift, 0, 0});
            search_by_columns fresh(heap.size());
            search_by_columns reused(heap.size());
            found_by(reused, heap);
            INFO(wide << " times as wide, " << shift << " away");
            const std::vector<index_pair> expected = true_pairs(later);
            CHECK(tests_of(reused, later, expected) == tests_of(fresh, later, expected));
        }
}

TEST_CASE("a few distant boxes hardly widen a plan") {
    std::vector<box> boxes = random_boxes(12'800, 50, 1, 9);
    for (std::size_t i = 0; i < boxes.size(); i += 200) boxes[i] = moved(boxes[i], {1e6F, 1e6F, 1e6F});
    const column_plan plan = columns_partition().plan(boxes, everywhere);
    for (int k = 0; k < 3; ++k) {
        // One in 200 is distant; one in 64 is left out at either end, not one in 8.
        CHECK(plan.origin[k] < 3);
        CHECK(65'536 / plan.scale[k] > 46);
        CHECK(65'536 / plan.scale[k] < 53);
    }
}

TEST_CASE("groups are proportional to the columns, and cut along them if columns are too few") {
    const auto groups = [](int axis, std::uint32_t u, std::uint32_t v, std::uint32_t along, double count) {
        column_plan plan;
        plan.axis = axis;
        plan.across = {u, v};
        plan.most_along = along;
        plan.groups = count;
        return column_groups::group_grid(plan);
    };
    const auto on_axis = [](const column_plan& plan, int axis) {
        for (std::size_t i = 0; i < 2; ++i)
            if (plan.axis_across(i) == axis) return plan.across[i];
        return 1U;
    };
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        const column_plan cube = groups(axis, 40, 40, 100, 100);
        CHECK(cube.axis == axis);
        CHECK(on_axis(cube, u) == 10);
        CHECK(on_axis(cube, v) == 10);
        const column_plan plane = groups(axis, 1, 100, 100, 20);
        CHECK(plane.axis == axis);
        CHECK(on_axis(plane, v) == 20);
        const column_plan line = groups(axis, 1, 1, 1000, 20);
        CHECK(on_axis(line, axis) == 20);
        CHECK(line.columns() == 20);
        for (const bool swapped : {false, true}) {
            const column_plan rod = swapped ? groups(axis, 3, 2, 1000, 60) : groups(axis, 2, 3, 1000, 60);
            CHECK(on_axis(rod, axis) == 20);
            CHECK(on_axis(rod, swapped ? u : v) == 3);
            CHECK(rod.columns() == 60);
        }
        CHECK(groups(axis, 4, 4, 3, 1000).columns() == 16);      // no room along
        CHECK(on_axis(groups(axis, 1, 1, 7, 1000), axis) == 7);  // boxes as long as columns
    }
}

TEST_CASE("boxes on a line or in a plane are divided into groups, along any axis") {
    for (const unsigned axes : std::span(flat_axes).subspan(1)) {
        INFO("flat on axes " << axes);
        const std::vector<box> boxes = flattened(random_boxes(3000, 500, 1, 8), axes);
        search_by_columns search(boxes.size(), {.group = 200});
        CHECK(found_by(search, boxes) == true_pairs(boxes));
        CHECK(search.counters()[work::subsets] >= 10);
        CHECK(search.counters()[work::subset_copies] < 2 * boxes.size());
    }
}

TEST_CASE("a frame unlike the planned one costs little more than with its own plan") {
    const std::size_t n = 12'000;
    const std::vector<box> cubes = random_boxes(n, 50, 1, 3);
    const auto changed = [&](auto change) {
        std::vector<box> boxes = cubes;
        for (std::size_t i = 0; i < n; ++i) change(boxes[i], i);
        return boxes;
    };
    const std::vector<std::pair<const char*, std::vector<box>>> scenes{
        {"as planned for", cubes},
        {"far away", changed([](box& b, std::size_t) { b = moved(b, {200, 200, 200}); })},
        {"within a single column", changed([](box& b, std::size_t) {
             for (int k = 0; k < 3; ++k) b.min[k] /= 32, b.max[k] /= 32;
         })},
        {"plates", changed([](box& b, std::size_t) { b.max[0] += 20, b.max[1] += 20; })},
        {"needles", changed([](box& b, std::size_t i) { b.max[static_cast<int>(i % 3)] += 25; })},
        {"half of them in a corner", changed([](box& b, std::size_t i) {
             if (i % 2 == 0)
                 for (int k = 0; k < 3; ++k) b.min[k] = 60 + b.min[k] / 4, b.max[k] = 60 + b.max[k] / 4;
         })},
        {"flat", changed([](box& b, std::size_t) { b.min[1] = 0, b.max[1] = 1; })}};
    for (const auto& [name, boxes] : scenes) {
        const std::vector<index_pair> expected = true_pairs(boxes);
        for (const std::uint32_t group : {100'000U, 1'500U}) {
            INFO(name << ", groups of " << group);
            search_by_columns fresh(n, {.group = group});
            search_by_columns stale(n, {.group = group});
            for (int frame = 0; frame < 3; ++frame) found_by(stale, cubes);
            CHECK(tests_of(stale, boxes, expected) < 3 * tests_of(fresh, boxes, expected) + 100 * n);
        }
    }
}

TEST_CASE("a few outliers do not spoil the columns of the other boxes") {
    const std::size_t n = 12'000;
    const std::vector<box> cubes = random_boxes(n, 50, 1, 5);
    const auto tests_with = [&](std::size_t every, float distance) {
        const auto shift = [&](std::size_t i) { return distance * std::sin(static_cast<float>(i)); };
        std::vector<box> boxes = cubes;
        for (std::size_t i = 0; i < n; i += every) boxes[i] = moved(boxes[i], {shift(i), shift(i + 7), shift(i + 14)});
        search_by_columns search(n);
        return tests_of(search, boxes, true_pairs(boxes));
    };
    const std::uint64_t baseline = tests_with(n, 0);
    CHECK(tests_with(n, 1e6F) < 3 * baseline);
    CHECK(tests_with(1000, 1e6F) < 3 * baseline);
    CHECK(tests_with(100, 1e5F) < 3 * baseline);
    CHECK(tests_with(12, 1e5F) < 20 * baseline);
}

TEST_CASE("clumps cost about as much as evenly spread boxes, at any spacing") {
    for (const std::size_t n : {std::size_t{600}, std::size_t{4000}}) {
        const double even = work_per_box(random_boxes(n, side_of(n), 1, 1));
        for (const std::size_t clumps : {2, 8, 30})
            for (const double gap : {1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e9, 1e15, 1e30}) {
                INFO(n << " boxes in " << clumps << " clumps, " << gap << " apart");
                CHECK(work_per_box(clumps_of(n, clumps, [&](std::size_t c, int k) {
                          return gap * std::sin(static_cast<double>(1 + 3 * c + static_cast<std::size_t>(k)));
                      })) < 6 * even);
            }
    }
}

TEST_CASE("nested clumps, distant boxes and boxes at the limits of float cost little more") {
    const std::size_t n = 4000;
    const double even = work_per_box(random_boxes(n, side_of(n), 1, 1));
    for (const double gap : {1e2, 1e4, 1e6}) {
        INFO(gap);
        CHECK(work_per_box(clumps_of(n, 64, [&](std::size_t c, int k) {
                  return gap * (gap * static_cast<double>(c / 8 >> k & 1) + static_cast<double>(c % 8 >> k & 1));
              })) < 6 * even);
        for (const int axis : {0, 1, 2})
            CHECK(work_per_box(clumps_of(n, 2, [&](std::size_t c, int k) {
                      return k == axis ? -gap * static_cast<double>(c) : 0.0;
                  })) < 6 * even);
    }
    // A clump within an evenly filled world.
    std::vector<box> core = random_boxes(n, 1e5, 1, 2);
    std::ranges::copy(random_boxes(n / 2, side_of(n / 2), 1, 3), core.begin());
    CHECK(work_per_box(core) < 6 * even);
    for (const std::size_t every : {2, 3, 5, 10, 100, 1000}) {
        INFO("one in " << every << " at the limits of float");
        std::vector<box> boxes = random_boxes(n, side_of(n), 1, 4);
        for (std::size_t i = 0; i < n; i += every) {
            const auto k = static_cast<int>(i / every % 3);
            const float limit = std::numeric_limits<float>::max() / 2 * (i / every % 2 == 0 ? 1.0F : -1.0F);
            boxes[i].min[k] = boxes[i].max[k] = limit;
        }
        CHECK(work_per_box(boxes) < 6 * even);
    }
}

TEST_CASE("nested groups end where boxes coincide") {
    for (const std::size_t places : {1, 2, 3, 50}) {
        INFO(places);
        const std::size_t n = 1500;
        std::vector<box> boxes(n);
        for (std::size_t i = 0; i < n; ++i)
            for (int k = 0; k < 3; ++k) boxes[i].min[k] = boxes[i].max[k] = 1e6F * static_cast<float>(i % places);
        // Boxes in the same place are all tested, a vector at a time; finding the groups takes some tests too.
        CHECK(work_per_box(boxes) < 2.0 * static_cast<double>(n) / static_cast<double>(places) + 200);
    }
}

TEST_CASE("nested groups are the same on any number of threads, and follow moving boxes") {
    const std::vector<box> even = random_boxes(3000, side_of(3000), 1, 5);
    const auto scattered = [](double spacing) {
        return clumps_of(3000, 12, [=](std::size_t c, int k) {
            const std::size_t group = c / 6;
            return spacing * static_cast<double>((7 * c + 3 * static_cast<std::size_t>(k)) % 11) +
                   spacing / 1e3 * static_cast<double>(group);
        });
    };
    const std::vector<std::vector<box>> frames{even, scattered(1e5), scattered(1.001e5), scattered(1e2), even, even};
    std::vector<std::vector<index_pair>> first;
    for (const std::uint32_t threads : {1U, 2U, 5U}) {
        INFO(threads << " threads");
        search_by_columns search(even.size(), {.threads = threads});
        std::vector<std::vector<index_pair>> pairs(frames.size());
        for (std::size_t f = 0; f < frames.size(); ++f) {
            search.update(frames[f]);
            search.search(pairs[f]);
            CHECK(search.own().is_in_groups() == (f == 1 || f == 2));
        }
        if (first.empty()) first = pairs;
        CHECK(pairs == first);
        for (std::size_t f = 0; f < frames.size(); ++f) CHECK(sorted(pairs[f]) == true_pairs(frames[f]));
    }
}

TEST_CASE("evenly spread boxes are in no groups, in one, two or three dimensions") {
    for (const std::size_t n : {std::size_t{100}, std::size_t{500}, std::size_t{5000}, std::size_t{40'000}})
        for (const double world : {1.0, 2.0, 4.0, 16.0, 1e3})
            for (const unsigned axes : flat_axes) {
                INFO(n << " boxes in " << world << " times the world, flat on axes " << axes);
                const std::vector<box> boxes = flattened(random_boxes(n, world * side_of(n), 1, 8), axes);
                CHECK(columns_partition().plan(boxes, everywhere).groups == 1);
            }
}

TEST_CASE("an invalid box is rejected at any index, and the next frame is complete") {
    const std::vector<box> boxes = random_boxes(3000, 20, 0.7, 6);
    const std::vector<index_pair> expected = true_pairs(boxes);
    constexpr float infinity = std::numeric_limits<float>::infinity();
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    for (const std::uint32_t group : {100'000U, 200U}) {
        search_by_columns search(boxes.size(), {.group = group});
        for (const std::size_t id : {0UL, 1234UL, 2999UL})
            for (int k = 0; k < 3; ++k)
                for (const float value : {-infinity, infinity, nan, -1e30F, 1e30F})
                    for (const bool upper : {false, true}) {
                        std::vector<box> bad = boxes;
                        (upper ? bad[id].max : bad[id].min)[k] = value;
                        if (is_valid(bad[id])) continue;
                        CHECK_THROWS_AS(search.update(bad), input_error);
                        CHECK(found_by(search, boxes) == expected);
                    }
    }
}

TEST_CASE("quantized coordinates are monotone, and equal in scalar and vector code") {
    REQUIRE(rc::check([] {
        const auto any_float = [] {
            const auto mantissa = static_cast<float>(*rc::gen::inRange(-1000, 1001));
            return std::ldexp(mantissa, *rc::gen::element(-149, -120, -10, 0, 10, 117));
        };
        box bounds;
        for (int k = 0; k < 3; ++k) {
            const float a = any_float();
            const float b = any_float();
            bounds.min[k] = std::min(a, b);
            bounds.max[k] = std::max(a, b);
        }
        column_plan plan;
        plan.fit(bounds);
        std::vector<float> coordinates{bounds.min[0], bounds.max[0]};
        for (int i = 0; i < 30; ++i) coordinates.push_back(any_float());
        std::ranges::sort(coordinates);
        std::uint32_t previous = 0;
        for (const float x : coordinates) {
            const std::uint32_t code = plan.quantized(x, 0);
            RC_ASSERT(code >= previous);
            RC_ASSERT(code <= 65'535U);
            RC_ASSERT(plan.quantized(simd::broadcast(x), 0)[0] == code);
            previous = code;
        }
    }));
}

TEST_CASE("columns can be combined with the simd sweep only") {
    composition c = columns_with("");
    c[strategy_kind::sweep] = parse_strategy("one_axis");
    CHECK(rejection_of(c, stage::global_search) ==
          "columns passes boxes in whole vectors, bucket by bucket; it can be combined with simd only");
}
