module aabb.engines:box_engine;

import aabb.pipeline;
import aabb.std;

namespace aabb {

/// The base of box engines: tracks the present objects and rejects the same input as a composed stage. Counts no work.
class box_engine : public global_stage {
public:
    void insert(std::uint32_t id) final { objects_.insert(id); }
    void insert_all(std::span<const std::uint32_t> ids) final { objects_.insert_all(ids); }
    void remove(std::uint32_t id) final { objects_.remove(id); }
    void moved(std::span<const std::uint32_t> ids) final { objects_.moved(ids); }

    /// Gives the engine the boxes of a frame, after invalid ones were rejected. The ids of the present objects are
    /// listed anew only if objects were inserted or removed. `frame_` rejects a search whose update has failed.
    void update(std::span<const box> boxes) final {
        if (!frame_.is_taken()) objects_.forget_moved();  // since a frame that the engine has not taken
        frame_.begin();
        require_ieee_arithmetic();
        objects_.require_boxes_for_all(boxes.size());
        require_valid(boxes);
        const bool same_objects = !objects_.any_departures() && objects_.arrivals() == 0;
        if (!same_objects) {
            ids_.clear();
            for (std::uint32_t id = 0; id < boxes.size(); ++id)
                if (is_present(id)) ids_.push_back(id);
        }
        const bool takes_moved = same_objects && objects_.moved() && can_take_moved();
        if (takes_moved) list_moved();
        objects_.settle();
        // After an exception the engine takes no more frames.
        frame_.change([&] { take_boxes(boxes, takes_moved ? moved_ : ids_); });
        frame_.taken();
    }

    void search(std::vector<index_pair>& pairs) final {
        frame_.require_taken();
        require_ieee_arithmetic();
        append_guard guard(pairs);
        find_pairs(pairs);
        guard.keep();
    }

    [[nodiscard]] work_counters counters() const final { return {}; }
    [[nodiscard]] std::vector<omission> left_out() const final { return {}; }

protected:
    [[nodiscard]] inline bool is_present(std::uint32_t id) const { return objects_.contains(id); }

    /// Calls `drop` for the entries of objects that left, and clears them.
    void drop_absent(auto& by_id, auto drop) const {
        for (std::uint32_t id = 0; id < by_id.size(); ++id)
            if (by_id[id] && !is_present(id)) {
                drop(by_id[id]);
                by_id[id] = nullptr;
            }
    }

    /// Whether `take_boxes` may be given only the boxes that may differ from those of the last frame.
    [[nodiscard]] virtual bool can_take_moved() const { return false; }
    /// Takes the boxes of the present objects, in ascending order of ids.
    virtual void take_boxes(std::span<const box> boxes, std::span<const std::uint32_t> ids) = 0;
    /// Appends the overlapping pairs of these boxes.
    virtual void find_pairs(std::vector<index_pair>& pairs) = 0;

private:
    void list_moved() {
        moved_.clear();
        for (const std::uint32_t id : *objects_.moved())
            if (is_present(id)) moved_.push_back(id);
        std::ranges::sort(moved_);
        moved_.erase(std::ranges::unique(moved_).begin(), moved_.end());
    }

    membership objects_;
    std::vector<std::uint32_t> ids_;
    std::vector<std::uint32_t> moved_;  // those of them that may have moved
    frame_state frame_;
};

/// Collects pairs in a library's callback, through which no exception may propagate.
struct pair_collector {
    std::vector<index_pair>& pairs;
    bool out_of_memory = false;

    /// Calls `append`, which appends to the pairs.
    void append_safely(auto append) {
        try {
            append();
        } catch (const std::bad_alloc&) {
            out_of_memory = true;
        }
    }
    /// Call it after the library has returned. @throws std::bad_alloc if memory ran out in a callback.
    void require_memory() const {
        if (out_of_memory) throw std::bad_alloc();
    }
    /// Removes unwanted pairs from index `known` on.
    void drop(std::size_t known, auto unwanted) const {
        const auto from = pairs.begin() + static_cast<std::ptrdiff_t>(known);
        pairs.erase(std::remove_if(from, pairs.end(), unwanted), pairs.end());
    }
};

}  // namespace aabb
