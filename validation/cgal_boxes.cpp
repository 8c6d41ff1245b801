module;
#include <CGAL/box_intersection_d.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

module aabb.validation;

import aabb;
import :parts;

namespace aabb {

namespace {

/// A box as CGAL's algorithm takes it. Two boxes with one number count as the same box, which is never reported.
/// Coordinates are handed over in double: the algorithm takes the greatest value of their type for infinity, and boxes
/// may end at the greatest float.
struct numbered_box {
    using NT = double;
    using ID = std::uint64_t;

    box bounds;
    ID number;

    static int dimension() { return 3; }
    [[nodiscard]] ID id() const { return number; }
    [[nodiscard]] NT min_coord(int axis) const { return bounds.min[axis]; }
    [[nodiscard]] NT max_coord(int axis) const { return bounds.max[axis]; }
};

class cgal_boxes final : public box_engine {
public:
    [[nodiscard]] std::vector<part_bytes> bytes() const override { return {{"engine", bytes_of(boxes_)}}; }

private:
    void take(std::span<const box> boxes, std::span<const std::uint32_t> ids) override {
        boxes_.clear();
        for (const std::uint32_t id : ids) boxes_.push_back({boxes[id], id});
    }

    void find(std::vector<index_pair>& pairs) override {
        CGAL::box_self_intersection_d(boxes_.begin(), boxes_.end(), [&](const numbered_box& a, const numbered_box& b) {
            pairs.push_back(ordered_pair(static_cast<std::uint32_t>(a.number), static_cast<std::uint32_t>(b.number)));
        });
    }

    std::vector<numbered_box> boxes_;
};

}  // namespace

std::unique_ptr<global_stage> make_cgal_boxes() {
    return std::make_unique<cgal_boxes>();
}

std::vector<index_pair> candidates_by_cgal(std::span<const box> a, std::span<const box> b) {
    constexpr std::uint64_t of_b = std::uint64_t{1} << 32;
    std::vector<numbered_box> boxes_a;
    std::vector<numbered_box> boxes_b;
    for (std::size_t i = 0; i < a.size(); ++i) boxes_a.push_back({a[i], i});
    for (std::size_t i = 0; i < b.size(); ++i) boxes_b.push_back({b[i], of_b | i});
    std::vector<index_pair> pairs;
    CGAL::box_intersection_d(
        boxes_a.begin(), boxes_a.end(), boxes_b.begin(), boxes_b.end(),
        [&](const numbered_box& s, const numbered_box& t) {
            pairs.push_back({static_cast<std::uint32_t>(s.number), static_cast<std::uint32_t>(t.number)});
        });
    return pairs;
}

}  // namespace aabb
