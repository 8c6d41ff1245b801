module;
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

module aabb.prepare.neighbour_list;

import aabb.base;
import aabb.costs;
import aabb.counters;
import aabb.geometry;
import aabb.global_search;
import aabb.pipeline;
import aabb.prepare.grown_boxes;
import aabb.prepare.list_forecast;
import aabb.prepare.list_pause;
import aabb.prepare.list_plan;
import aabb.prepare.pair_list;
import aabb.prepare.mean_extent;
import aabb.prepare.reach;
import aabb.prepare.relative_motion;
import aabb.prepare.rest_watch;
import aabb.simd;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

namespace aabb {

namespace {

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
    void update(std::span<const box> boxes) override;
    void search(std::vector<index_pair>& pairs) override;
    [[nodiscard]] work_counters counters() const override;
    [[nodiscard]] std::vector<part_bytes> bytes() const override;
    [[nodiscard]] std::vector<std::string> plans() const override;
    [[nodiscard]] std::vector<omission> left_out() const override;

private:
    /// Where the pairs of a frame come from.
    enum class source : std::uint8_t {
        list,   ///< which may hold others too
        whole,  ///< the list, which is of these very boxes
        search  ///< of these boxes, of which nothing is kept
    };

    struct wanted_list {
        double margin;
        bool about_kept = false;  ///< about the boxes in `kept_`, not those of this frame
    };

    /// Whether pairs that are sure meet in this frame.
    [[nodiscard]] bool is_within() const noexcept { return moved_both_ways_ <= margin_; }
    /// In what a plan promises.
    [[nodiscard]] double trust() const noexcept {
        return objects_.size() <= hardly_any_boxes ? trust_in_hardly_any * trust_ : trust_;
    }
    /// Whether the list is to serve more than a few frames yet, as far as anybody reckoned.
    [[nodiscard]] bool is_to_serve_on() const noexcept { return planned_ == 0 || planned_ >= age_ + frames_of_sure; }
    [[nodiscard]] bool adapts() const noexcept { return !config_.margin && config_.every == 0; }
    [[nodiscard]] bool rests(std::span<const box> boxes);
    [[nodiscard]] bool serves(std::span<const box> boxes);
    [[nodiscard]] std::optional<wanted_list> next_list(std::span<const box> boxes, bool same_objects);
    [[nodiscard]] std::optional<wanted_list> watched(std::span<const box> boxes, bool same_objects);
    void pass_over(std::span<const box> boxes);
    [[nodiscard]] std::optional<wanted_list> paying_list(std::span<const box> boxes, bool same_objects);
    [[nodiscard]] std::optional<double> margin_about_kept(const list_plan& plan) const;
    [[nodiscard]] bool serves_as_well(const list_plan& plan) const;
    [[nodiscard]] bool repeats_plan(std::span<const box> boxes);
    [[nodiscard]] bool serves_few_well() const;
    [[nodiscard]] double first_margin(std::span<const box> boxes);
    [[nodiscard]] bool is_far_too_long(std::span<const box> boxes, double margin) {
        return list_forecast::is_far_too_long(forecast_.reach(boxes, objects_, margin), objects_.size(), found_);
    }
    [[nodiscard]] list_outlook outlook() const {
        return forecast_.outlook(motion_, objects_.size(), found_, horizon());
    }
    [[nodiscard]] list_horizon horizon() const noexcept {
        const bool goes_on = frames_ >= expected_;
        return {.frames_left = goes_on ? std::numeric_limits<std::size_t>::max() : expected_ - frames_,
                .in_new_memory = grown_.capacity() == 0};
    }
    void search_as_it_is(std::span<const box> boxes);
    void keep(std::span<const box> boxes, wanted_list next);
    void judge_first_list();
    void learn_from_first_list();
    void keep_those_that_meet(std::span<const box> boxes);
    [[nodiscard]] std::optional<list_plan> shorter_list() const;
    void shorten_as_planned(const list_plan& plan);
    void shorten_list(double margin);
    void count_tests(std::size_t tests) noexcept {
        if (counted_ == instrumentation::counters) tests_counted_ += tests;
    }

