/// The overlaps between two sets of boxes, without those within a set.
module aabb.collision_filter:set_join;

import aabb.geometry;
import aabb.std;
import :box_index;
import :filter;

namespace aabb {

/// The larger set is in an index, in which the boxes of the other are looked up. The index is adjusted to boxes that
/// move, and built anew once queries open twice as many nodes as they did in the new index.
class set_join {
public:
    /// Takes the valid boxes of a frame, which must live until `search` returns.
    /// @param set_of the set of a box by id; none for one that takes no part
    template <class SetOf>
    void update(std::span<const box> boxes, SetOf set_of) {
        boxes_ = boxes;
        looked_up_.clear();
        stored_now_.clear();
        for (std::uint32_t id = 0; id < boxes.size(); ++id) {
            const object_set set = set_of(id);
            if (set == object_set::a) looked_up_.push_back(id);
            if (set == object_set::b) stored_now_.push_back(id);
        }
        if (stored_now_.size() < looked_up_.size()) stored_now_.swap(looked_up_);
        if (stored_now_ == stored_ && opened_ <= 2 * opened_when_built_) return index_.refit(boxes);
        stored_.swap(stored_now_);
        opened_when_built_ = 0;
        index_.clear();
        for (const std::uint32_t id : stored_) index_.add(id, boxes[id]);
        index_.build(boxes);
    }

    /// Calls `take` with each pair of overlapping boxes of both sets, once.
    template <class Take>
    void search(Take take) {
        opened_ = 0;
        for (const std::uint32_t id : looked_up_)
            opened_ += index_.query(boxes_[id], [&](std::uint32_t other) { take(ordered_pair(id, other)); });
        if (opened_when_built_ == 0) opened_when_built_ = opened_;
    }

    /// Estimates how many pairs within the sets overlap, from one box of each set, another in each call: the mean of
    /// many calls is their number.
    [[nodiscard]] double pairs_within() noexcept {
        double pairs = 0;
        if (!stored_.empty()) {
            std::size_t overlapping = 0;
            index_.query(boxes_[drawn_from(stored_)], [&](std::uint32_t) { ++overlapping; });
            pairs += static_cast<double>(stored_.size()) * static_cast<double>(overlapping - 1) / 2;  // not with itself
        }
        if (!looked_up_.empty()) {
            const box& drawn = boxes_[drawn_from(looked_up_)];
            const auto overlapping =
                std::ranges::count_if(looked_up_, [&](std::uint32_t id) { return overlaps(boxes_[id], drawn); });
            pairs += static_cast<double>(looked_up_.size()) * static_cast<double>(overlapping - 1) / 2;
        }
        ++draws_;
        return pairs;
    }

    /// The sizes of the sets, and the number of nodes that the last search opened.
    [[nodiscard]] std::size_t looked_up() const noexcept { return looked_up_.size(); }
    [[nodiscard]] std::size_t stored() const noexcept { return stored_.size(); }
    [[nodiscard]] std::size_t opened() const noexcept { return opened_; }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(looked_up_, stored_, stored_now_, index_); }

private:
    /// Fibonacci hashing (Knuth, The Art of Computer Programming, 6.4): draws are spread evenly over the ids.
    [[nodiscard]] std::uint32_t drawn_from(std::span<const std::uint32_t> ids) const noexcept {
        const std::uint32_t hash = draws_ * 0x9e3779b9U;
        return ids[std::uint64_t{hash} * ids.size() >> 32U];
    }

    std::span<const box> boxes_;
    std::vector<std::uint32_t> looked_up_;
    std::vector<std::uint32_t> stored_;      // in the index, ascending
    std::vector<std::uint32_t> stored_now_;  // those of the current frame, while they are compared
    box_index index_;
    std::size_t opened_ = 0, opened_when_built_ = 0;
    std::uint32_t draws_ = 0;
};

}  // namespace aabb
