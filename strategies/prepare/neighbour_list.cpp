module aabb.prepare.neighbour_list;

import aabb.prepare.list_pause;
import aabb.prepare.pair_list;
import aabb.prepare.mean_extent;
import aabb.prepare.relative_motion;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

namespace aabb {

namespace {

/// What is kept from frame to frame.
enum class state : std::uint8_t {
    nothing,    ///< and nothing is known yet, or a search has failed
    searching,  ///< nothing, since no list was worth its cost; a few boxes are looked at now and then
    watching,   ///< the boxes of a frame, to see how far they go from there before lists are given up
    resting,    ///< the pairs of a frame, which are those of later ones until a box moves
    listing     ///< the pairs of a frame's boxes grown by a margin
};

/// What a frame shows.
enum class sight : std::uint8_t {
    as_before,  ///< what is kept holds its pairs; while no pairs are, no list is in sight
    settled,    ///< the same, and boxes no longer move
    changed,    ///< what is kept may lack some; while no pairs are, a list may be worth its cost
    arrival     ///< an object came
};

/// What is done then.
enum class step : std::uint8_t {
    search,  ///< the boxes as they are
    keep,    ///< their pairs, too: until a box moves, and to see how far it does
    plan,    ///< a list, or the next frames without one
    repeat,  ///< the pairs that are kept
    serve,   ///< those of them that meet
    settle   ///< these, and keep them
};

/// By state and sight.
constexpr step steps[5][4]{{step::plan, step::plan, step::plan, step::plan},
                           {step::search, step::search, step::keep, step::search},
                           {step::search, step::search, step::plan, step::plan},
                           {step::repeat, step::repeat, step::plan, step::keep},
                           {step::serve, step::settle, step::plan, step::plan}};

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
    void remove(std::uint32_t id) override {
        objects_.remove(id);
        search_->remove(id);
    }

    void update(std::span<const box> boxes) override {
        frame_.begin();
        require_ieee_arithmetic();
        objects_.require_boxes_for_all(boxes.size());
        boxes_ = boxes;
        // Nobody asked for the pairs of the frame that it was to be made of.
        if (std::exchange(is_to_be_made_, false)) state_ = state::nothing;
        const bool comes_any = objects_.arrivals() > 0;
        const bool leaves_any = objects_.any_departures();
        frame_.change([&] { objects_.settle(); });
        // At once: the frame may be refused yet, and who left is not told again.
        if (leaves_any && state_ >= state::resting)
            list_.erase_if([&](index_pair p) { return !objects_.contains(p.a) || !objects_.contains(p.b); });
        note_arrivals(comes_any);
        if (has_few_boxes()) {
            state_ = state::nothing;
            search_->update(boxes);
        } else {
            const sight seen = look(boxes, comes_any);
            switch (steps[static_cast<std::size_t>(state_)][static_cast<std::size_t>(seen)]) {
                case step::search: search_->update(boxes); break;
                case step::keep: keep(boxes, {0, 0}); break;
                // The boxes of who has come since others were kept say nothing, and may be none.
                case step::plan: plan(boxes, seen == sight::changed && age_ > 0 && !comes_any); break;
                case step::repeat: has_rested_ = true; break;
                case step::serve: serve(boxes); break;
                case step::settle: settle(boxes); break;
            }
        }
        ++frames_;
        frame_.taken();
    }

    void search(std::vector<index_pair>& pairs) override {
        frame_.require_taken();
        require_ieee_arithmetic();
        const std::size_t before = pairs.size();
        const bool searches = is_to_be_made_ || state_ <= state::watching;
        if (is_to_be_made_) search_->search(list_.begin());
        is_to_be_made_ = false;
        switch (state_) {
            case state::nothing:
            case state::searching:
            case state::watching: search_->search(pairs); break;
            case state::resting: pairs.insert(pairs.end(), list_.whole().begin(), list_.whole().end()); break;
            case state::listing:
                append_whole(pairs, [&] { count_tests(list_.append_to(pairs, boxes_, is_within())); });
                break;
        }
        outlook_.pairs = pairs.size() - before;
        // Where a list is made, also of its first tests, which take far less.
        share_of_update_ = searches ? search_->share_of_update() : 0;
    }

    [[nodiscard]] work_counters counters() const override {
        work_counters all = search_->counters();
        all.add(work::box_tests, tests_counted_);
        return all;
    }

    [[nodiscard]] std::vector<part_bytes> bytes() const override {
        std::vector<part_bytes> parts = search_->bytes();
        parts.push_back({"prepare", bytes_of(objects_, kept_, grown_) + list_.bytes()});
        return parts;
    }

