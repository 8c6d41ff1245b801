module;
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
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
import aabb.prepare.glimpse;
import aabb.prepare.grown_boxes;
import aabb.prepare.list_plan;
import aabb.prepare.mean_extent;
import aabb.prepare.relative_motion;
import aabb.prepare.rest_watch;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

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
    [[nodiscard]] std::vector<std::string> left_out() const override;

private:
    /// Where the pairs of a frame come from.
    enum class source : std::uint8_t {
        list,   ///< which may hold others too
        whole,  ///< the list, which is of these very boxes
        search  ///< of these boxes, of which nothing is kept
    };

    [[nodiscard]] bool adapts() const noexcept { return !config_.margin && config_.every == 0; }
    [[nodiscard]] bool rests(std::span<const box> boxes);
    [[nodiscard]] bool serves(std::span<const box> boxes);
    [[nodiscard]] std::optional<double> next_margin(std::span<const box> boxes);
    [[nodiscard]] std::optional<double> watched(std::span<const box> boxes, bool same_objects);
    void pass_over(std::span<const box> boxes);
    [[nodiscard]] std::optional<double> paying_margin(std::span<const box> boxes);
    [[nodiscard]] std::span<const box> sample(std::span<const box> boxes, std::span<box> of);
    [[nodiscard]] double pairs_in_reach(std::span<const box> boxes, double margin);
    void keep(std::span<const box> boxes, double margin);

    /// Where no list pays, boxes are watched so many frames, or less if they move on and on, then left alone so many.
    static constexpr std::uint32_t longest_watch = 8;
    static constexpr unsigned pause = 6;
    /// Then a few boxes are looked at, in two of so many frames, until they say that a list may pay.
    static constexpr unsigned pause_between_glimpses = 4;
    /// A list that costs so many times what a search does is not waited for.
    static constexpr double hopeless = 3;
    /// Of fewer boxes any list is short.
    static constexpr std::size_t fewest_boxes_of_long_list = 256;
    static constexpr std::size_t longest_history = 256;

    std::unique_ptr<global_stage> search_;
    neighbour_list_prepare::config config_;
    instrumentation counted_;
    std::uint64_t tests_counted_ = 0;
    membership objects_;
    frame_state frame_;
    std::span<const box> boxes_;
    source from_ = source::search;
    std::vector<box> kept_;         // boxes of the last search that was kept
    std::vector<box> grown_;        // the same with their margin
    std::vector<index_pair> list_;  // that it found, less the pairs of objects that have left
    bool is_kept_ = false;          // false where that search failed, or there was none
    bool is_too_long_ = false;      // so that a search takes less time
    double margin_ = 0;
    std::vector<double> motion_;  // since then, frame by frame
    std::uint32_t age_ = 0;       // frames since
    std::size_t found_ = 0;       // pairs of the frame before
    growth_of_pairs growth_;
    double foreseen_ = 0;      // pairs of the list beside those that overlap, as they were reckoned
    double correction_ = 1;    // of that
    double looked_up_ = 0;     // the greatest margin for which a sample was asked how long the list would be
    std::uint32_t drawn_ = 0;  // boxes, for samples
    rest_watch rest_;
    bool came_to_rest_ = false;
    double cost_ = 0;       // of the cheapest list that was thought of last, over that of a search
    bool watches_ = false;  // how far boxes are from those that are kept, without a list
    unsigned left_ = 0;     // frames that are searched as they are before one is kept again
    glimpse glimpse_;
};

void neighbour_list_stage::update(std::span<const box> boxes) {
    frame_.begin();
    require_ieee_arithmetic();
    objects_.require_boxes_for_all(boxes.size());
    boxes_ = boxes;
    const bool comes_any = !objects_.arrivals().empty();
    const bool leaves_any = objects_.any_departures();
    frame_.change([&] { objects_.settle(); });
    // At once: the frame may be refused yet, and who left is not told again.
    if (leaves_any && is_kept_)
        std::erase_if(list_, [&](index_pair p) { return !objects_.contains(p.a) || !objects_.contains(p.b); });
    if (left_ > 0) {
        pass_over(boxes);
        search_->update(boxes);
    } else if (!is_kept_ || comes_any || !rests(boxes)) {
        const bool same_objects = !comes_any && boxes.size() == kept_.size();
        if (is_kept_ && !is_too_long_ && same_objects && serves(boxes)) {
            require_valid(boxes);
        } else if (const std::optional<double> margin = watches_ ? watched(boxes, same_objects) : next_margin(boxes)) {
            keep(boxes, *margin);
        } else {
            is_kept_ = false;
            from_ = source::search;
            search_->update(boxes);
        }
    }
    frame_.taken();
}

