// The subsets that a cutting partition makes of a frame, and which of them owns a pair.

#include <rapidcheck.h>

#include "searches.hpp"

import aabb.strategies;

using namespace aabb;

namespace {

/// A partition that is fitted to frames, with the lists that it needs.
template <class Partition>
struct fitted {
    explicit fitted(const std::vector<setting>& settings = {}) : partition(configured<Partition>(settings)) {}
    fitted(std::vector<box> frame, const std::vector<setting>& settings, axis_set swept = every_axis)
        : fitted(settings) {
        fit(std::move(frame), swept);
    }

    void fit(std::vector<box> frame, axis_set swept = every_axis) {
        boxes = std::move(frame);
        for (auto id = static_cast<std::uint32_t>(objects.size()); id < boxes.size(); ++id) objects.insert(id);
        objects.settle();
        cut = partition.axes(boxes, objects, swept);
        std::array<std::vector<projection>, 3> lists;
        for (std::size_t k = 0; k < 3; ++k) {
            for (std::uint32_t id = 0; has_axis(cut, k) && id < boxes.size(); ++id)
                lists[k].push_back({boxes[id].min[static_cast<int>(k)], id});
            std::ranges::sort(lists[k], precedes);
        }
        partition.fit({boxes, {lists[0], lists[1], lists[2]}});
    }

    /// Subsets of a box, with the axes that each owns.
    [[nodiscard]] std::map<std::uint32_t, axis_set> subsets_of(std::uint32_t id) const {
        std::map<std::uint32_t, axis_set> subsets;
        partition.for_each_subset(id, boxes[id], [&](std::uint32_t s, axis_set owned) { subsets[s] = owned; });
        return subsets;
    }

    [[nodiscard]] std::vector<std::size_t> sizes() const {
        std::vector<std::size_t> counts(partition.subset_count());
        for (std::uint32_t id = 0; id < boxes.size(); ++id)
            for (const auto& [subset, owned] : subsets_of(id)) ++counts[subset];
        return counts;
    }

    [[nodiscard]] std::size_t copies() const {
        std::size_t sum = 0;
        for (const std::size_t size : sizes()) sum += size;
        return sum;
    }

    std::vector<box> boxes;
    membership objects;
    Partition partition;
    axis_set cut = 0;
};
using cut_frame = fitted<axial_cut_partition>;
using kd_frame = fitted<kd_tree_partition>;

/// Corners on a coarse lattice, so that many lie on planes of a partition, and a few long boxes.
box any_box_among_planes() {
    box b;
    for (int k = 0; k < 3; ++k) {
        b.min[k] = static_cast<float>(*rc::gen::inRange(0, 30));
        b.max[k] = b.min[k] + static_cast<float>(*rc::gen::element(0, 1, 2, 3, 20));
    }
    return b;
}

std::vector<box> any_boxes_among_planes(std::size_t least, std::size_t end) {
    std::vector<box> boxes(*rc::gen::inRange(least, end));
    for (box& b : boxes) b = any_box_among_planes();
    return boxes;
}

/// Requires one owner of each overlapping pair, and at most one of any other.
template <class Partition>
void require_one_owner(const fitted<Partition>& p) {
    for (std::uint32_t a = 0; a < p.boxes.size(); ++a) {
        const auto subsets = p.subsets_of(a);
        RC_ASSERT(!subsets.empty() && subsets.rbegin()->first < p.partition.subset_count());
        RC_ASSERT(subsets.size() == p.partition.copies(a, p.boxes[a]));
        for (std::uint32_t b = a + 1; b < p.boxes.size(); ++b) {
            int owners = 0;
            for (const auto& [subset, owned] : p.subsets_of(b))
                owners += subsets.contains(subset) && partition_subset::owns(subsets.at(subset), owned);
            RC_ASSERT(owners <= 1);
            RC_ASSERT(!overlaps(p.boxes[a], p.boxes[b]) || owners == 1);
        }
    }
}

/// Points on the x axis.
std::vector<box> row_of_points(int n) {
    std::vector<box> boxes;
    for (int i = 0; i < n; ++i) boxes.push_back({{static_cast<float>(i), 0, 0}, {static_cast<float>(i), 1, 1}});
    return boxes;
}

}  // namespace

