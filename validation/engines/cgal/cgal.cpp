module;
#include <CGAL/box_intersection_d.h>

module aabb.engines;

import :box_engine;
import :engine;
import :pairwise;

namespace aabb {

// Defined in triangles.cpp.
std::vector<library_test> cgal_tests();

namespace {

/// CGAL's intersection of a box sequence with itself (Zomorodian and Edelsbrunner 2002).
class cgal_boxes final : public box_engine {
public:
    [[nodiscard]] std::vector<part_bytes> bytes() const override { return {{"engine", bytes_of(boxes_)}}; }

private:
    void take_boxes(std::span<const box> boxes, std::span<const std::uint32_t> ids) override {
        boxes_.clear();
        for (const std::uint32_t id : ids) boxes_.push_back({boxes[id], id});
    }

    /// Intersects the sequence of boxes with itself, so that CGAL reports each pair once.
    void find_pairs(std::vector<index_pair>& pairs) override {
        const auto collect = [&](const numbered_box& a, const numbered_box& b) {
            pairs.push_back(ordered_pair(static_cast<std::uint32_t>(a.number), static_cast<std::uint32_t>(b.number)));
        };
        // CGAL's brute-force threshold. Its default of 10 takes up to three times as long on 1,000 to 100,000 cubes;
        // pointers to the boxes, which are small, would not be faster.
        const auto cutoff = static_cast<std::ptrdiff_t>(3 * std::sqrt(static_cast<double>(boxes_.size())));
        CGAL::box_self_intersection_d(boxes_.begin(), boxes_.end(), collect, cutoff);
    }

    std::vector<numbered_box> boxes_;
};

}  // namespace

/// All overlapping pairs of a box of `a` and a box of `b`, as indices. CGAL never reports two boxes with the same
/// number, so those of `b` get 2^32 plus their index, which the cast to u32 removes again.
std::vector<index_pair> candidates_by_cgal(std::span<const box> a, std::span<const box> b) {
    constexpr std::uint64_t first_of_b = std::uint64_t{1} << 32;
    std::vector<numbered_box> boxes_a, boxes_b;
    for (std::size_t i = 0; i < a.size(); ++i) boxes_a.push_back({a[i], i});
    for (std::size_t i = 0; i < b.size(); ++i) boxes_b.push_back({b[i], first_of_b | i});
    std::vector<index_pair> pairs;
    CGAL::box_intersection_d(
        boxes_a.begin(), boxes_a.end(), boxes_b.begin(), boxes_b.end(),
        [&](const numbered_box& s, const numbered_box& t) {
            pairs.push_back({static_cast<std::uint32_t>(s.number), static_cast<std::uint32_t>(t.number)});
        });
    return pairs;
}

engine cgal_engine() {
    return {.name = "cgal",
            .summary = "CGAL's intersection of box sequences, and its exact kernel for triangles",
            .boxes = make_stage<global_stage, cgal_boxes>,
            .meshes = [] { return make_pairwise_engine(candidates_by_cgal, intersect_exactly); },
            .triangles = cgal_tests()};
}

}  // namespace aabb
