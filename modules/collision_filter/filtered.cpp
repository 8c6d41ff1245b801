module aabb.collision_filter;

import :box_index;
import :set_join;

namespace aabb {

namespace {

/// A stage that removes the pairs which are left out. Objects at rest may be kept from the search: those that stay
/// where they were are in an index, in which the others are looked up, so that a frame takes time for what moves. Two
/// sets may be joined without a search: from the frame on after which many pairs within the sets were found in vain.
class filtered_stage final : public global_stage {
public:
    filtered_stage(std::unique_ptr<global_stage> search, const collision_filter& filter, filtering when,
                   instrumentation counted)
        : search_(std::move(search)), filter_(filter), when_(when), counted_(counted) {}

    [[nodiscard]] std::unique_ptr<scene_parts> divide(const mesh_scene& scene) override {
        std::unique_ptr<scene_parts> parts = search_->divide(scene);
        object_of_.clear();
        if (!parts) return parts;
        object_of_.resize(parts->pieces());
        for (std::uint32_t object = 0; object < scene.mesh_of.size(); ++object) {
            const auto [first, last] = parts->pieces_of(object);
            std::fill(object_of_.begin() + first, object_of_.begin() + last, object);
        }
        return parts;
    }
    void expect(std::size_t frames) override { search_->expect(frames); }

    /// An object that comes is searched; it enters the index later, if at all.
    void insert(std::uint32_t id) override {
        objects_.insert(id);
        frame_.change([&] {
            if (id >= places_.size()) places_.resize(std::size_t{id} + 1, place::none);
            // One that left since the last frame is still in the index.
            if (places_[id] == place::none) search_object(id);
        });
    }
    void remove(std::uint32_t id) override {
        objects_.remove(id);
        frame_.change([&] {
            if (places_[id] == place::searched)
                take_out(id);
            else
                departures_.push_back(id);  // the current frame may still be searched
        });
    }

    void update(std::span<const box> boxes) override {
        frame_.begin();
        require_ieee_arithmetic();
        objects_.require_boxes_for_all(boxes.size());
        boxes_ = boxes;
        joins_ = (joins_ || joins_next_) && filter_.has_sets();
        joins_next_ = false;
        frame_.change([&] {
            objects_.settle();
            for (const std::uint32_t id : departures_)
                if (places_[id] == place::indexed && !objects_.contains(id)) take_out(id);
            departures_.clear();
            if (when_ == filtering::early && !joins_ && (filter_.resting() > 0 || indexed_ > 0)) sort_out_resting();
        });
        searches_ = !joins_ && (searched_ > 0 || indexed_ == 0);
        if (searches_)
            search_->update(boxes);
        else
            require_valid(boxes);
        if (joins_) frame_.change([&] { join_.update(boxes, [this](std::uint32_t id) { return set_of(id); }); });
        frame_.taken();
    }

    /// Pairs of pieces of one object may be removed as well: the narrow phase never sees them.
    void search(std::vector<index_pair>& pairs) override {
        frame_.require_taken();
        require_ieee_arithmetic();
        append_guard guard(pairs);
        if (joins_)
            append_pairs_of_sets(pairs);
        else
            append_searched_pairs(pairs);
        guard.keep();
    }

    [[nodiscard]] double share_of_update() const override {
        return searches_ ? search_->share_of_update() : 0;  // otherwise its last share is of an earlier frame
    }
    [[nodiscard]] work_counters counters() const override {
        work_counters total = search_->counters();
        total.add(work::box_tests, tests_counted_);
        return total;
    }
    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        std::vector<part_bytes> parts = search_->bytes();
        parts.push_back(
            {"prepare", bytes_of(objects_, object_of_, places_, departures_, kept_, movers_, index_, join_)});
        return parts;
    }
    [[nodiscard]] std::vector<stage_plan> plans() const override { return search_->plans(); }
    [[nodiscard]] std::vector<omission> left_out() const override { return search_->left_out(); }

private:
    /// Where an object is: absent, in the search, or in the index with the box that it still has.
    enum class place : std::uint8_t { none, searched, indexed };

    [[nodiscard]] std::uint32_t object_of(std::uint32_t id) const { return object_of_.empty() ? id : object_of_[id]; }
    [[nodiscard]] bool rests(std::uint32_t id) const { return filter_[object_of(id)].rests; }
    [[nodiscard]] bool keeps(std::uint32_t a, std::uint32_t b) const {
        return filter_.keeps(object_of(a), object_of(b));
    }

    [[nodiscard]] object_set set_of(std::uint32_t id) const {
        const bool is_present = id < places_.size() && places_[id] != place::none;
        return is_present ? filter_[object_of(id)].set : object_set::none;
    }

    void search_object(std::uint32_t id) {
        search_->insert(id);
        places_[id] = place::searched;
        ++searched_;
    }
    /// Takes an object out of where it is; the index keeps its box, which queries then ignore.
    void take_out(std::uint32_t id) {
        if (places_[id] == place::searched) {
            search_->remove(id);
            --searched_;
        } else {
            --indexed_;
        }
        places_[id] = place::none;
    }
    void release_from_index(std::uint32_t id) {
        take_out(id);
        search_object(id);
    }