TEST_CASE("segments hold the same number of projections") {
    const cut_frame f(row_of_points(1000), {{"axes", "1"}, {"segments", "8"}});
    CHECK(f.cut == 0b001);
    CHECK(f.sizes() == std::vector<std::size_t>(8, 125));
}

TEST_CASE("a wide box prevents cuts within it, not elsewhere") {
    std::vector<box> boxes = row_of_points(2560);
    boxes[1005].max[0] = 1261;  // a tenth of the axis
    const cut_frame limited(boxes, {{"axes", "1"}, {"segments", "256"}});
    CHECK(limited.partition.segments().wanted == 256);
    // Of the 25 wanted cuts beyond the one that may lie in the box, one is moved behind it.
    CHECK(limited.partition.segments().got == 232);
    CHECK(limited.subsets_of(1005).size() == 2);
    const cut_frame unlimited(boxes, {{"axes", "1"}, {"segments", "256"}, {"limit", "off"}});
    CHECK(unlimited.partition.segments().got == 256);
    CHECK(unlimited.subsets_of(1005).size() == 27);
}

TEST_CASE("a box that touches a plane from below lies on both sides of it") {
    using subsets = std::map<std::uint32_t, axis_set>;
    // Four intervals in two segments: the cut is the third lower end, 2.
    const cut_frame f({{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}, {{2, 0, 0}, {3, 1, 1}}, {{3, 0, 0}, {4, 1, 1}}},
                      {{"axes", "1"}, {"segments", "2"}});
    // The median of these centres is 2, and no plane divides the three that reach beyond it.
    const kd_frame p({{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}, {{2, 0, 0}, {2, 1, 1}}, {{3, 0, 0}, {4, 1, 1}}},
                     {{"leaf", "2"}});
    CHECK(p.cut == 0);  // it needs no lists
    CHECK(p.partition.subset_count() == 2);
    for (const auto& actual : {std::array{f.subsets_of(0), f.subsets_of(1), f.subsets_of(2)},
                               std::array{p.subsets_of(0), p.subsets_of(1), p.subsets_of(2)}}) {
        CHECK(actual[0] == subsets{{0, 0b111}});
        CHECK(actual[1] == subsets{{0, 0b111}, {1, 0b110}});
        CHECK(actual[2] == subsets{{1, 0b111}});
    }
}

TEST_CASE("no box is cut more than once on an axis, and overlapping boxes have one owner") {
    REQUIRE(rc::check([] {
        const std::string axes = *rc::gen::element<std::string>("auto", "1", "2", "3");
        const std::string limit = *rc::gen::element<std::string>("on", "off");
        const std::string segments = *rc::gen::element<std::string>("auto", "1", "2", "3", "9", "60");
        const cut_frame f(any_boxes_among_planes(0, 40), {{"axes", axes}, {"segments", segments}, {"limit", limit}});
        require_one_owner(f);
        const std::size_t most = std::size_t{1} << (axes == "auto" ? 3 : std::stoul(axes));
        for (std::uint32_t id = 0; limit == "on" && id < f.boxes.size(); ++id)
            RC_ASSERT(f.subsets_of(id).size() <= most);
    }));
}

TEST_CASE("axes are cut in order of the variance of centres, a swept axis last, flat axes never") {
    std::vector<box> boxes;
    for (std::uint32_t i = 0; i < 64; ++i) {
        const auto x = static_cast<float>(i * 37 % 64);
        boxes.push_back({{x, 4 * x, 7}, {x + 1, 4 * x + 1, 8}});
    }
    CHECK(cut_frame(boxes, {{"axes", "1"}, {"segments", "4"}}).cut == 0b010);
    CHECK(cut_frame(boxes, {{"axes", "1"}, {"segments", "4"}}, 0b010).cut == 0b001);
    CHECK(cut_frame(boxes, {{"axes", "2"}, {"segments", "4"}}, 0b010).cut == 0b011);
    CHECK(cut_frame(boxes, {{"axes", "3"}, {"segments", "4"}}).cut == 0b011);
    CHECK(cut_frame(row_of_points(64), {{"axes", "1"}, {"segments", "4"}}, 0b001).cut == 0b001);
    CHECK(cut_frame(std::vector<box>(9, boxes[0]), {{"axes", "3"}, {"segments", "4"}}).partition.subset_count() == 1);
}

