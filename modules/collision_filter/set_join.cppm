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
        if (stored_now_ == stored_ && tested_ <= 2 * tested_when_built_) return index_.refit(boxes);
        stored_.swap(stored_now_);
        tested_when_built_ = 0;
        std::vector<box_index::entry> entries;
        for (const std::uint32_t id : stored_) entries.push_back({boxes[id], id});
        index_.build(entries);
    }

    /// Calls `take` with each pair of overlapping boxes of both sets, once.
    /// @returns the number of boxes that were tested
    template <class Take>
    std::size_t search(Take take) {
        tested_ = 0;
        for (const std::uint32_t id : looked_up_)
            tested_ += index_.query(boxes_[id], [&](std::uint32_t other) { take(ordered_pair(id, other)); });
        if (tested_when_built_ == 0) tested_when_built_ = tested_;
        return tested_;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(looked_up_, stored_, stored_now_, index_); }

private:
    std::span<const box> boxes_;
    std::vector<std::uint32_t> looked_up_;
    std::vector<std::uint32_t> stored_;      // in the index, ascending
    std::vector<std::uint32_t> stored_now_;  // those of the current frame, while they are compared
    box_index index_;
    std::size_t tested_ = 0, tested_when_built_ = 0;
};

}  // namespace aabb