    [[nodiscard]] double share_of_update() const override { return share_of_update_; }

    [[nodiscard]] std::vector<stage_plan> plans() const override {
        std::vector<stage_plan> all = search_->plans();
        if (state_ == state::listing)
            all.push_back({plan_kind::neighbour_list,
                           {"a list of {pairs} pairs, of boxes grown by {margin} on every side",
                            {{{"pairs", static_cast<double>(list_.size())}, {"margin", margin_}}}}});
        else if (state_ == state::resting)
            all.push_back({plan_kind::frame_at_rest, {"the pairs of a frame since which nothing has moved"}});
        return all;
    }

    [[nodiscard]] std::vector<omission> left_out() const override {
        std::vector<omission> absent = search_->left_out();
        if (state_ <= state::watching)
            absent.push_back({absence::neighbour_list, has_few_boxes() ? "so few boxes are searched as soon as watched"
                                                       : expected_ < fewest_frames_of_first_list
                                                           ? "none has been seen to repay its making in so few frames"
                                                           : "boxes move too far, or come too often, for one to pay"});
        return absent;
    }

private:
    struct next_list {
        std::size_t frames;  ///< that it is to serve; 0 where nobody reckoned
        double margin;
        bool about_kept = false;  ///< boxes, not those of this frame
    };

    [[nodiscard]] bool adapts() const noexcept { return !config_.margin && config_.every == 0; }
    [[nodiscard]] bool has_few_boxes() const noexcept { return adapts() && objects_.size() < fewest_boxes; }
    /// Whether pairs that are sure meet in this frame.
    [[nodiscard]] bool is_within() const noexcept { return moved_.both_ways <= margin_; }

    /// No list serves beyond the next arrival, which is to come as soon as the last one did, or later where it is late.
    void note_arrivals(bool any) noexcept {
        if (any && frames_ > 0) between_arrivals_ = since_arrival_;
        since_arrival_ = any ? 1 : since_arrival_ + 1;
        const std::size_t until_arrival = std::max(between_arrivals_, since_arrival_);
        const std::size_t until_end =
            frames_ >= expected_ ? std::numeric_limits<std::size_t>::max() : expected_ - frames_;
        outlook_.boxes = objects_.size();
        outlook_.horizon = {.frames_left = std::min(until_arrival, until_end), .in_new_memory = grown_.capacity() == 0};
    }

    [[nodiscard]] sight look(std::span<const box> boxes, bool comes_any) {
        if (state_ == state::nothing) return sight::changed;
        if (state_ == state::searching) return look_at_few(boxes);
        if (comes_any || boxes.size() != kept_.size())
            // Whoever comes to boxes at rest does not make them move.
            return state_ == state::resting && !has_rested_ ? sight::changed : sight::arrival;
        if (state_ == state::resting && std::memcmp(boxes.data(), kept_.data(), boxes.size_bytes()) == 0)
            return sight::as_before;
        ++age_;
        // Ever less often, as long as nothing hangs on it.
        if (state_ == state::watching && !std::has_single_bit(age_)) return sight::as_before;
        const bool is_due = config_.every > 0 && age_ >= config_.every;
        if (config_.every > 0 && config_.margin) return is_due ? sight::changed : sight::as_before;
        const relative_motion before = std::exchange(moved_, motion_between(kept_, boxes, objects_));
        outlook_.law.observe(age_, moved_.margin);
        if (config_.every > 0) return is_due ? sight::changed : sight::as_before;
        if (state_ != state::listing || moved_.margin > margin_) return sight::changed;
        if (!adapts()) return sight::as_before;
        if (age_ == made_at_ + 1 && !pays(objects_.size(), outlook_.pairs, list_.size())) {
            // Not since boxes moved too far.
            planned_ = 0;
            return sight::changed;
        }
        // As far as in the frame before, to the last bit, are boxes that stand; what falls together moves by roundings.
        return age_ > 1 && moved_ == before ? sight::settled : sight::as_before;
    }

    [[nodiscard]] sight look_at_few(std::span<const box> boxes) {
        if (!pause_.lasts()) return sight::changed;
        if (pause_.pass(boxes, objects_, outlook_, drawn_)) {
            // What lists held so long ago tells nothing.
            outlook_.correction = 1;
            release(kept_);
            release(grown_);
            list_.release();
        }
        return pause_.lasts() ? sight::as_before : sight::changed;
    }

