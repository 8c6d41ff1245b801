#include <rapidcheck.h>
#include <algorithm>
#include <array>
#include <bit>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_exception.hpp>
#include <cstddef>
#include <cstdint>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "cell_owners.hpp"

import aabb;
import aabb.partition.axial_cut;

using namespace aabb;
using Catch::Matchers::Message;

namespace {

/// The partition of a frame, with the lists that it asked for.
struct fitted {
    fitted(std::vector<box> given, const std::vector<setting>& settings, axis_set swept = every_axis)
        : boxes(std::move(given)), partition(configured<axial_cut_partition>(settings)) {
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::uint32_t id = 0; id < boxes.size(); ++id)
                lists[k].push_back({boxes[id].min[static_cast<int>(k)], id});
            std::ranges::sort(lists[k], precedes);
        }
        membership objects;
        for (std::uint32_t id = 0; id < boxes.size(); ++id) objects.insert(id);
        cut = partition.axes(boxes, objects, swept);
        partition.fit({boxes, {lists[0], lists[1], lists[2]}});
    }

    /// Subsets of a box, with the axes that each owns.
    [[nodiscard]] std::map<std::uint32_t, axis_set> subsets_of(std::uint32_t id) const {
        return subsets_in(partition, boxes, id);
    }

    std::vector<box> boxes;
    std::array<std::vector<projection>, 3> lists;
    axial_cut_partition partition;
    axis_set cut = 0;
};

/// Intervals on the x axis.
std::vector<box> line_of(const std::vector<std::pair<float, float>>& intervals) {
    std::vector<box> boxes;
    for (const auto& [lower, upper] : intervals) boxes.push_back({{lower, 0, 0}, {upper, 1, 1}});
    return boxes;
}

std::vector<box> row_of_points(int n) {
    std::vector<std::pair<float, float>> points;
    for (int i = 0; i < n; ++i) points.emplace_back(static_cast<float>(i), static_cast<float>(i));
    return line_of(points);
}

}  // namespace

TEST_CASE("segments hold the same number of projections") {
    const fitted f(row_of_points(1000), {{"axes", "1"}, {"segments", "8"}});
    CHECK(f.cut == 0b001);
    CHECK(f.partition.subset_count() == 8);
    std::map<std::uint32_t, int> members;
    for (std::uint32_t id = 0; id < 1000; ++id)
        for (const auto& [subset, owned] : f.subsets_of(id)) ++members[subset];
    for (const auto& [subset, count] : members) CHECK(count == 125);
}

TEST_CASE("one wide box costs the cuts within it, not those elsewhere") {
    std::vector<box> boxes = row_of_points(2560);
    boxes[1005].max[0] = 1261;  // a tenth of the axis
    const fitted limited(boxes, {{"axes", "1"}, {"segments", "256"}});
    CHECK(limited.partition.segments().wanted == 256);
    // Of 25 cuts wanted beyond the one that may lie in the box, one is put behind it.
    CHECK(limited.partition.segments().got == 232);
    CHECK(limited.subsets_of(1005).size() == 2);
    const fitted unlimited(boxes, {{"axes", "1"}, {"segments", "256"}, {"limit", "off"}});
    CHECK(unlimited.partition.segments().got == 256);
    CHECK(unlimited.subsets_of(1005).size() == 27);
}

TEST_CASE("boxes are classified half-open at the cuts, and closed boxes that touch a cut reach over it") {
    // Two segments wanted of four intervals: the cut is the third lower end, 2.
    const fitted f(line_of({{0, 1}, {1, 2}, {2, 3}, {3, 4}}), {{"axes", "1"}, {"segments", "2"}});
    CHECK(f.subsets_of(0) == std::map<std::uint32_t, axis_set>{{0, 0b111}});
    CHECK(f.subsets_of(1) == std::map<std::uint32_t, axis_set>{{0, 0b111}, {1, 0b110}});
    CHECK(f.subsets_of(2) == std::map<std::uint32_t, axis_set>{{1, 0b111}});
}

TEST_CASE("no box is cut more than once on an axis, and overlapping boxes have one subset that owns them") {
    REQUIRE(rc::check([] {
        std::vector<box> boxes(*rc::gen::inRange<std::size_t>(0, 40));
        for (box& b : boxes) b = any_box_among_planes();
        const std::string axes = *rc::gen::element<std::string>("auto", "1", "2", "3");
        const std::string limit = *rc::gen::element<std::string>("on", "off");
        const std::string segments = *rc::gen::element<std::string>("auto", "1", "2", "3", "9", "60");
        const fitted f(boxes, {{"axes", axes}, {"segments", segments}, {"limit", limit}});
        const std::size_t most = std::size_t{1} << (axes == "auto" ? 3 : std::stoul(axes));
        for (std::uint32_t a = 0; a < boxes.size(); ++a) {
            const auto subsets = f.subsets_of(a);
            RC_ASSERT(!subsets.empty() && subsets.rbegin()->first < f.partition.subset_count());
            RC_ASSERT(subsets.size() == f.partition.copies(a, boxes[a]));
            if (limit == "on") RC_ASSERT(subsets.size() <= most);
            for (std::uint32_t b = a + 1; b < boxes.size(); ++b) {
                if (!overlaps(boxes[a], boxes[b])) continue;
                int owners = 0;
                for (const auto& [subset, owned] : f.subsets_of(b))
                    owners += subsets.contains(subset) && partition_subset::owns(subsets.at(subset), owned);
                RC_ASSERT(owners == 1);
            }
        }
    }));
}

