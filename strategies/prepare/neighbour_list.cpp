module aabb.prepare.neighbour_list;

import aabb.prepare.list_backoff;
import aabb.prepare.pair_list;
import aabb.prepare.mean_extent;
import aabb.prepare.relative_motion;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb {

namespace {

/// What is kept between frames.
enum class state : std::uint8_t {
    nothing,    ///< nothing is known yet, or a search has failed
    searching,  ///< no list was worth its cost; every frame is searched, and a sample of boxes is watched now and then
    watching,   ///< the boxes of one frame are kept to measure their displacement before Verlet lists are given up
    resting,    ///< the pairs of one frame are kept and stay valid until a box moves
    listing     ///< a Verlet list is kept: the pairs of boxes grown by the skin
};

/// What the boxes of the current frame show about the kept ones.
enum class observation : std::uint8_t {
    complete,  ///< the kept pairs are still complete; without kept pairs, no list is worth its cost yet
    settled,   ///< the kept pairs are still complete, and boxes have stopped moving
    changed,   ///< the kept pairs may be incomplete; without kept pairs, a list may be worth its cost
    arrival    ///< an object has been inserted
};

/// How the pairs of the current frame are computed.
enum class action : std::uint8_t {
    search,  ///< search the boxes as they are
    keep,    ///< search them and keep their pairs until a box moves, to measure how far it moves
    plan,    ///< plan a new list, or the next frames without one
    repeat,  ///< report the kept pairs unchanged
    serve,   ///< report the listed pairs that overlap
    settle   ///< report the listed pairs that overlap, and keep only these
};

/// The action of a frame, by state and observation.
constexpr action actions[5][4]{{action::plan, action::plan, action::plan, action::plan},
                               {action::search, action::search, action::keep, action::search},
                               {action::search, action::search, action::plan, action::plan},
                               {action::repeat, action::repeat, action::plan, action::keep},
                               {action::serve, action::settle, action::plan, action::plan}};

class neighbour_list_stage final : public global_stage {
public:
    neighbour_list_stage(std::unique_ptr<global_stage> search, const neighbour_list_prepare::config& config,
                         instrumentation counted)
        : search_(std::move(search)), config_(config), counted_(counted) {}

    void expect(std::size_t frames) override { expected_ = frames; }
    void insert(std::uint32_t id) override {
        objects_.insert(id);
        frame_.change([&] { search_->insert(id); });
    }
    void insert_all(std::span<const std::uint32_t> ids) override {
        objects_.insert_all(ids);
        frame_.change([&] { search_->insert_all(ids); });
    }
    void remove(std::uint32_t id) override {
        objects_.remove(id);
        search_->remove(id);
    }
    void moved(std::span<const std::uint32_t> ids) override { objects_.moved(ids); }

    /// Finds the pairs of this frame by a search, or from a Verlet list: the pairs whose boxes, grown by a margin,
    /// overlapped earlier. `actions` chooses by what is kept (`state_`) and how boxes have moved since (`observation`).
    void update(std::span<const box> boxes) override {
        if (!frame_.is_taken()) objects_.forget_moved();  // since a frame that was not taken
        frame_.begin();
        require_ieee_arithmetic();
        objects_.require_boxes_for_all(boxes.size());
        boxes_ = boxes;
        // The pairs of the frame in which the list was planned were never requested, so the list does not exist.
        if (std::exchange(is_list_pending_, false)) state_ = state::nothing;
        const bool any_arrivals = objects_.arrivals() > 0;
        const bool any_leave = objects_.any_departures();
        moved_objects_ = objects_.moved();
        frame_.change([&] { objects_.settle(); });
        // Departures are reported only once, so they are applied now, even if this frame is rejected later.
        if (any_leave && keeps_pairs())
            list_.erase_if([&](index_pair p) { return !objects_.contains(p.a) || !objects_.contains(p.b); });
        record_arrivals(any_arrivals);
        if (is_below_list_threshold()) {
            state_ = state::nothing;  // for so few boxes, searching is cheapest
            search_boxes(boxes);
        } else {
            const observation seen = observe_motion(boxes, any_arrivals);
            switch (actions[static_cast<std::size_t>(state_)][static_cast<std::size_t>(seen)]) {
                case action::search: search_boxes(boxes); break;
                case action::keep: start_list(boxes, list_after_sample(boxes)); break;
                // Objects inserted since the boxes were kept have no valid kept box, so their motion is unknown.
                case action::plan: plan(boxes, seen == observation::changed && age_ > 0 && !any_arrivals); break;
                case action::repeat: has_rested_ = true; break;
                case action::serve: serve(boxes); break;
                case action::settle: settle(boxes); break;
            }
        }
        ++frames_;
        frame_.taken();
    }

    /// Appends the pairs found by the search, all kept pairs of resting boxes, or those of the list that overlap.
    void search(std::vector<index_pair>& pairs) override {
        frame_.require_taken();
        require_ieee_arithmetic();
        const std::size_t before = pairs.size();
        const bool searches = is_list_pending_ || !keeps_pairs();
        // `update` gave the search boxes grown by the margin; the pairs that it finds become the list.
        if (is_list_pending_) search_->search(list_.begin_search());
        is_list_pending_ = false;
        switch (state_) {
            case state::nothing:
            case state::searching:
            case state::watching: search_->search(pairs); break;
            case state::resting: pairs.insert(pairs.end(), list_.pairs().begin(), list_.pairs().end()); break;
            case state::listing:
                append_guard guard(pairs);
                // Until boxes have moved too far, pairs that overlapped deeply still overlap and need no test.
                count_tests(list_.append_to(pairs, boxes_, certain_pairs_hold()));
                guard.keep();
                break;
        }
        estimate_.pairs = pairs.size() - before;
        // The share of the time taken here that belongs to the update, as the search defers sorting. In a frame that
        // makes a list, it is applied to the tests of the list as well, which take far less time than the search.
        share_of_update_ = searches ? search_->share_of_update() : 0;
    }

    [[nodiscard]] work_counters counters() const override {
        work_counters total = search_->counters();
        total.add(work::box_tests, tests_counted_);
        return total;
    }
    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        std::vector<part_bytes> parts = search_->bytes();
        parts.push_back({"prepare", bytes_of(objects_, kept_, grown_) + list_.bytes()});
        return parts;
    }
    [[nodiscard]] double share_of_update() const override { return share_of_update_; }
    /// Reports to `explain` the plans of the search, and whether a list or earlier pairs serve this frame.
    [[nodiscard]] std::vector<stage_plan> plans() const override {
        std::vector<stage_plan> stage_plans = search_->plans();
        if (state_ == state::listing)
            stage_plans.push_back({plan_kind::neighbour_list,
                                   {"a Verlet list of {pairs} pairs of boxes, with a skin of {margin}",
                                    {{{"pairs", static_cast<double>(list_.size())}, {"margin", margin_}}}}});
        else if (state_ == state::resting)
            stage_plans.push_back(
                {plan_kind::static_frame, {"the pairs of the last frame that was searched, until a box moves"}});
        return stage_plans;
    }

    /// Reports to `explain` what the search leaves out, and why no list is kept, if none is.
    [[nodiscard]] std::vector<omission> left_out() const override {
        std::vector<omission> absent = search_->left_out();
        if (!keeps_pairs()) absent.push_back({absence::neighbour_list, why_no_list()});
        return absent;
    }

private:
    struct next_list {
        std::size_t frames;  ///< number of frames that the list is planned to serve; 0 if unplanned
        double margin;
        bool around_kept_boxes = false;  ///< the list is built from the kept boxes instead of those of this frame
    };

    [[nodiscard]] bool keeps_pairs() const noexcept { return state_ == state::resting || state_ == state::listing; }
    [[nodiscard]] bool is_adaptive() const noexcept { return !config_.margin && config_.every == 0; }
    [[nodiscard]] bool is_below_list_threshold() const noexcept {
        return is_adaptive() && objects_.size() < fewest_boxes;
    }
    [[nodiscard]] std::string_view why_no_list() const noexcept {
        if (is_below_list_threshold()) return "none yet, not worth its cost for so few boxes";
        return "none yet, not worth its cost by the motion seen so far";
    }
    /// Whether the pairs marked as certain are guaranteed to overlap in this frame.
    [[nodiscard]] bool certain_pairs_hold() const noexcept { return moved_.in_both_directions <= margin_; }

    /// Estimates how many frames the next list can serve: until the next insertion, which ends every list, or the last
    /// frame. It is expected after the interval between the last two or, once that has passed, as long again.
    /// @param any whether an object was inserted for this frame
    void record_arrivals(bool any) noexcept {
        if (any && frames_ > 0) between_arrivals_ = since_arrival_;
        since_arrival_ = any ? 1 : since_arrival_ + 1;
        const std::size_t until_arrival = std::max(between_arrivals_, since_arrival_);
        const std::size_t until_end =
            frames_ >= expected_ ? std::numeric_limits<std::size_t>::max() : expected_ - frames_;
        estimate_.boxes = objects_.size();
        estimate_.horizon = {.frames_left = std::min(until_arrival, until_end),
                             .in_new_memory = grown_.capacity() == 0};
    }

    /// What motion since the boxes were kept means for the kept pairs; measured only where something depends on it.
    [[nodiscard]] observation observe_motion(std::span<const box> boxes, bool any_arrivals) {
        if (state_ == state::nothing) return observation::changed;
        if (state_ == state::searching) return observe_sample(boxes);
        if (any_arrivals || boxes.size() != kept_.size())
            // An object inserted among resting boxes does not make them move.
            return state_ == state::resting && !has_rested_ ? observation::changed : observation::arrival;
        if (state_ == state::resting && std::memcmp(boxes.data(), kept_.data(), boxes.size_bytes()) == 0)
            return observation::complete;
        ++age_;
        // While watching no result depends on the motion, so it is measured at power-of-two ages only.
        if (state_ == state::watching && !std::has_single_bit(age_)) return observation::complete;
        const bool has_fixed_age = config_.every > 0;  // a new list at this age, whatever moves
        const relative_motion before = moved_;
        if (!has_fixed_age || !config_.margin) {
            moved_ = motion_between(kept_, boxes, objects_);
            estimate_.law.observe(age_, moved_.margin);
        }
        if (has_fixed_age) return age_ >= config_.every ? observation::changed : observation::complete;
        if (state_ != state::listing || moved_.margin > margin_) return observation::changed;
        return is_adaptive() ? observe_list(before) : observation::complete;
    }

    /// Decides whether a list that is still complete is worth keeping, and whether its boxes have come to rest.
    /// @param before the motion from the kept boxes to those of the previous frame
    [[nodiscard]] observation observe_list(const relative_motion& before) {
        if (age_ == age_when_made_ + 1 && !is_list_worth_it(objects_.size(), estimate_.pairs, list_.size())) {
            planned_frames_ = 0;  // the list ends because of its length, not because boxes moved too far
            return observation::changed;
        }
        // Boxes at rest keep the same motion bit for bit; boxes that fall together differ by rounding errors.
        return age_ > 1 && moved_ == before ? observation::settled : observation::complete;
    }

    /// During a back-off, in which no list is worth its cost: watches a sample of boxes, whose motion may end it.
    /// @returns `changed` if a list may be worth its cost again, else `complete`
    [[nodiscard]] observation observe_sample(std::span<const box> boxes) {
        if (!backoff_.is_active()) return observation::changed;
        if (backoff_.advance_frame(boxes, objects_, estimate_, ids_drawn_)) {
            estimate_.correction = 1;  // learned from lists that are too old to predict the next one
            // No list is expected soon, so the memory of the last one is released.
            release(kept_);
            release(grown_);
            list_.release();
        }
        return backoff_.is_active() ? observation::complete : observation::changed;
    }

    /// Whether even half of the estimated list would not be worth its cost. A sampled count guards against scenes in
    /// which the model underestimates, up to every box listed with every other.
    [[nodiscard]] bool is_far_too_long(std::span<const box> boxes, double margin) {
        constexpr std::size_t by_chance = 8;  // fewer sampled pairs may lie within the margin by chance
        const pair_estimate estimate = estimate_pairs(boxes, objects_, ids_drawn_, margin);
        const auto overlapping = std::max(estimate_.pairs, static_cast<std::size_t>(estimate.overlapping));
        return estimate.counted >= by_chance &&
               !is_list_worth_it(objects_.size(), overlapping, static_cast<std::size_t>(estimate.within_margin / 2));
    }

    /// Nothing is known yet about the motion: watches a sample of boxes, which is to show that a list will serve.
    void begin_sample(std::span<const box> boxes) {
        estimate_.pairs = 0;
        backoff_.begin_with_sample();
        static_cast<void>(observe_sample(boxes));
        awaits_first_list_ = true;
    }

    /// What is kept once a sample has shown that a list will serve: the pairs until a box moves, to measure how far it
    /// moves. The first list of many frames has a default margin instead, since a young sample says little about them.
    [[nodiscard]] next_list list_after_sample(std::span<const box> boxes) {
        next_list next{.frames = 0, .margin = 0};
        const double least = plan_list(estimate_).margin;
        if (!std::exchange(awaits_first_list_, false) || estimate_.horizon.frames_left < many_frames || !(least > 0))
            return next;
        const double margin = std::max(least, typical_extents(extents_of_first_margin, boxes, objects_));
        if (!is_far_too_long(boxes, margin)) next.margin = margin;
        return next;
    }

    /// Repeats the last plan if its list lasted as planned, else plans for the displacement since boxes were kept.
    /// @param is_motion_known whether this displacement is known, and has ended what was kept
    /// @returns nullopt if no list is worth its cost, or if the last one ended before half of its planned frames: then
    /// boxes moved much farther than estimated, and must be watched before the next plan
    [[nodiscard]] std::optional<next_list> planned_list(std::span<const box> boxes, bool is_motion_known) {
        const bool had_list = state_ == state::listing;
        const std::size_t frames_served = age_ - age_when_made_;
        const bool ended_early = is_motion_known && had_list && 2 * frames_served < planned_frames_;
        // After a list that served half of its planned frames, or boxes at rest, the next back-off is short again.
        if (had_list ? !ended_early : has_rested_) backoff_.shorten();
        if (ended_early) return std::nullopt;
        // A list around boxes that had been kept before (age_when_made_ > 0) is not repeated: this one would be around
        // the boxes of this frame.
        const bool ended_as_planned = is_motion_known && had_list && age_when_made_ == 0 &&
                                      planned_frames_ <= frames_served && frames_served < 2 * planned_frames_;
        if (ended_as_planned && repeated_ < longest_repetition && !is_far_too_long(boxes, margin_)) {
            ++repeated_;
            return next_list{.frames = planned_frames_, .margin = margin_};
        }
        repeated_ = 0;
        return cheapest_list(boxes, is_motion_known);
    }

    /// Plans the list with the least cost per frame for the displacement observed since the boxes were kept.
    /// @returns nullopt if no list is worth its cost
    [[nodiscard]] std::optional<next_list> cheapest_list(std::span<const box> boxes, bool is_motion_known) {
        estimate_.resample(boxes, objects_, ids_drawn_);
        if (state_ == state::listing) estimate_.learn(margin_, list_.size());
        const list_plan best = plan_list(estimate_);
        // Below the exponent of a random walk, boxes oscillate. Their displacement is known relative to the kept boxes,
        // but not relative to those of this frame, which may be at an extreme of the oscillation.
        constexpr double random_walk = 0.5;
        const bool oscillate = best.frames > 1 && is_motion_known && estimate_.law.exponent() < random_walk;
        next_list next{.frames = best.frames,
                       .margin = oscillate ? estimate_.law.displacement_after(age_ + best.frames - 1) : best.margin,
                       .around_kept_boxes = oscillate};
        if (best.frames < 2 || is_far_too_long(boxes, next.margin)) return std::nullopt;
        return next;
    }

    /// Starts a list with the configured or estimated margin. If none is worth its cost, frames are searched:
    /// up to `longest_watch` of them while motion is observed, then for a back-off.
    void plan(std::span<const box> boxes, bool is_motion_known) {
        std::optional<next_list> next;
        if (config_.margin) {
            estimate_.resample(boxes, objects_, ids_drawn_);
            next = next_list{.frames = 0, .margin = typical_extents(*config_.margin, boxes, objects_)};
        } else if (config_.every > 0) {
            const displacement_law& law = estimate_.law;
            const bool needs_no_margin = law.age() == 0 || config_.every == 1;
            next = next_list{.frames = 0, .margin = needs_no_margin ? 0 : law.displacement_after(config_.every - 1)};
        } else if (state_ == state::nothing) {
            begin_sample(boxes);
        } else {
            next = planned_list(boxes, is_motion_known);
        }
        if (next) return start_list(boxes, *next);
        if (state_ != state::nothing && is_motion_known && age_ < longest_watch) {
            state_ = state::watching;
        } else {
            if (state_ != state::nothing) backoff_.begin(objects_.size());
            state_ = state::searching;
        }
        search_boxes(boxes);
    }

    /// Gives the boxes to the search as they are and, if it has those of the previous frame, the objects that moved.
    void search_boxes(std::span<const box> boxes) {
        if (moved_objects_ && frames_searched_ == frames_) search_->moved(*moved_objects_);
        search_->update(boxes);
        frames_searched_ = frames_ + 1;
    }

    /// Starts a list: gives the boxes, grown by the margin, to the search; the pairs that it finds become the list.
    /// With a margin of 0 that was not configured, the list is the result itself until a box moves (`resting`).
    void start_list(std::span<const box> boxes, next_list next) {
        state_ = state::nothing;
        margin_ = margin_when_made_ = next.margin;
        if (!next.around_kept_boxes) {
            kept_.assign(boxes.begin(), boxes.end());
            age_ = 0;
            moved_ = {};
            estimate_.law.begin();
        }
        age_when_made_ = age_;
        planned_frames_ = next.frames;
        has_rested_ = false;
        if (margin_ > 0) {
            // Growing may turn an inverted box into a valid one, which the search could not reject any more.
            require_valid(boxes);
            grown_.resize(boxes.size());
            grow(kept_, margin_, grown_);
        }
        search_->update(margin_ > 0 ? std::span<const box>(grown_) : boxes);
        is_list_pending_ = true;
        state_ = is_adaptive() && margin_ == 0 ? state::resting : state::listing;
    }

    /// Serves a frame from a complete list. After two frames its remaining lifetime can be estimated.
    void serve(std::span<const box> boxes) {
        require_valid(boxes);
        if (is_adaptive()) shorten_if_worth_it();
        if (config_.every == 0 && age_ == age_when_made_ + 2 && is_marking_worth_it(estimate_, list_.size(), margin_))
            list_.mark_certain_pairs(kept_, margin_);
    }

    /// Called when all boxes have come to rest: reduces the list to the overlapping pairs, which are the result of
    /// every frame until a box moves.
    void settle(std::span<const box> boxes) {
        require_valid(boxes);
        // Certain pairs overlap without a test, unless boxes have moved too far: then they are tested like the others.
        if (!certain_pairs_hold()) list_.forget_certain();
        count_tests(list_.tests_per_frame());
        list_.keep_overlapping(boxes);
        list_.forget_certain();  // the pairs at rest are a list without certain ones
        kept_.assign(boxes.begin(), boxes.end());
        margin_ = 0;
        age_ = age_when_made_ = planned_frames_ = 0;
        has_rested_ = true;
        estimate_.law.forget();
        state_ = state::resting;
    }

    /// Reduces the list to a smaller margin, without a search, if boxes move much less than the current one allows.
    /// Considered at power-of-two ages of the list; the smaller margin is to suffice until four times this age.
    void shorten_if_worth_it() {
        constexpr std::size_t least_age = 8;
        constexpr std::size_t times_as_long = 4;
        // A smaller margin would hardly shorten the list, and rounding errors could end it.
        constexpr double shortest = 1.0 / 16;
        if (age_ < least_age || !std::has_single_bit(age_)) return;
        const std::size_t frames = times_as_long * age_;
        if (!is_shortening_worth_it(objects_.size(), estimate_.pairs, list_.tests_per_frame(), frames - age_)) return;
        const double margin = std::max(estimate_.law.displacement_after(frames), shortest * margin_when_made_);
        if (!(margin < margin_ / 2)) return;
        margin_ = margin;
        planned_frames_ = 0;
        grow(kept_, margin_, grown_);
        count_tests(list_.tests_per_frame());
        list_.keep_overlapping(grown_);
        list_.mark_certain_pairs(kept_, margin_);
    }

    void count_tests(std::size_t tests) noexcept {
        if (counted_ == instrumentation::counters) tests_counted_ += tests;
    }

    /// Searching fewer boxes takes no longer than watching them.
    static constexpr std::size_t fewest_boxes = 2 * simd::width + 1;
    /// The margin of the first list, in typical extents: the best single margin over the benchmark scenes.
    static constexpr double extents_of_first_margin = 0.1;
    static constexpr std::size_t many_frames = 64;
    /// Frames for which boxes are watched before lists are given up.
    static constexpr std::size_t longest_watch = 8;
    /// A plan is repeated at most this often, since the number of pairs may change meanwhile.
    static constexpr unsigned longest_repetition = 8;

    std::unique_ptr<global_stage> search_;
    neighbour_list_prepare::config config_;
    instrumentation counted_;
    std::uint64_t tests_counted_ = 0;
    membership objects_;
    frame_state frame_;
    std::span<const box> boxes_;
    state state_ = state::nothing;
    bool is_list_pending_ = false;  // the next search fills the list
    double share_of_update_ = 0;
    std::vector<box> kept_;           // reference boxes from which the list was made
    std::vector<box> grown_;          // the reference boxes grown by the margin
    pair_list list_;                  // the pairs of the grown boxes, without those of removed objects
    double margin_ = 0;               // the skin of the Verlet list
    double margin_when_made_ = 0;     // the margin before the list was shortened
    relative_motion moved_{};         // motion from the kept boxes to those of this frame
    std::size_t age_ = 0;             // number of frames since the boxes were kept
    std::size_t age_when_made_ = 0;   // age at which the list was made
    bool has_rested_ = false;         // boxes have been at rest for at least one frame
    std::size_t planned_frames_ = 0;  // number of frames that the list is planned to serve; 0 if unplanned
    unsigned repeated_ = 0;           // number of lists made since by the same plan
    list_estimate estimate_;
    list_backoff backoff_;
    bool awaits_first_list_ = false;
    std::uint32_t ids_drawn_ = 0;      // see `draw_id`
    std::size_t frames_ = 0;           // number of earlier frames
    std::size_t frames_searched_ = 0;  // number of frames up to the last one that was searched as it was
    std::optional<std::span<const std::uint32_t>> moved_objects_;  // since the previous frame, if known
    std::size_t expected_ = std::numeric_limits<std::size_t>::max();
    std::size_t since_arrival_ = 0;  // number of frames
    std::size_t between_arrivals_ = std::numeric_limits<std::size_t>::max();
};

}  // namespace

std::unique_ptr<global_stage> neighbour_list_prepare::before(std::unique_ptr<global_stage> search,
                                                             instrumentation counted) const {
    return std::make_unique<neighbour_list_stage>(std::move(search), config_, counted);
}

}  // namespace aabb