    /// Takes out of the index what does not rest any more, and decides whether those that rest are worth an index. Each
    /// frame in which an object at rest is searched counts. The index is built anew once these have taken as long as
    /// building it, so that it at most doubles the time: sorting takes about log n times as long per object.
    void sort_out_resting() {
        std::size_t unindexed = 0;  // objects at rest that are searched
        movers_.clear();
        for (std::uint32_t id = 0; id < places_.size(); ++id) {
            if (places_[id] == place::none) continue;
            const bool at_rest = rests(id);
            if (places_[id] == place::indexed && (!at_rest || boxes_[id] != kept_[id])) release_from_index(id);
            if (!at_rest)
                movers_.push_back(id);
            else if (places_[id] == place::searched)
                ++unindexed;
        }
        const std::size_t resting = indexed_ + unindexed;
        if (indexed_ > 0 && resting < least_ratio_to_keep * movers_.size()) {
            for (std::uint32_t id = 0; id < places_.size(); ++id)
                if (places_[id] == place::indexed) release_from_index(id);
            index_.clear();
            waiting_ = 0;
            return;
        }
        if (indexed_ == 0 && resting < least_ratio_to_build * movers_.size()) return;
        waiting_ += unindexed;
        const auto frames = static_cast<std::size_t>(std::bit_width(resting));
        if ((unindexed > 0 && waiting_ >= frames * resting) || 2 * indexed_ < index_.size()) build_index();
    }

    /// Moves every object at rest from the search to the index.
    void build_index() {
        waiting_ = 0;
        kept_.assign(boxes_.begin(), boxes_.end());
        std::vector<box_index::entry> entries;
        for (std::uint32_t id = 0; id < places_.size(); ++id) {
            if (places_[id] == place::none || !rests(id)) continue;
            if (places_[id] == place::searched) {
                if (!is_valid(boxes_[id])) continue;  // the search rejects it
                take_out(id);
                ++indexed_;
                places_[id] = place::indexed;
            }
            entries.push_back({boxes_[id], id});
        }
        index_.build(entries);
    }

    void append_searched_pairs(std::vector<index_pair>& pairs) {
        const std::size_t before = pairs.size();
        if (searches_) search_->search(pairs);
        const std::size_t searched = pairs.size();
        remove_left_out(pairs, before);
        const std::size_t removed = searched - pairs.size();
        const std::size_t kept = pairs.size() - before;
        joins_next_ = when_ == filtering::early && filter_.has_sets() &&
                      removed > pairs_per_query * filter_.size_of_smaller_set() + pairs_per_result * kept;
        if (indexed_ > 0) append_pairs_with_indexed(pairs);
    }
    void append_pairs_of_sets(std::vector<index_pair>& pairs) {
        const std::size_t tests = join_.search([&](index_pair p) {
            if (keeps(p.a, p.b)) pairs.push_back(p);
        });
        if (counted_ == instrumentation::counters) tests_counted_ += tests;
    }

    void remove_left_out(std::vector<index_pair>& pairs, std::size_t first) const {
        if (object_of_.empty())
            filter_.apply(pairs, first);
        else
            filter_.apply(pairs, first, [this](std::uint32_t piece) { return object_of_[piece]; });
    }

    /// Pairs of an object that does not rest and one in the index, whose entries may be of objects that have left it.
    void append_pairs_with_indexed(std::vector<index_pair>& pairs) {
        std::size_t tests = 0;
        for (const std::uint32_t mover : movers_)
            tests += index_.query(boxes_[mover], [&](std::uint32_t id) {
                if (places_[id] == place::indexed && keeps(mover, id)) pairs.push_back(ordered_pair(mover, id));
            });
        if (counted_ == instrumentation::counters) tests_counted_ += tests;
    }

    /// Numbers of objects at rest per other object from which on an index is built, and below which it is given up: a
    /// query takes longer than searching one more object.
    static constexpr std::size_t least_ratio_to_build = 4, least_ratio_to_keep = 2;

    /// What queries take in comparison with finding a pair by the search and removing it: to begin a query, and more
    /// for each of its results than for one of the search.
    static constexpr std::size_t pairs_per_query = 50, pairs_per_result = 2;

    std::unique_ptr<global_stage> search_;
    const collision_filter& filter_;
    filtering when_;
    instrumentation counted_;
    std::uint64_t tests_counted_ = 0;
    membership objects_;
    frame_state frame_;
    std::span<const box> boxes_;
    std::vector<std::uint32_t> object_of_;    // by piece; empty if objects are whole
    std::vector<place> places_;               // by id
    std::size_t searched_ = 0, indexed_ = 0;  // numbers of objects by place
    bool searches_ = true;                    // whether the search has the current frame
    std::vector<std::uint32_t> departures_;   // since the last frame, of objects in the index
    box_index index_;
    std::vector<box> kept_;              // by id, those of the frame in which the index was built
    std::vector<std::uint32_t> movers_;  // present objects that do not rest
    bool joins_ = false;                 // the sets are joined without a search
    bool joins_next_ = false;            // the same from the next frame on
    set_join join_;
    std::size_t waiting_ = 0;  // frames times objects at rest that were searched since then
};

}  // namespace

std::unique_ptr<global_stage> filtered(std::unique_ptr<global_stage> search, const collision_filter& filter,
                                       filtering when, instrumentation counted) {
    return std::make_unique<filtered_stage>(std::move(search), filter, when, counted);
}

}  // namespace aabb