TEST_CASE("the axes on which centres vary most are cut, the one a sweep sorts along last, flat ones never") {
    std::vector<box> boxes;
    for (std::uint32_t i = 0; i < 64; ++i) {
        const auto x = static_cast<float>(i * 37 % 64);
        boxes.push_back({{x, 4 * x, 7}, {x + 1, 4 * x + 1, 8}});
    }
    CHECK(fitted(boxes, {{"axes", "1"}, {"segments", "4"}}).cut == 0b010);
    CHECK(fitted(boxes, {{"axes", "1"}, {"segments", "4"}}, 0b010).cut == 0b001);
    CHECK(fitted(boxes, {{"axes", "2"}, {"segments", "4"}}, 0b010).cut == 0b011);
    CHECK(fitted(boxes, {{"axes", "3"}, {"segments", "4"}}).cut == 0b011);
    CHECK(fitted(row_of_points(64), {{"axes", "1"}, {"segments", "4"}}, 0b001).cut == 0b001);
    CHECK(fitted(std::vector<box>(9, boxes[0]), {{"axes", "3"}, {"segments", "4"}}).partition.subset_count() == 1);
}

TEST_CASE("auto cuts a large scene finer than a small one, and says how much it wanted") {
    const auto segments = [](int side) {
        std::vector<box> boxes;
        for (int i = 0; i < side * side; ++i) {
            const int row = i / side;
            const auto x = static_cast<float>(2 * (i % side));
            const auto y = static_cast<float>(2 * row);
            boxes.push_back({{x, y, 0}, {x + 1, y + 1, 1}});
        }
        return fitted(boxes, {}).partition.segments();
    };
    CHECK(segments(60).got > segments(12).got);
    CHECK(segments(60).wanted >= segments(60).got);
}

TEST_CASE(
    "auto cuts as many axes as pay: none of a small scene, more of a large one, all where all are sorted anyway") {
    const auto cut_of = [](std::uint32_t n, std::vector<setting> settings, axis_set swept) {
        std::vector<box> boxes;
        for (std::uint32_t i = 0; i < n; ++i) {
            const vec3f at{static_cast<float>(i * 37 % 101), static_cast<float>(i * 53 % 97),
                           static_cast<float>(i * 29 % 89)};
            boxes.push_back({at, at + vec3f{2, 2, 2}});
        }
        settings.push_back({"axes", "auto"});
        return std::popcount(fitted(boxes, settings, swept).cut);
    };
    CHECK(cut_of(100, {}, 0b001) == 0);
    CHECK(cut_of(3000, {}, 0b001) == 1);
    CHECK(cut_of(20'000, {}, 0b001) == 2);
    CHECK(cut_of(3000, {}, 0b111) > 1);
    // Whoever says how fine wants a cut.
    CHECK(cut_of(100, {{"segments", "4"}}, 0b001) > 0);
}

TEST_CASE("auto keeps to the axes that it cuts until others cost a tenth less") {
    std::vector<box> boxes;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const vec3f at{static_cast<float>(i * 37 % 101), static_cast<float>(i * 53 % 97),
                       static_cast<float>(i * 29 % 89)};
        boxes.push_back({at, at + vec3f{2, 2, 2}});
    }
    membership objects;
    for (std::uint32_t id = 0; id < boxes.size(); ++id) objects.insert(id);
    const auto numbers_of_axes = [&](const std::vector<float>& extents) {
        axial_cut_partition partition(configured<axial_cut_partition>(std::vector<setting>{{"axes", "auto"}}));
        std::vector<int> found;
        for (const float extent : extents) {
            for (box& b : boxes) b.max = b.min + vec3f{extent, extent, extent};
            found.push_back(std::popcount(partition.axes(boxes, objects, axis_set{0b001})));
        }
        return found;
    };
    CHECK(numbers_of_axes({1, 2.5F, 8, 2.5F}) == std::vector{1, 1, 2, 2});
}

TEST_CASE("the more segments are wanted, the more there are, up to the limit") {
    REQUIRE(rc::check([] {
        std::vector<box> boxes(*rc::gen::inRange<std::size_t>(1, 200));
        for (box& b : boxes) b = any_box_among_planes();
        std::uint64_t got = 0;
        for (const char* wanted : {"2", "8", "64", "65535"}) {
            const segment_counts counts = fitted(boxes, {{"axes", "1"}, {"segments", wanted}}).partition.segments();
            // Cuts at other places may be in each other's way, but not many.
            RC_ASSERT(counts.got + 2 >= got);
            got = counts.got;
        }
    }));
}

TEST_CASE("more subsets than a machine can hold are refused") {
    std::vector<box> boxes;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const vec3f p{static_cast<float>(i), static_cast<float>(i * 7 % 3000), static_cast<float>(i * 11 % 3000)};
        boxes.push_back({p, p});
    }
    CHECK_THROWS_MATCHES(fitted(boxes, {{"axes", "3"}, {"segments", "3000"}}), input_error,
                         Message("axial_cut: 3000 segments an axis make 27000000000 subsets, more than 2^26"));
}
