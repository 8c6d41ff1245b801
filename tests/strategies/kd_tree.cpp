#include <rapidcheck.h>
#include <algorithm>
#include <array>
#include <catch2/catch_test_macros.hpp>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "cell_owners.hpp"

import aabb;
import aabb.partition.kd_tree;

using namespace aabb;

namespace {

/// Frames of a kd-tree, which asks for no lists.
struct planted {
    explicit planted(const std::vector<setting>& settings = {}) : partition(configured<kd_tree_partition>(settings)) {}

    void take(std::vector<box> frame, axis_set swept = every_axis) {
        boxes = std::move(frame);
        for (auto id = static_cast<std::uint32_t>(objects.size()); id < boxes.size(); ++id) objects.insert(id);
        objects.settle();
        CHECK(partition.axes(boxes, objects, swept) == 0);
        partition.fit({boxes, {}});
    }

    /// Subsets of a box, with the axes that each owns.
    [[nodiscard]] std::map<std::uint32_t, axis_set> subsets_of(std::uint32_t id) const {
        return subsets_in(partition, boxes, id);
    }

    [[nodiscard]] std::vector<std::size_t> sizes() const {
        std::vector<std::size_t> all(partition.subset_count());
        for (std::uint32_t id = 0; id < boxes.size(); ++id)
            for (const auto& [subset, owned] : subsets_of(id)) ++all[subset];
        return all;
    }

    [[nodiscard]] std::size_t copies() const {
        std::size_t all = 0;
        for (const std::size_t size : sizes()) all += size;
        return all;
    }

