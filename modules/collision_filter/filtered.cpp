module aabb.collision_filter;

import :box_index;
import :filter_plan;
import :set_join;

namespace aabb {

namespace {

/// A stage that removes the pairs which the filter does not keep. Objects at rest may be kept from the search: those
/// that stay where they were are in an index, in which the others are looked up, so that a frame takes time for what
/// moves. Two sets may be joined without a search. Both are done as long as they are estimated to be worth their cost.
class filtered_stage final : public global_stage {
public:
    filtered_stage(std::unique_ptr<global_stage> search, const collision_filter& filter, instrumentation counted)
        : search_(std::move(search)), filter_(filter), counted_(counted) {}

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

    void moved(std::span<const std::uint32_t> ids) override { objects_.moved(ids); }

    void update(std::span<const box> boxes) override {
        // What moved is known of the search's boxes only if it has those of the previous frame.
        const bool has_previous = frame_.is_taken() && searches_;
        if (!has_previous) objects_.forget_moved();
        frame_.begin();
        require_ieee_arithmetic();
        objects_.require_boxes_for_all(boxes.size());
        boxes_ = boxes;
        joins_ = wants_join_ && filter_.has_sets();
        const auto moved = objects_.moved();
        frame_.change([&] {
            objects_.settle();
            for (const std::uint32_t id : departures_)
                if (places_[id] == place::indexed && !objects_.contains(id)) take_out(id);
            departures_.clear();
            if (may_withhold_ && !joins_ && (filter_.resting() > 0 || indexed_ > 0)) sort_out_resting();
        });
        searches_ = !joins_ && (searched_ > 0 || indexed_ == 0);
        if (searches_) {
            if (moved) search_->moved(*moved);
            search_->update(boxes);
        } else {
            require_valid(boxes);
        }
        if (joins_) frame_.change([&] { join_.update(boxes, [this](std::uint32_t id) { return set_of(id); }); });
        frame_.taken();
    }

    /// Pairs of pieces of one object may be removed as well: the narrow phase never sees them.
    void search(std::vector<index_pair>& pairs) override {
        frame_.require_taken();
        require_ieee_arithmetic();
        append_guard guard(pairs);
        const std::size_t before = pairs.size();
        if (joins_)
            append_pairs_of_sets(pairs);
        else
            append_searched_pairs(pairs);
        guard.keep();
        if (may_withhold_ && filter_.has_sets()) plan_join(pairs.size() - before);
    }

    [[nodiscard]] double share_of_update() const override {
        return searches_ ? search_->share_of_update() : 0;  // otherwise its last share is of an earlier frame
    }
    [[nodiscard]] bool finds_overlaps_only() const override { return may_withhold_; }
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
    /// Reports to `explain` how the pairs are found, and how many the filter kept of those that the search found.
    [[nodiscard]] std::vector<stage_plan> plans() const override {
        if (joins_)
            return {{plan_kind::set_join,
                     {"sets a and b are joined: {looked_up} boxes are looked up in an index of {stored}",
                      {{{"looked_up", amount(join_.looked_up())}, {"stored", amount(join_.stored())}}}}}};
        std::vector<stage_plan> stage_plans = searches_ ? search_->plans() : std::vector<stage_plan>();
        stage_plans.push_back({plan_kind::filter,
                               {"the filter kept {kept} of {found} pairs that the search found",
                                {{{"kept", amount(kept_pairs_)}, {"found", amount(found_)}}}}});
        if (!may_withhold_)
            stage_plans.push_back({plan_kind::filter, {"all objects are searched: pairs need not overlap"}});
        else if (indexed_ > 0)
            stage_plans.push_back({plan_kind::resting_index,
                                   {"{indexed} objects at rest are in an index, in which {movers} others are looked up",
                                    {{{"indexed", amount(indexed_)}, {"movers", amount(movers_.size())}}}}});
        else if (filter_.resting() > 0)
            stage_plans.push_back(
                {plan_kind::filter, {"objects at rest are searched: no index is worth its cost yet"}});
        if (may_withhold_ && filter_.has_sets())
            stage_plans.push_back({plan_kind::filter, {"both sets are searched: no join is worth its cost yet"}});
        return stage_plans;
    }
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