TEST_CASE("auto cuts a large scene finer than a small one, and reports the wanted segments") {
    const auto segments = [](int side) {
        std::vector<box> boxes;
        for (int i = 0; i < side * side; ++i) {
            const int row = i / side;
            const auto x = static_cast<float>(2 * (i % side));
            const auto y = static_cast<float>(2 * row);
            boxes.push_back({{x, y, 0}, {x + 1, y + 1, 1}});
        }
        return cut_frame(boxes, {}).partition.segments();
    };
    CHECK(segments(60).got > segments(12).got);
    CHECK(segments(60).wanted >= segments(60).got);
}

TEST_CASE("auto cuts more axes of larger scenes, and of scenes that are sorted on all axes anyway") {
    const auto cut_of = [](std::uint32_t n, std::vector<setting> settings, axis_set swept) {
        settings.push_back({"axes", "auto"});
        return std::popcount(cut_frame(scattered(n, 2), settings, swept).cut);
    };
    CHECK(cut_of(100, {}, 0b001) == 0);
    CHECK(cut_of(3000, {}, 0b001) == 1);
    CHECK(cut_of(20'000, {}, 0b001) == 2);
    CHECK(cut_of(3000, {}, 0b111) > 1);
    // A named number of segments implies a cut.
    CHECK(cut_of(100, {{"segments", "4"}}, 0b001) > 0);
}

TEST_CASE("auto changes the axes that it cuts only if others cost a tenth less") {
    cut_frame f({{"axes", "auto"}});
    std::vector<int> axes;
    for (const float extent : {1.0F, 2.5F, 8.0F, 2.5F}) {
        f.fit(scattered(3000, extent), 0b001);
        axes.push_back(std::popcount(f.cut));
    }
    CHECK(axes == std::vector{1, 1, 2, 2});
}

TEST_CASE("more wanted segments make more segments, up to the limit") {
    REQUIRE(rc::check([] {
        const std::vector<box> boxes = any_boxes_among_planes(1, 200);
        std::uint64_t got = 0;
        for (const char* wanted : {"2", "8", "64", "65535"}) {
            const segment_counts counts = cut_frame(boxes, {{"axes", "1"}, {"segments", wanted}}).partition.segments();
            // Cuts in other places may exclude each other, but only a few do.
            RC_ASSERT(counts.got + 2 >= got);
            got = counts.got;
        }
    }));
}

TEST_CASE("too many subsets are rejected") {
    std::vector<box> boxes;
    for (std::uint32_t i = 0; i < 3000; ++i) {
        const vec3f p{static_cast<float>(i), static_cast<float>(i * 7 % 3000), static_cast<float>(i * 11 % 3000)};
        boxes.push_back({p, p});
    }
    CHECK_REFUSED(cut_frame(boxes, {{"axes", "3"}, {"segments", "3000"}}),
                  "axial_cut: 3000 segments per axis make 27000000000 subsets, more than 2^26");
}

TEST_CASE("overlapping boxes are owned by one leaf, whatever the earlier frames") {
    REQUIRE(rc::check([] {
        kd_frame p({{"leaf", *rc::gen::element<std::string>("auto", "2", "5")}});
        std::vector<box> boxes = any_boxes_among_planes(0, 200);
        for (int frame = 0; frame < 4; ++frame) {
            // Some boxes move, or all.
            for (box& b : boxes)
                if (*rc::gen::inRange(0, 4) < frame) b = any_box_among_planes();
            p.fit(boxes, *rc::gen::element<axis_set>(0b001, 0b100, 0b111));
            RC_ASSERT(p.copies() <= 16 * boxes.size());
            require_one_owner(p);
        }
    }));
}

TEST_CASE("overlapping boxes are owned by one leaf as many boxes leave their cells") {
    REQUIRE(rc::check([] {
        kd_frame p({{"leaf", *rc::gen::element<std::string>("auto", "2", "5")}});
        std::vector<box> boxes = any_boxes_among_planes(50, 200);
        for (int frame = 0; frame < 20; ++frame) {
            const float low = static_cast<float>(*rc::gen::inRange(-10, 40));
            const auto k = *rc::gen::inRange(0, 3);
            const float shift = static_cast<float>(*rc::gen::inRange(-20, 21));
            for (box& b : boxes)
                if (frame > 0 && b.min[k] >= low && b.min[k] < low + 15) b.min[k] += shift, b.max[k] += shift;
            p.fit(boxes);
            require_one_owner(p);
        }
    }));
}

TEST_CASE("leaves hold similar numbers of boxes at any density") {
    std::vector<box> boxes = cubes(2000, {1000, 1000, 1000});
    // As many boxes in a millionth of the space.
    for (const box& b : cubes(2000, {10, 10, 10}))
        boxes.push_back({{b.min[0] / 10, b.min[1] / 10, b.min[2] / 10}, {b.max[0] / 10, b.max[1] / 10, b.max[2] / 10}});
    const kd_frame p(boxes, {{"leaf", "40"}});
    CHECK(p.partition.subset_count() > 100);
    CHECK(std::ranges::max(p.sizes()) < 100);
    CHECK(p.copies() < 3 * boxes.size());
}

TEST_CASE("planes are kept while the density stays, and chosen again only where it changed") {
    const vec3f world{60, 60, 60};
    std::vector<box> boxes = cubes(4000, world);
    kd_frame p(boxes, {});
    const std::size_t nodes = p.partition.built_nodes();
    CHECK(nodes == 2 * p.partition.subset_count() - 1);
    CHECK(nodes > 50);
    SECTION("none if all boxes move but the density stays") {
        for (std::uint32_t seed = 2; seed < 5; ++seed) {
            p.fit(cubes(4000, world, seed));
            CHECK(p.partition.built_nodes() == 0);
        }
    }
    SECTION("some if the boxes of one corner move to another") {
        for (box& b : boxes)
            if (b.max[0] < 20 && b.max[1] < 20 && b.max[2] < 20)
                for (int k = 0; k < 3; ++k) b.min[k] = 45 + b.min[k] / 3, b.max[k] = b.min[k] + 1;
        // The rebuild waits for the next frame.
        p.fit(boxes);
        CHECK(p.partition.built_nodes() == 0);
        p.fit(boxes);
        CHECK_BETWEEN(0, p.partition.built_nodes(), nodes / 2);
        p.fit(boxes);
        CHECK(p.partition.built_nodes() == 0);
    }
    SECTION("all at once if the frame would cost much more") {
        for (box& b : boxes)
            for (int k = 0; k < 3; ++k) b.min[k] /= 60, b.max[k] = b.min[k] + 1.0F / 60;
        p.fit(boxes);
        CHECK(p.partition.built_nodes() > 50);
    }
    SECTION("all if another axis is swept") {
        p.fit(boxes, 0b001);
        CHECK(p.partition.built_nodes() == 2 * p.partition.subset_count() - 1);
    }
}

TEST_CASE("a swept axis is not cut") {
    for (std::size_t k = 0; k < 3; ++k) {
        CAPTURE(k);
        const kd_frame p(cubes(4000, {60, 60, 60}), {}, axis_set{1} << k);
        CHECK(p.partition.subset_count() > 20);
        std::size_t cut = 0;
        for (std::uint32_t id = 0; id < 4000; ++id)
            for (const auto& [subset, owned] : p.subsets_of(id)) cut += !has_axis(owned, k);
        CHECK(cut < 100);
    }
}

TEST_CASE("boxes that no plane divides stay together") {
    kd_frame p(std::vector<box>(1000, cube(0, 1)), {});
    CHECK(p.partition.subset_count() == 1);
    p.fit({});
    CHECK(p.partition.subset_count() == 1);
}