    std::vector<box> boxes;
    membership objects;
    kd_tree_partition partition;
};

/// Unit cubes with their lower corners in a cube.
std::vector<box> cubes(std::size_t n, float width, std::uint32_t seed = 1) {
    std::mt19937 random(seed);
    std::vector<box> boxes(n);
    for (box& b : boxes)
        for (int k = 0; k < 3; ++k) {
            b.min[k] = width * static_cast<float>(random() % 65536) / 65536;
            b.max[k] = b.min[k] + 1;
        }
    return boxes;
}

/// Of each pair that overlaps, of others at most one.
void require_one_owner(const planted& p) {
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

}  // namespace

TEST_CASE("boxes of a kd-tree are classified half-open at its planes, and touching one is reaching over it") {
    // The median of these centres is 2, and no plane divides the three that reach beyond it.
    planted p({{"leaf", "2"}});
    p.take({{{0, 0, 0}, {1, 1, 1}}, {{1, 0, 0}, {2, 1, 1}}, {{2, 0, 0}, {2, 1, 1}}, {{3, 0, 0}, {4, 1, 1}}});
    CHECK(p.partition.subset_count() == 2);
    CHECK(p.subsets_of(0) == std::map<std::uint32_t, axis_set>{{0, 0b111}});
    CHECK(p.subsets_of(1) == std::map<std::uint32_t, axis_set>{{0, 0b111}, {1, 0b110}});
    CHECK(p.subsets_of(2) == std::map<std::uint32_t, axis_set>{{1, 0b111}});
}

TEST_CASE("overlapping boxes have one leaf that owns them, whatever frames came before") {
    REQUIRE(rc::check([] {
        planted p({{"leaf", *rc::gen::element<std::string>("auto", "2", "5")}});
        std::vector<box> boxes(*rc::gen::inRange<std::size_t>(0, 200));
        for (int frame = 0; frame < 4; ++frame) {
            // Some go elsewhere, or all.
            for (box& b : boxes)
                if (frame == 0 || *rc::gen::inRange(0, 4) < frame) b = any_box_among_planes();
            p.take(boxes, *rc::gen::element<axis_set>(0b001, 0b100, 0b111));
            RC_ASSERT(p.copies() <= 16 * boxes.size());
            require_one_owner(p);
        }
    }));
}

TEST_CASE("overlapping boxes have one leaf that owns them where heaps of them leave their cells") {
    REQUIRE(rc::check([] {
        planted p({{"leaf", *rc::gen::element<std::string>("auto", "2", "5")}});
        std::vector<box> boxes(*rc::gen::inRange<std::size_t>(50, 200));
        for (box& b : boxes) b = any_box_among_planes();
        for (int frame = 0; frame < 20; ++frame) {
            const float from = static_cast<float>(*rc::gen::inRange(-10, 40));
            const auto k = *rc::gen::inRange(0, 3);
            const float way = static_cast<float>(*rc::gen::inRange(-20, 21));
            for (box& b : boxes)
                if (frame > 0 && b.min[k] >= from && b.min[k] < from + 15) {
                    b.min[k] += way;
                    b.max[k] += way;
                }
            p.take(boxes);
            require_one_owner(p);
        }
    }));
}

TEST_CASE("leaves hold like numbers of boxes, however unlike the densities") {
    std::vector<box> boxes = cubes(2000, 1000);
    // As many in a millionth of the space.
    for (const box& b : cubes(2000, 10))
        boxes.push_back({{b.min[0] / 10, b.min[1] / 10, b.min[2] / 10}, {b.max[0] / 10, b.max[1] / 10, b.max[2] / 10}});
    planted p({{"leaf", "40"}});
    p.take(boxes);
    CHECK(p.partition.subset_count() > 100);
    CHECK(std::ranges::max(p.sizes()) < 100);
    CHECK(p.copies() < 3 * boxes.size());
}

TEST_CASE("planes stay while boxes do, and are chosen anew only where these went elsewhere") {
    planted p;
    std::vector<box> boxes = cubes(4000, 60);
    p.take(boxes);
    const std::size_t nodes = p.partition.made_nodes();
    CHECK(nodes == 2 * p.partition.subset_count() - 1);
    CHECK(nodes > 50);
    SECTION("none where each moves a little, or all are elsewhere but as many everywhere") {
        for (std::uint32_t seed = 2; seed < 5; ++seed) {
            p.take(cubes(4000, 60, seed));
            CHECK(p.partition.made_nodes() == 0);
        }
    }
    SECTION("some where a corner empties into another") {
        for (box& b : boxes)
            if (b.max[0] < 20 && b.max[1] < 20 && b.max[2] < 20)
                for (int k = 0; k < 3; ++k) {
                    b.min[k] = 45 + b.min[k] / 3;
                    b.max[k] = b.min[k] + 1;
                }
        // It waits for the next frame.
        p.take(boxes);
        CHECK(p.partition.made_nodes() == 0);
        p.take(boxes);
        CHECK(p.partition.made_nodes() > 0);
        CHECK(p.partition.made_nodes() < nodes / 2);
        p.take(boxes);
        CHECK(p.partition.made_nodes() == 0);
    }
    SECTION("all at once where the frame would be much dearer") {
        for (box& b : boxes)
            for (int k = 0; k < 3; ++k) {
                b.min[k] = b.min[k] / 60;
                b.max[k] = b.min[k] + 1.0F / 60;
            }
        p.take(boxes);
        CHECK(p.partition.made_nodes() > 50);
    }
    SECTION("all where another axis is swept") {
        p.take(boxes, 0b001);
        CHECK(p.partition.made_nodes() == 2 * p.partition.subset_count() - 1);
    }
}

TEST_CASE("an axis that is swept is not cut") {
    for (std::size_t k = 0; k < 3; ++k) {
        CAPTURE(k);
        planted p;
        p.take(cubes(4000, 60), axis_set{1} << k);
        CHECK(p.partition.subset_count() > 20);
        std::size_t cut = 0;
        for (std::uint32_t id = 0; id < 4000; ++id)
            for (const auto& [subset, owned] : p.subsets_of(id)) cut += !has_axis(owned, k);
        CHECK(cut < 100);
    }
}

TEST_CASE("boxes that no plane divides stay together") {
    planted p;
    p.take(std::vector<box>(1000, box{{0, 0, 0}, {1, 1, 1}}));
    CHECK(p.partition.subset_count() == 1);
    p.take({});
    CHECK(p.partition.subset_count() == 1);
}