    /// Takes out of the index what does not rest any more, and decides whether those that rest are worth an index.
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
        if (indexed_ == 0 ? is_index_worth_it(unindexed) : is_rebuilding_worth_it(unindexed))
            build_index(pairs_in_vain(unindexed));
        else if (indexed_ > 0 && is_index_in_vain())
            give_up_index();
    }

    /// Estimates how many of the pairs that the search found in the last frame are of two objects at rest, as if they
    /// lay like the others.
    /// @param resting number of objects at rest that are searched
    [[nodiscard]] double pairs_in_vain(std::size_t resting) const {
        const double share = resting > 0 ? amount(resting) / amount(searched_) : 0;
        return std::min(amount(found_ - kept_pairs_), amount(found_) * share * share);
    }

    /// @param resting number of objects at rest, all of which are searched
    [[nodiscard]] bool is_index_worth_it(std::size_t resting) {
        const frame_cost searching{.searched = searched_, .found = amount(found_)};
        const frame_cost indexed{.searched = searched_ - resting,
                                 .found = amount(found_) - pairs_in_vain(resting),
                                 .watched = searched_,
                                 .opened = index_nodes_.opened_by(movers_.size(), resting)};
        return index_regret_.exceeds(ns_to_build(resting), searching.ns() - indexed.ns());
    }
    /// Whether the index has taken more than searching all objects would have, by as much as a frame of the latter.
    [[nodiscard]] bool is_index_in_vain() {
        const std::size_t n = searched_ + indexed_;
        const frame_cost indexed{.searched = searched_,
                                 .found = amount(found_),
                                 .watched = n,
                                 .opened = amount(opened_),
                                 .looked_up = amount(looked_up_)};
        const frame_cost searching{.searched = n, .found = amount(found_ + looked_up_) + pairs_in_index()};
        return index_regret_.exceeds(searching.ns(), indexed.ns() - searching.ns());
    }
    /// Whether many objects have left the index, or searching those at rest that are not in it is worth a new one.
    /// @param unindexed objects at rest that are searched
    [[nodiscard]] bool is_rebuilding_worth_it(std::size_t unindexed) {
        const frame_cost saved{.searched = unindexed, .found = pairs_in_vain(unindexed)};
        return 2 * indexed_ < index_.size() ||
               rebuilding_regret_.exceeds(ns_to_build(indexed_ + unindexed), saved.ns());
    }

    /// Estimates how many pairs of objects in the index overlap: a share of those when it was built.
    [[nodiscard]] double pairs_in_index() const {
        const double share = index_.size() > 0 ? amount(indexed_) / amount(index_.size()) : 0;
        return pairs_at_rest_ * share * share;
    }

    /// Moves every object at rest from the search to the index.
    /// @param more_pairs estimated number of pairs of those that move
    void build_index(double more_pairs) {
        pairs_at_rest_ = pairs_in_index() + more_pairs;
        rebuilding_regret_.forget();
        kept_.assign(boxes_.begin(), boxes_.end());
        index_.clear();
        for (std::uint32_t id = 0; id < places_.size(); ++id) {
            if (places_[id] == place::none || !rests(id)) continue;
            if (places_[id] == place::searched) {
                if (!is_valid(boxes_[id])) continue;  // the search rejects it
                take_out(id);
                ++indexed_;
                places_[id] = place::indexed;
            }
            index_.add(id, boxes_[id]);
        }
        index_.build(boxes_);
    }
    void give_up_index() {
        for (std::uint32_t id = 0; id < places_.size(); ++id)
            if (places_[id] == place::indexed) release_from_index(id);
        index_.clear();
    }

    void append_searched_pairs(std::vector<index_pair>& pairs) {
        const std::size_t before = pairs.size();
        if (searches_) search_->search(pairs);
        found_ = pairs.size() - before;
        remove_unkept(pairs, before);
        kept_pairs_ = pairs.size() - before;
        opened_ = looked_up_ = 0;
        if (indexed_ > 0) append_pairs_with_indexed(pairs);
    }
    void append_pairs_of_sets(std::vector<index_pair>& pairs) {
        join_.search([&](index_pair p) {
            if (keeps(p.a, p.b)) pairs.push_back(p);
        });
        count_tests(join_.opened());
    }