/// The least and the greatest numbers of a box on all three axes, each with a fourth one of no account.
using corner = float __attribute__((vector_size(16)));
[[nodiscard, gnu::always_inline]] inline corner lower_of(const box& b) noexcept {
    corner v;
    std::memcpy(&v, &b, sizeof v);
    return v;
}
[[nodiscard, gnu::always_inline]] inline corner upper_of(const box& b) noexcept {
    corner v;
    std::memcpy(&v, reinterpret_cast<const char*>(&b) + sizeof(box) - sizeof v, sizeof v);
    return __builtin_shufflevector(v, v, 1, 2, 3, 0);
}

/// As `overlaps`, on three axes at a time.
[[nodiscard, gnu::always_inline]] inline bool meet(const box& a, const box& b) noexcept {
    using bools = bool __attribute__((ext_vector_type(4)));
    const auto held = (lower_of(a) <= upper_of(b)) & (lower_of(b) <= upper_of(a));
    return (std::bit_cast<std::uint8_t>(__builtin_convertvector(held, bools)) & 7U) == 7U;
}

void neighbour_list_stage::search(std::vector<index_pair>& pairs) {
    frame_.require_taken();
    require_ieee_arithmetic();
    const std::size_t before = pairs.size();
    if (from_ == source::search) {
        search_->search(pairs);
    } else if (from_ == source::whole) {
        pairs.insert(pairs.end(), list_.begin(), list_.end());
    } else {
        if (counted_ == instrumentation::counters) tests_counted_ += list_.size();
        append_whole(pairs, [&] {
            // Written without a branch, since which pairs of the list overlap cannot be predicted.
            std::size_t end = pairs.size();
            pairs.resize(end + list_.size());
            for (const index_pair pair : list_) {
                pairs[end] = pair;
                end += static_cast<std::size_t>(meet(boxes_[pair.a], boxes_[pair.b]));
            }
            pairs.resize(end);
        });
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
        {"prepare", bytes_of(objects_) + bytes_of(kept_) + bytes_of(grown_) + bytes_of(list_) + bytes_of(motion_)});
    return parts;
}

std::vector<std::string> neighbour_list_stage::left_out() const {
    std::vector<std::string> absent = search_->left_out();
    if (from_ == source::search) absent.emplace_back("no list of neighbours: boxes move too far for one to pay");
    return absent;
}

/// Whether nothing has moved since a search of boxes as they were, so that the list is the answer.
bool neighbour_list_stage::rests(std::span<const box> boxes) {
    if (!adapts() || margin_ > 0 || boxes.empty() || boxes.size() != kept_.size() ||
        std::memcmp(boxes.data(), kept_.data(), boxes.size_bytes()) != 0)
        return false;
    motion_.clear();
    from_ = source::whole;
    return true;
}

/// Whether every pair of the frame is in the list.
bool neighbour_list_stage::serves(std::span<const box> boxes) {
    ++age_;
    from_ = source::list;
    if (config_.every > 0 && config_.margin) return age_ < config_.every;
    const relative_motion moved = motion_between(kept_, boxes, objects_);
    if (motion_.size() < longest_history) motion_.push_back(moved.margin);
    if (!moved.any && margin_ == 0) from_ = source::whole;
    if (config_.every > 0) return age_ < config_.every;
    came_to_rest_ = adapts() && margin_ > 0 && rest_.came_to_rest(boxes, moved.margin);
    return moved.margin <= margin_ && !came_to_rest_;
}

/// The margin of the list that is to be kept now; none where none pays. A first frame is kept as it is, to see how
/// boxes move, and one of boxes that came to rest, to be the answer until they move.
std::optional<double> neighbour_list_stage::next_margin(std::span<const box> boxes) {
    foreseen_ = 0;
    if (config_.margin) return mean_extents(*config_.margin, boxes, objects_);
    if (!is_kept_ || std::exchange(came_to_rest_, false)) return 0;
    if (config_.every > 0) return motion_.empty() ? 0 : margin_after(motion_, config_.every - 1);
    const bool is_first_look = margin_ == 0 && motion_.size() == 1;
    if (const std::optional<double> margin = paying_margin(boxes)) return margin;
    // What jiggles about its place shows it only after some frames.
    watches_ = is_first_look && cost_ < hopeless;
    if (!watches_) left_ = pause;
    return std::nullopt;
}

