module;
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

module aabb.prepare.neighbour_list;

import aabb.base;
import aabb.counters;
import aabb.geometry;
import aabb.global_search;
import aabb.pipeline;
import aabb.prepare.mean_extent;

namespace aabb {

namespace {

class neighbour_list_stage final : public global_stage {
public:
    neighbour_list_stage(std::unique_ptr<global_stage> search, const neighbour_list_prepare::config& config,
                         instrumentation counted)
        : search_(std::move(search)), config_(config), counted_(counted) {}

    void insert(std::uint32_t id) override {
        objects_.insert(id);
        frame_.change([&] { search_->insert(id); });
    }
    void remove(std::uint32_t id) override {
        objects_.remove(id);
        search_->remove(id);
    }
    void update(std::span<const box> boxes) override;
    void search(std::vector<index_pair>& pairs) override;
    [[nodiscard]] work_counters counters() const override;
    [[nodiscard]] std::vector<part_bytes> bytes() const override;
    [[nodiscard]] std::vector<std::string> left_out() const override { return search_->left_out(); }

private:
    [[nodiscard]] bool is_due(std::span<const box> boxes) const;
    void grow(std::span<const box> boxes);
    void refresh(std::span<const box> boxes);

    std::unique_ptr<global_stage> search_;
    neighbour_list_prepare::config config_;
    instrumentation counted_;
    std::uint64_t tests_counted_ = 0;
    membership objects_;
    frame_state frame_;
    std::span<const box> boxes_;
    std::vector<box> grown_;        // of the last search
    std::vector<index_pair> list_;  // that it found, less the pairs of objects that have left
    bool is_listed_ = false;        // false where a search failed, or there was none
    std::uint32_t age_ = 0;         // frames since
};

void neighbour_list_stage::update(std::span<const box> boxes) {
    frame_.begin();
    require_ieee_arithmetic();
    objects_.require_boxes_for_all(boxes.size());
    require_valid(boxes);
    boxes_ = boxes;
    ++age_;
    const bool comes_any = !objects_.arrivals().empty();
    const bool leaves_any = objects_.any_departures();
    frame_.change([&] { objects_.settle(); });
    if (!is_listed_ || comes_any || boxes.size() != grown_.size() || is_due(boxes))
        refresh(boxes);
    else if (leaves_any)
        std::erase_if(list_, [&](index_pair p) { return !objects_.contains(p.a) || !objects_.contains(p.b); });
    frame_.taken();
}

void neighbour_list_stage::search(std::vector<index_pair>& pairs) {
    frame_.require_taken();
    require_ieee_arithmetic();
    if (counted_ == instrumentation::counters) tests_counted_ += list_.size();
    append_whole(pairs, [&] {
        // Written without a branch, since which pairs of the list overlap cannot be predicted.
        std::size_t end = pairs.size();
        pairs.resize(end + list_.size());
        for (const index_pair pair : list_) {
            pairs[end] = pair;
            end += static_cast<std::size_t>(overlaps(boxes_[pair.a], boxes_[pair.b]));
        }
        pairs.resize(end);
    });
}

work_counters neighbour_list_stage::counters() const {
    work_counters all = search_->counters();
    all.add(work::box_tests, tests_counted_);
    return all;
}

std::vector<part_bytes> neighbour_list_stage::bytes() const {
    std::vector<part_bytes> parts = search_->bytes();
    parts.push_back({"prepare", bytes_of(objects_) + bytes_of(grown_) + bytes_of(list_)});
    return parts;
}

bool neighbour_list_stage::is_due(std::span<const box> boxes) const {
    if (config_.every > 0) return age_ >= config_.every;
    for (std::uint32_t id = 0; id < boxes.size(); ++id)
        if (objects_.contains(id) && !contains(grown_[id], boxes[id])) return true;
    return false;
}

/// A grown box holds its own, whatever rounding does: floats are rounded to themselves, and rounding keeps order.
void neighbour_list_stage::grow(std::span<const box> boxes) {
    constexpr double most = std::numeric_limits<float>::max();
    const double margin = mean_extents(config_.margin, boxes, objects_);
    grown_.resize(boxes.size());
    for (std::size_t id = 0; id < boxes.size(); ++id)
        for (int k = 0; k < 3; ++k) {
            grown_[id].min[k] = static_cast<float>(std::max(double{boxes[id].min[k]} - margin, -most));
            grown_[id].max[k] = static_cast<float>(std::min(double{boxes[id].max[k]} + margin, most));
        }
}

void neighbour_list_stage::refresh(std::span<const box> boxes) {
    is_listed_ = false;
    grow(boxes);
    search_->update(grown_);
    list_.clear();
    search_->search(list_);
    is_listed_ = true;
    age_ = 0;
}

}  // namespace

std::unique_ptr<global_stage> neighbour_list_prepare::before(std::unique_ptr<global_stage> search,
                                                             instrumentation counted) const {
    return std::make_unique<neighbour_list_stage>(std::move(search), config_, counted);
}

}  // namespace aabb