    /// Compares what this frame took with what it would have taken in the other way, searched or joined.
    /// @param pairs number of the frame's pairs
    void plan_join(std::size_t pairs) {
        const std::size_t n = searched_ + indexed_;
        if (joins_) {
            constexpr double share_of_draw = 1.0 / 16;
            pairs_in_sets_ += share_of_draw * (join_.pairs_within() - pairs_in_sets_);
            join_nodes_.learn(join_.looked_up(), join_.opened());
            const frame_cost joined{.refitted = n, .opened = amount(join_.opened()), .looked_up = amount(pairs)};
            const frame_cost searching{.searched = n, .found = amount(pairs) + pairs_in_sets_};
            wants_join_ = !join_regret_.exceeds(searching.ns(), joined.ns() - searching.ns());
            return;
        }
        const auto [fewer, more] = filter_.sizes_of_sets();
        const frame_cost searching{.searched = searched_,
                                   .found = amount(found_),
                                   .watched = indexed_ > 0 ? n : 0,
                                   .opened = amount(opened_),
                                   .looked_up = amount(looked_up_)};
        const frame_cost joined{
            .refitted = n, .opened = join_nodes_.opened_by(fewer, more), .looked_up = amount(pairs)};
        wants_join_ = join_regret_.exceeds(ns_to_build(more), searching.ns() - joined.ns());
        pairs_in_sets_ = amount(found_ - kept_pairs_);
    }

    void remove_unkept(std::vector<index_pair>& pairs, std::size_t first) const {
        if (object_of_.empty())
            filter_.apply(pairs, first);
        else
            filter_.apply(pairs, first, [this](std::uint32_t piece) { return object_of_[piece]; });
    }

    /// Pairs of an object that does not rest and one in the index, whose entries may be of objects that have left it.
    void append_pairs_with_indexed(std::vector<index_pair>& pairs) {
        for (const std::uint32_t mover : movers_)
            opened_ += index_.query(boxes_[mover], [&](std::uint32_t id) {
                ++looked_up_;
                if (places_[id] == place::indexed && keeps(mover, id)) pairs.push_back(ordered_pair(mover, id));
            });
        index_nodes_.learn(movers_.size(), opened_);
        count_tests(opened_);
    }
    void count_tests(std::size_t opened) noexcept {
        if (counted_ == instrumentation::counters) tests_counted_ += 8 * opened;
    }

    std::unique_ptr<global_stage> search_;
    const collision_filter& filter_;
    instrumentation counted_;
    bool may_withhold_ = search_->finds_overlaps_only();  // whether an index finds what the search would
    std::uint64_t tests_counted_ = 0;
    membership objects_;
    frame_state frame_;
    std::span<const box> boxes_;
    std::vector<std::uint32_t> object_of_;    // by piece; empty if objects are whole
    std::vector<place> places_;               // by id
    std::size_t searched_ = 0, indexed_ = 0;  // numbers of objects by place
    bool searches_ = true;                    // whether the search has the current frame
    std::size_t found_ = 0, kept_pairs_ = 0;  // by the last search, before and after the filter
    std::vector<std::uint32_t> departures_;   // since the last frame, of objects in the index
    box_index index_;                         // of objects at rest
    std::vector<box> kept_;                   // by id, those of the frame in which the index was built
    std::vector<std::uint32_t> movers_;       // present objects that do not rest
    std::size_t opened_ = 0, looked_up_ = 0;  // nodes and boxes, by the last queries of the index
    double pairs_at_rest_ = 0;                // estimated, of the objects in the index when it was built
    query_estimate index_nodes_;
    regret index_regret_, rebuilding_regret_;
    bool joins_ = false;       // the sets are joined without a search
    bool wants_join_ = false;  // the same from the next frame on
    set_join join_;
    double pairs_in_sets_ = 0;  // estimated, and at first those that the search found in vain
    query_estimate join_nodes_;
    regret join_regret_;
};

}  // namespace

std::unique_ptr<global_stage> filtered(std::unique_ptr<global_stage> search, const collision_filter& filter,
                                       instrumentation counted) {
    return std::make_unique<filtered_stage>(std::move(search), filter, counted);
}

}  // namespace aabb