    /// Whether half of a list would not be worth its cost, by a rough count of it: it may hold each box with every
    /// other, whatever is reckoned.
    [[nodiscard]] bool is_far_too_long(std::span<const box> boxes, double margin) {
        // So few of a sample may be in reach by chance.
        constexpr std::size_t by_chance = 8;
        const rough_reach reach = rough_reach_of(boxes, objects_, drawn_, margin);
        const auto overlapping = std::max(outlook_.pairs, static_cast<std::size_t>(reach.overlapping));
        return reach.counted >= by_chance &&
               !pays(objects_.size(), overlapping, static_cast<std::size_t>(reach.in_reach / 2));
    }

    /// Before anything is known.
    [[nodiscard]] std::optional<next_list> first_list(std::span<const box> boxes) {
        outlook_.pairs = 0;
        outlook_.look_anew(boxes, objects_, drawn_);
        if (outlook_.horizon.frames_left < fewest_frames_of_first_list) {
            pause_.begin_with_look();
            static_cast<void>(look_at_few(boxes));
            return std::nullopt;
        }
        const double margin = typical_extents(extents_of_first_margin, boxes, objects_);
        return next_list{0, is_far_too_long(boxes, margin) ? 0 : margin};
    }

    /// The list that costs least from how far boxes moved, or the last one again where that lasted as planned; none
    /// where none is worth its cost, or boxes move by far more than was thought and are to be watched.
    [[nodiscard]] std::optional<next_list> planned_list(std::span<const box> boxes, bool has_ended) {
        const bool is_list = state_ == state::listing;
        const bool has_failed = has_ended && is_list && 2 * (age_ - made_at_) < planned_;
        // Else the pause that may follow is longer than the last one.
        if (is_list ? !has_failed : has_rested_) pause_.shorten();
        if (has_failed) return std::nullopt;
        if (has_ended && is_list && made_at_ == 0 && planned_ <= age_ && age_ < 2 * planned_ &&
            repeated_ < longest_repetition && !is_far_too_long(boxes, margin_)) {
            ++repeated_;
            return next_list{planned_, margin_};
        }
        repeated_ = 0;
        outlook_.look_anew(boxes, objects_, drawn_);
        if (is_list) outlook_.learn(margin_, list_.size());
        const list_plan best = plan_list(outlook_);
        next_list next{best.frames, best.margin};
        // What gets less far than a random walk swings about its place. Of that it is known how far it goes from the
        // boxes that are kept, but not from those of this frame, which may be at one end of their ways.
        constexpr double random_walk = 0.5;
        if (best.frames > 1 && has_ended && outlook_.law.exponent() < random_walk)
            next = {best.frames, outlook_.law.after(age_ + best.frames - 1), true};
        if (best.frames < 2 || is_far_too_long(boxes, next.margin)) return std::nullopt;
        return next;
    }

    void plan(std::span<const box> boxes, bool has_ended) {
        std::optional<next_list> next;
        if (config_.margin) {
            outlook_.look_anew(boxes, objects_, drawn_);
            next = {0, typical_extents(*config_.margin, boxes, objects_)};
        } else if (config_.every > 0) {
            const displacement_law& law = outlook_.law;
            next = {0, law.age() == 0 || config_.every == 1 ? 0 : law.after(config_.every - 1)};
        } else if (state_ == state::nothing) {
            next = first_list(boxes);
        } else {
            next = planned_list(boxes, has_ended);
        }
        if (next) return keep(boxes, *next);
        if (state_ != state::nothing && has_ended && age_ < longest_watch) {
            state_ = state::watching;
        } else {
            if (state_ != state::nothing) pause_.begin(objects_.size());
            state_ = state::searching;
        }
        search_->update(boxes);
    }

    /// A list; or where it has no margin and may be given up, the pairs of these boxes until they move.
    void keep(std::span<const box> boxes, next_list next) {
        state_ = state::nothing;
        margin_ = margin_when_made_ = next.margin;
        if (!next.about_kept) {
            kept_.assign(boxes.begin(), boxes.end());
            age_ = 0;
            moved_ = {};
            outlook_.law.begin();
        }
        made_at_ = age_;
        planned_ = next.frames;
        has_rested_ = false;
        if (margin_ > 0) {
            // Grown, an inverted box may be none. As they are, the search looks at them.
            require_valid(boxes);
            grown_.resize(boxes.size());
            grow(kept_, margin_, grown_);
        }
        search_->update(margin_ > 0 ? std::span<const box>(grown_) : boxes);
        is_to_be_made_ = true;
        state_ = adapts() && margin_ == 0 ? state::resting : state::listing;
    }