    /// Where no list pays, boxes are watched so many frames, or less if they move on and on, and then left alone.
    static constexpr std::uint32_t longest_watch = 8;
    /// A list that costs so many times what a search does is not waited for.
    static constexpr double hopeless = 3;
    /// Of fewer frames in all, the first one gets no list: how boxes move is not known, and a list that is made in new
    /// memory takes as long as searching several frames.
    static constexpr std::size_t fewest_frames_of_first_list = 64;
    /// Fewer are searched in the time that it takes to watch them.
    static constexpr std::size_t fewest_boxes_of_list = 2 * simd::width + 1;
    /// Of fewer boxes any list is short.
    static constexpr std::size_t fewest_boxes_of_long_list = 256;
    /// Lists of so few take more time than is reckoned: the code of a list is seldom at hand.
    static constexpr std::size_t hardly_any_boxes = 64;
    static constexpr double trust_in_hardly_any = 0.75;
    /// Of plans, after one whose list ended in less than half of its time.
    static constexpr double less_trust = 0.8;
    static constexpr double least_trust = 0.5;
    static constexpr std::size_t longest_history = 256;
    /// So many lists are made by one plan: pairs may become more or fewer meanwhile.
    static constexpr unsigned longest_repetition = 16;
    /// A list of few boxes that lasts so many frames is good enough.
    static constexpr std::size_t frames_of_good_list = 8;
    /// To tell which pairs are sure takes longer than to test them, so a list is to have served before, and to serve so
    /// many frames yet.
    static constexpr std::uint32_t frames_before_sure = 2;
    static constexpr std::uint32_t frames_of_sure = 4;
    /// Of the first list, in typical extents: the best where one margin must do for any scene.
    static constexpr double extents_of_first_margin = 0.1;
    /// So many times as long where hardly any boxes come into reach by that.
    static constexpr double longer_where_sparse = 3;