/// The margin of the list that is to be kept now, while nothing is kept but boxes of some frames before; none where
/// none pays yet.
std::optional<double> neighbour_list_stage::watched(std::span<const box> boxes, bool same_objects) {
    ++age_;
    std::optional<double> margin;
    bool drifts = false;
    if (same_objects && std::has_single_bit(age_)) {
        const double half_way = motion_.back();
        motion_.resize(age_, motion_between(kept_, boxes, objects_).margin);
        drifts = motion_.back() > 1.8 * half_way;
        margin = paying_margin(boxes);
    }
    watches_ = same_objects && !margin && !drifts && age_ < longest_watch;
    if (!watches_ && !margin) left_ = pause;
    return margin;
}

/// A frame that is searched as it is. Where even the few boxes that are looked at move too far for any list, all do.
void neighbour_list_stage::pass_over(std::span<const box> boxes) {
    --left_;
    if (left_ == 1) glimpse_.keep(boxes, drawn_);
    if (left_ > 0) return;
    const double moved = glimpse_.least_motion(boxes, objects_);
    const list_outlook seen{std::span(&moved, 1), objects_.size(), found_, growth_, correction_};
    if (plan_list(seen).frames == 1) left_ = pause_between_glimpses;
}

std::optional<double> neighbour_list_stage::paying_margin(std::span<const box> boxes) {
    if (age_ <= 1) {
        std::array<box, 16> some;
        growth_ = growth_of_pairs(sample(boxes, some));
    }
    for (;;) {
        const list_outlook seen{motion_, objects_.size(), found_, growth_, correction_};
        const list_plan plan = plan_list(seen);
        cost_ = plan.cost;
        if (plan.frames == 1) return std::nullopt;
        foreseen_ = pairs_listed(seen, plan.margin) - pairs_listed(seen, 0);
        if (plan.margin <= looked_up_ || objects_.size() < fewest_boxes_of_long_list) return plan.margin;
        // A list may hold each box with every other, and the few that the reckoning is made from may not tell.
        looked_up_ = plan.margin;
        const double beside = pairs_in_reach(boxes, plan.margin) - static_cast<double>(found_);
        if (beside <= 2 * foreseen_ + static_cast<double>(objects_.size())) return plan.margin;
        correction_ *= beside / foreseen_;
    }
}

/// Boxes by chance, fewer where some objects are absent.
std::span<const box> neighbour_list_stage::sample(std::span<const box> boxes, std::span<box> of) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < of.size() && i < boxes.size(); ++i) {
        const std::uint32_t id = drawn_id(drawn_, boxes.size());
        if (objects_.contains(id)) of[count++] = boxes[id];
    }
    return of.first(count);
}

/// About how many pairs a list with that margin holds: as many as a sample of boxes has neighbours.
double neighbour_list_stage::pairs_in_reach(std::span<const box> boxes, double margin) {
    std::array<box, 8> some;
    const std::span<const box> asked = sample(boxes, some);
    if (asked.empty()) return 0;
    std::array<box, 8> reach;
    // Both boxes of a pair are grown.
    grow(asked, 2 * margin, reach);
    std::size_t neighbours = 0;
    for (const box& b : boxes)
        for (std::size_t i = 0; i < asked.size(); ++i) neighbours += static_cast<std::size_t>(meet(b, reach[i]));
    // Each is a neighbour of itself.
    return (static_cast<double>(neighbours) / static_cast<double>(asked.size()) - 1) / 2 *
           static_cast<double>(objects_.size());
}

void neighbour_list_stage::keep(std::span<const box> boxes, double margin) {
    is_kept_ = false;
    kept_.assign(boxes.begin(), boxes.end());
    if (margin > 0) {
        // Grown, an inverted box may be none. As they are, the search looks at them.
        require_valid(boxes);
        grown_.resize(boxes.size());
        grow(boxes, margin, grown_);
    }
    search_->update(margin > 0 ? std::span<const box>(grown_) : boxes);
    list_.clear();
    search_->search(list_);
    if (foreseen_ > 0) {
        const double beside = static_cast<double>(list_.size()) - static_cast<double>(found_);
        correction_ = std::clamp(correction_ * beside / foreseen_, 0.5, 1000.0);
    }
    margin_ = margin;
    is_too_long_ = foreseen_ > 0 && !pays(objects_.size(), found_, list_.size());
    motion_.clear();
    age_ = 0;
    is_kept_ = true;
    from_ = margin > 0 ? source::list : source::whole;
}

}  // namespace

std::unique_ptr<global_stage> neighbour_list_prepare::before(std::unique_ptr<global_stage> search,
                                                             instrumentation counted) const {
    return std::make_unique<neighbour_list_stage>(std::move(search), config_, counted);
}

}  // namespace aabb