    /// A frame in which the list holds all pairs. At an age of two frames it shows how long it will serve.
    void serve(std::span<const box> boxes) {
        require_valid(boxes);
        if (adapts()) shorten_if_it_pays();
        if (config_.every == 0 && age_ == made_at_ + 2 && pays_to_tell_sure(outlook_, list_.size(), margin_))
            list_.tell_sure(kept_, margin_);
    }

    /// Those that meet are all pairs until boxes move.
    void settle(std::span<const box> boxes) {
        require_valid(boxes);
        if (!is_within()) list_.forget_sure();
        count_tests(list_.tested());
        list_.keep_meeting(boxes);
        list_.forget_sure();
        kept_.assign(boxes.begin(), boxes.end());
        margin_ = 0;
        planned_ = 0;
        age_ = 0;
        made_at_ = 0;
        has_rested_ = true;
        outlook_.law.forget();
        state_ = state::resting;
    }

    /// Makes the list that a smaller margin would have made, without a search: where boxes move by so much less than
    /// this one allows that it holds many in vain. It is to serve for four times as long as it has; looked at ever less
    /// often.
    void shorten_if_it_pays() {
        constexpr std::size_t first_look = 8;
        constexpr std::size_t times_as_long = 4;
        // Shorter, it lists hardly fewer, and roundings may end it.
        constexpr double shortest = 1.0 / 16;
        if (age_ < first_look || !std::has_single_bit(age_)) return;
        const std::size_t frames = times_as_long * age_;
        if (!pays_to_shorten(objects_.size(), outlook_.pairs, list_.tested(), frames - age_)) return;
        const double margin = std::max(outlook_.law.after(frames), shortest * margin_when_made_);
        if (!(margin < margin_ / 2)) return;
        margin_ = margin;
        planned_ = 0;
        grow(kept_, margin_, grown_);
        count_tests(list_.tested());
        list_.keep_meeting(grown_);
        list_.tell_sure(kept_, margin_);
    }

    void count_tests(std::size_t tests) noexcept {
        if (counted_ == instrumentation::counters) tests_counted_ += tests;
    }

    /// Fewer are searched in the time that it takes to watch them.
    static constexpr std::size_t fewest_boxes = 2 * simd::width + 1;
    /// Of fewer frames in all, the first one gets no list: how boxes move is not known, and a list that is made in new
    /// memory takes as long as searching several frames.
    static constexpr std::size_t fewest_frames_of_first_list = 64;
    /// Of the first list, in typical extents: the best where one margin must do for any scene.
    static constexpr double extents_of_first_margin = 0.1;
    /// Frames for which boxes are watched before lists are given up.
    static constexpr std::size_t longest_watch = 8;
    /// So many lists are made by one plan: pairs may become more or fewer meanwhile.
    static constexpr unsigned longest_repetition = 8;

    std::unique_ptr<global_stage> search_;
    neighbour_list_prepare::config config_;
    instrumentation counted_;
    std::uint64_t tests_counted_ = 0;
    membership objects_;
    frame_state frame_;
    std::span<const box> boxes_;
    state state_ = state::nothing;
    bool is_to_be_made_ = false;  // the list, in the search
    double share_of_update_ = 0;
    std::vector<box> kept_;   // boxes that the list is about
    std::vector<box> grown_;  // the same with their margin
    pair_list list_;          // what it found, less the pairs of objects that have left
    double margin_ = 0;
    double margin_when_made_ = 0;  // of the list, which may have been shortened since
    relative_motion moved_{};      // from the kept boxes to those of this frame
    std::size_t age_ = 0;          // frames for which they have been watched
    std::size_t made_at_ = 0;      // age at which the list was made
    bool has_rested_ = false;      // for some frames
    std::size_t planned_ = 0;      // frames that the list is to serve; 0 where nobody reckoned
    unsigned repeated_ = 0;        // lists made since by the same plan
    list_outlook outlook_;
    list_pause pause_;
    std::uint32_t drawn_ = 0;  // see `drawn_id`
    std::size_t frames_ = 0;   // before this one
    std::size_t expected_ = std::numeric_limits<std::size_t>::max();
    std::size_t since_arrival_ = 0;  // frames
    std::size_t between_arrivals_ = std::numeric_limits<std::size_t>::max();
};

}  // namespace

std::unique_ptr<global_stage> neighbour_list_prepare::before(std::unique_ptr<global_stage> search,
                                                             instrumentation counted) const {
    return std::make_unique<neighbour_list_stage>(std::move(search), config_, counted);
}

}  // namespace aabb