    std::unique_ptr<global_stage> search_;
    neighbour_list_prepare::config config_;
    instrumentation counted_;
    std::uint64_t tests_counted_ = 0;
    membership objects_;
    frame_state frame_;
    std::span<const box> boxes_;
    source from_ = source::search;
    std::vector<box> kept_;          // boxes that the list is about
    std::vector<box> grown_;         // the same with their margin
    pair_list list_;                 // what it found, less the pairs of objects that have left
    bool is_kept_ = false;           // false where that search failed, or there was none
    bool is_about_earlier_ = false;  // frame than the one in which it was made
    double moved_both_ways_ = 0;     // by the boxes of this frame, see `relative_motion`
    std::uint32_t served_ = 0;       // frames, by the list
    bool is_too_long_ = false;       // so that a search takes less time
    bool is_first_ = true;           // nothing is known of the scene yet
    bool seems_sparse_ = false;      // to who looked at some boxes, before the first list was made
    bool has_learned_ = false;       // from the first list, how long others are
    double margin_ = 0;
    double margin_when_made_ = 0;  // of the list, which may have been shortened since
    std::vector<double> motion_;   // since boxes were kept, at most until that frame, frame by frame
    std::uint32_t age_ = 0;        // frames since then
    std::size_t planned_ = 0;      // frames since then until which the list is to serve; 0 where nobody reckoned
    double planned_for_ = 0;       // the farthest that boxes had moved when that was reckoned
    unsigned repeated_ = 0;        // lists made since by the same plan
    std::size_t found_ = 0;        // pairs of the frame before
    list_forecast forecast_;
    rest_watch rest_;
    bool is_as_kept_ = false;  // in the frame before
    bool came_to_rest_ = false;
    bool rested_ = false;        // since the list was kept
    double trust_ = 1;           // what must be promised for a list to be worth it, after lists that ended early
    double cost_ = 0;            // of the cheapest list that was thought of last, over that of a search
    bool watches_ = false;       // how far boxes are from those that are kept, without a list
    bool watches_long_ = false;  // before anything is planned
    list_pause pause_;
    std::size_t frames_ = 0;  // before this one
    std::size_t expected_ = std::numeric_limits<std::size_t>::max();
};

void neighbour_list_stage::update(std::span<const box> boxes) {
    frame_.begin();
    require_ieee_arithmetic();
    objects_.require_boxes_for_all(boxes.size());
    boxes_ = boxes;
    const bool comes_any = objects_.arrivals() > 0;
    const bool leaves_any = objects_.any_departures();
    frame_.change([&] { objects_.settle(); });
    // At once: the frame may be refused yet, and who left is not told again.
    if (leaves_any && is_kept_)
        list_.erase_if([&](index_pair p) { return !objects_.contains(p.a) || !objects_.contains(p.b); });
    if (adapts() && objects_.size() < fewest_boxes_of_list) {
        search_as_it_is(boxes);
    } else if (adapts() && is_first_ && !is_kept_ && horizon().frames_left < fewest_frames_of_first_list) {
        is_first_ = false;
        pause_.begin_with_look();
        pass_over(boxes);
        search_as_it_is(boxes);
    } else if (pause_.lasts()) {
        pass_over(boxes);
        search_as_it_is(boxes);
    } else if (!is_kept_ || comes_any || !rests(boxes)) {
        const bool same_objects = !comes_any && boxes.size() == kept_.size();
        if (adapts() && is_kept_ && is_first_) judge_first_list();
        if (is_kept_ && same_objects && serves(boxes) && !is_too_long_) {
            require_valid(boxes);
            if (came_to_rest_)
                keep_those_that_meet(boxes);
            else if (const std::optional<list_plan> shorter = adapts() ? shorter_list() : std::nullopt)
                shorten_as_planned(*shorter);
            else if (margin_ > 0 && config_.every == 0 && ++served_ == frames_before_sure && is_to_serve_on())
                list_.tell_sure(kept_, margin_);
        } else if (const std::optional<wanted_list> next =
                       watches_ ? watched(boxes, same_objects) : next_list(boxes, same_objects)) {
            keep(boxes, *next);
        } else {
            search_as_it_is(boxes);
        }
    }
    ++frames_;
    frame_.taken();
}

void neighbour_list_stage::search(std::vector<index_pair>& pairs) {
    frame_.require_taken();
    require_ieee_arithmetic();
    const std::size_t before = pairs.size();
    if (from_ == source::search) {
        search_->search(pairs);
    } else if (from_ == source::whole) {
        pairs.insert(pairs.end(), list_.whole().begin(), list_.whole().end());
    } else {
        append_whole(pairs, [&] { count_tests(list_.append_to(pairs, boxes_, is_within())); });
    }
    found_ = pairs.size() - before;
}

work_counters neighbour_list_stage::counters() const {
    work_counters all = search_->counters();
    all.add(work::box_tests, tests_counted_);
    return all;
}

std::vector<part_bytes> neighbour_list_stage::bytes() const {
    std::vector<part_bytes> parts = search_->bytes();
    parts.push_back(
        {"prepare", bytes_of(objects_) + bytes_of(kept_) + bytes_of(grown_) + list_.bytes() + bytes_of(motion_)});
    return parts;
}

std::vector<std::string> neighbour_list_stage::plans() const {
    std::vector<std::string> all = search_->plans();
    if (from_ == source::list)
        all.push_back("a list of " + std::to_string(list_.size()) + " pairs, of boxes " +
                      (is_about_earlier_ ? "as they were before, " : "") + "grown by " +
                      shortest(static_cast<float>(margin_)) + " on every side");
    else if (from_ == source::whole)
        all.emplace_back("the pairs of a frame since which nothing has moved");
    return all;
}

std::vector<omission> neighbour_list_stage::left_out() const {
    std::vector<omission> absent = search_->left_out();
    if (from_ == source::search)
        absent.push_back(
            {"no list of neighbours",
             adapts() && objects_.size() < fewest_boxes_of_list ? "so few boxes are searched as soon as watched"
             : expected_ < fewest_frames_of_first_list ? "none has been seen to repay its making in so few frames"
             : watches_                                ? "boxes are watched for how far they move"
                                                       : "boxes move too far, or come too often, for one to pay"});
    return absent;
}

/// Whether nothing has moved since a search of boxes as they were, so that the list is the answer.
bool neighbour_list_stage::rests(std::span<const box> boxes) {
    if (!adapts() || margin_ > 0 || boxes.empty() || boxes.size() != kept_.size() ||
        std::memcmp(boxes.data(), kept_.data(), boxes.size_bytes()) != 0)
        return false;
    motion_.clear();
    rested_ = true;
    from_ = source::whole;
    return true;
}

/// Whether every pair of the frame is in the list.
bool neighbour_list_stage::serves(std::span<const box> boxes) {
    ++age_;
    from_ = source::list;
    if (config_.every > 0 && config_.margin) return age_ < config_.every;
    const relative_motion moved = motion_between(kept_, boxes, objects_);
    moved_both_ways_ = moved.both_ways;
    if (motion_.size() < longest_history)
        motion_.push_back(motion_.empty() ? moved.margin : std::max(motion_.back(), moved.margin));
    if (!moved.any && margin_ == 0) from_ = source::whole;
    if (config_.every > 0) return age_ < config_.every;
    // For one frame stands still what is about to fall, and what swings may be back where it was kept.
    const bool stood = std::exchange(is_as_kept_, !moved.any);
    came_to_rest_ = adapts() && margin_ > 0 && ((stood && is_as_kept_) || rest_.came_to_rest(boxes, moved.margin));
    return moved.margin <= margin_;
}

/// The list that is to be kept now; none where none pays. After a pause a frame is kept as it is, to see how boxes
/// move, and one of boxes that came to rest, to be the answer until they move.
auto neighbour_list_stage::next_list(std::span<const box> boxes, bool same_objects) -> std::optional<wanted_list> {
    constexpr wanted_list of_boxes_as_they_are{.margin = 0};
    forecast_.foresee_nothing();
    if (config_.margin) return wanted_list{typical_extents(*config_.margin, boxes, objects_)};
    const bool comes_to_rest = std::exchange(came_to_rest_, false);
    if (adapts() && is_first_) return wanted_list{first_margin(boxes)};
    // Whoever comes to boxes at rest does not make them move.
    if (!is_kept_ || comes_to_rest || (rested_ && motion_.empty())) return of_boxes_as_they_are;
    if (config_.every > 0)
        return motion_.empty() || config_.every == 1 ? of_boxes_as_they_are
                                                     : wanted_list{margin_after(motion_, config_.every - 1)};
    const bool was_shortened = margin_ < margin_when_made_;
    if (margin_ > 0 && planned_ > 1 && !was_shortened)
        trust_ = 2 * std::size_t{age_} < planned_ ? std::max(least_trust, less_trust * trust_) : 1;
    const bool is_first_look = margin_ == 0 && motion_.size() == 1;
    // Of a plan that was so wrong, less was known than it seemed.
    watches_long_ = margin_ > 0 && planned_ > 4 * std::size_t{age_};
    if (const std::optional<wanted_list> next = paying_list(boxes, same_objects)) return next;
    // What jiggles about its place shows it only after some frames.
    watches_ = (is_first_look || margin_ > 0) && cost_ < hopeless && age_ < longest_watch;
    if (!watches_) pause_.begin(objects_.size());
    return std::nullopt;
}

/// The list that is to be kept now, while nothing is kept but boxes of some frames before; none where none pays yet.
auto neighbour_list_stage::watched(std::span<const box> boxes, bool same_objects) -> std::optional<wanted_list> {
    ++age_;
    std::optional<wanted_list> next;
    bool drifts = false;
    if (same_objects && std::has_single_bit(age_)) {
        const double half_way = motion_.back();
        motion_.resize(age_, std::max(half_way, motion_between(kept_, boxes, objects_).margin));
        drifts = motion_.back() > 1.8 * half_way;
        if (!watches_long_ || age_ == longest_watch) next = paying_list(boxes, same_objects);
    }
    watches_ = same_objects && !next && !drifts && age_ < longest_watch;
    if (!watches_ && !next) pause_.begin(objects_.size());
    return next;
}

void neighbour_list_stage::pass_over(std::span<const box> boxes) {
    if (!pause_.pass(boxes, objects_, found_, forecast_, horizon(), trust() * worth_a_list)) return;
    release(kept_);
    release(grown_);
    list_.release();
}

auto neighbour_list_stage::paying_list(std::span<const box> boxes, bool same_objects) -> std::optional<wanted_list> {
    const bool lasted_as_planned = is_kept_ && margin_ > 0 && !motion_.empty() && planned_ > 1 && age_ >= planned_;
    // A list about an earlier frame ended because boxes went farther from there: from here they may go twice as far.
    const bool serves_well = serves_few_well();
    if (!is_about_earlier_ && (serves_well || (lasted_as_planned && repeats_plan(boxes)))) {
        if (serves_well && planned_ > 0) planned_ = std::max(planned_, frames_of_good_list);
        const bool is_sparse = ++repeated_ == 1 && !has_learned_ && list_.size() < objects_.size() / 4;
        return wanted_list{is_sparse ? longer_where_sparse * margin_ : margin_};
    }
    if (age_ <= 1)
        forecast_.look_anew(boxes, objects_);
    else
        forecast_.look_anew_at_other_sizes(boxes, objects_);
    if (!has_learned_ && margin_ > 0) learn_from_first_list();
    planned_for_ = motion_.empty() ? 0 : motion_.back();
    repeated_ = 0;
    for (;;) {
        const list_plan plan = plan_list(outlook(), trust() * (lasted_as_planned ? worth_another_list : worth_a_list));
        cost_ = plan.cost;
        planned_ = plan.frames;
        const bool pays = plan.frames > 1;
        if (pays && serves_as_well(plan) && !is_far_too_long(boxes, margin_)) {
            planned_ = age_;
            forecast_.foresee(outlook(), margin_);
            return wanted_list{margin_};
        }
        const std::optional<double> about_kept = pays && same_objects ? margin_about_kept(plan) : std::nullopt;
        const double margin = pays ? std::max(spare_margin(outlook(), plan), about_kept.value_or(0)) : plan.margin;
        const bool may_be_wrong =
            forecast_.foresee(outlook(), margin) > 0 && objects_.size() >= fewest_boxes_of_long_list &&
            (pays ? margin > 2 * forecast_.looked_up() : forecast_.looked_up() == 0 && cost_ < hopeless);
        if (pays && is_far_too_long(boxes, margin)) return std::nullopt;
        if (may_be_wrong && forecast_.look_up(boxes, objects_, margin, found_, pays)) continue;
        if (!pays) return std::nullopt;
        if (about_kept) planned_ += age_;
        return wanted_list{margin, about_kept.has_value()};
    }
}

/// The margin of a list about the boxes that are kept, for as long as the plan has it; none where they move on. Where
/// they move about their places, it is known how far they go from those that are kept, but not from those of this
/// frame, which may be at one end of their ways.
std::optional<double> neighbour_list_stage::margin_about_kept(const list_plan& plan) const {
    constexpr std::uint32_t fewest_frames = 4;
    constexpr double a_little_longer = 1.1;
    // A random walk gets 1.4 times as far in twice the time, a drift 2 times.
    constexpr double moves_on = 1.7;
    if (age_ < fewest_frames || motion_.size() != age_ || motion_.back() >= moves_on * motion_[age_ / 2 - 1])
        return std::nullopt;
    const double margin = margin_after(motion_, age_ + plan.frames - 1);
    return margin <= a_little_longer * plan.margin ? std::optional(margin) : std::nullopt;
}

/// Whether the last list costs about as little as the next one is to: what is known to serve is not given up for a
/// promise.
bool neighbour_list_stage::serves_as_well(const list_plan& plan) const {
    constexpr double about = 1.03;
    if (!is_kept_ || margin_ == 0 || margin_ < margin_when_made_ || is_about_earlier_ || age_ < 2) return false;
    const auto n = static_cast<double>(objects_.size());
    const double search = cost_of_search(n, pairs_listed(outlook(), 0), machine_costs());
    return cost_of_list(n, static_cast<double>(list_.size()), age_, machine_costs()) <= about * plan.cost * search;
}

/// Whether the next list is made as the last one was, since boxes moved as they did before it: of a few boxes, planning
/// takes as long as searching them.
bool neighbour_list_stage::repeats_plan(std::span<const box> boxes) {
    constexpr double alike = 1.02;
    return age_ == planned_ && motion_.back() <= alike * planned_for_ && planned_for_ <= alike * motion_.back() &&
           repeated_ < longest_repetition && !is_far_too_long(boxes, margin_);
}

/// Whether the next list gets the margin of this one without a plan, since few boxes are searched in the time that a
/// plan takes, and this one lasted.
bool neighbour_list_stage::serves_few_well() const {
    return is_kept_ && margin_ > 0 && !is_too_long_ && objects_.size() < fewest_boxes_of_long_list &&
           repeated_ < longest_repetition && age_ >= std::max<std::size_t>(planned_, frames_of_good_list);
}

/// Of the first list, which is kept before anything is known; 0 where it would hold far too many.
double neighbour_list_stage::first_margin(std::span<const box> boxes) {
    const double margin = typical_extents(extents_of_first_margin, boxes, objects_);
    found_ = 0;
    if (objects_.size() < fewest_boxes_of_long_list) return margin;
    const rough_reach longer = forecast_.reach(boxes, objects_, longer_where_sparse * margin);
    seems_sparse_ = longer.counted == 0;
    if (seems_sparse_) return longer_where_sparse * margin;
    const bool may_be_too_long = list_forecast::is_far_too_long(longer, objects_.size(), found_);
    return may_be_too_long && is_far_too_long(boxes, margin) ? 0 : margin;
}

void neighbour_list_stage::search_as_it_is(std::span<const box> boxes) {
    is_kept_ = false;
    from_ = source::search;
    search_->update(boxes);
}

/// What the list of the first frame tells, which was kept before anything was known.
void neighbour_list_stage::judge_first_list() {
    is_first_ = false;
    if (margin_ == 0) return;
    if (seems_sparse_ && list_.size() > objects_.size()) shorten_list(margin_ / longer_where_sparse);
    is_too_long_ = !pays(objects_.size(), found_, list_.size());
}

/// What the length of the first list tells of others, when one is planned for the first time.
void neighbour_list_stage::learn_from_first_list() {
    has_learned_ = true;
    forecast_.foresee(outlook(), margin_);
    forecast_.correct(static_cast<double>(list_.size()) - static_cast<double>(found_));
    forecast_.take_as_looked_up(margin_);
}

/// Of a list that serves boxes which came to rest.
void neighbour_list_stage::keep_those_that_meet(std::span<const box> boxes) {
    if (!is_within()) list_.forget_sure();
    count_tests(list_.tested());
    list_.keep_meeting(boxes);
    list_.forget_sure();
    kept_.assign(boxes.begin(), boxes.end());
    margin_ = 0;
    is_about_earlier_ = false;
    motion_.clear();
    came_to_rest_ = false;
    rested_ = true;
    age_ = 0;
    from_ = source::whole;
}

/// A list that serves for several times as long as this one has, where boxes move by so much less than this one allows
/// that it holds many in vain; ever less often looked at.
auto neighbour_list_stage::shorter_list() const -> std::optional<list_plan> {
    constexpr std::uint32_t first_look = 8;
    constexpr std::uint32_t times_as_long = 4;
    constexpr double a_quarter_more = 1.25;
    constexpr double worth_it = 0.7;
    // Shorter, it lists hardly fewer, and roundings may end it.
    constexpr double shortest = 1.0 / 16;
    if (age_ < first_look || !std::has_single_bit(age_) || motion_.size() < age_) return std::nullopt;
    const std::size_t frames = times_as_long * std::size_t{age_};
    if (!pays_to_shorten(objects_.size(), found_, list_.tested(), frames - age_)) return std::nullopt;
    // What got more than twice as far in twice the time is to do so in the next two doublings, too.
    const double speeds_up = std::max(1.0, motion_.back() / (2 * motion_[age_ / 2 - 1]));
    const double needed = a_quarter_more * speeds_up * speeds_up * margin_after(motion_, frames);
    const double margin = std::max(needed, shortest * margin_when_made_);
    return margin < worth_it * margin_ ? std::optional(list_plan{.frames = frames, .margin = margin}) : std::nullopt;
}

void neighbour_list_stage::shorten_as_planned(const list_plan& plan) {
    planned_ = plan.frames;
    planned_for_ = motion_.back();
    shorten_list(plan.margin);
}

/// The list that a smaller margin would have made, without a search.
void neighbour_list_stage::shorten_list(double margin) {
    margin_ = margin;
    grow(kept_, margin_, grown_);
    count_tests(list_.tested());
    list_.keep_meeting(grown_);
    list_.tell_sure(kept_, margin_);
}

void neighbour_list_stage::keep(std::span<const box> boxes, wanted_list next) {
    is_kept_ = false;
    is_about_earlier_ = next.about_kept;
    margin_ = margin_when_made_ = next.margin;
    is_as_kept_ = false;
    if (!is_about_earlier_) {
        kept_.assign(boxes.begin(), boxes.end());
        motion_.clear();
        age_ = 0;
    }
    if (margin_ > 0) {
        // Grown, an inverted box may be none. As they are, the search looks at them.
        require_valid(boxes);
        pause_.shorten();
        grown_.resize(boxes.size());
        grow(kept_, margin_, grown_);
    }
    search_->update(margin_ > 0 ? std::span<const box>(grown_) : boxes);
    const std::size_t listed_before = list_.size();
    search_->search(list_.begin());
    served_ = 0;
    forecast_.correct(static_cast<double>(list_.size()) - static_cast<double>(found_));
    // Nobody reckons a list that repeats another: then it is to be about as long.
    const bool is_judged = forecast_.is_reckoned() || (repeated_ > 0 && list_.size() > 2 * listed_before);
    is_too_long_ = is_judged && !pays(objects_.size(), found_, list_.size());
    rested_ = false;
    is_kept_ = true;
    from_ = margin_ > 0 ? source::list : source::whole;
}

}  // namespace

std::unique_ptr<global_stage> neighbour_list_prepare::before(std::unique_ptr<global_stage> search,
                                                             instrumentation counted) const {
    return std::make_unique<neighbour_list_stage>(std::move(search), config_, counted);
}

}  // namespace aabb
