module;
#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <limits>
#include <span>

export module aabb.prepare.list_plan;

import aabb.costs;
import aabb.geometry;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// How many pairs come into reach as boxes grow, in pairs of those that overlap: of boxes evenly spread, the mean over
/// pairs of them of the product of what they reach on three axes, a polynomial in the margin. An axis on which boxes
/// lie no further apart than they reach counts for nothing: they overlap there as they are.
class growth_of_pairs {
public:
    growth_of_pairs() = default;
    /// @param some boxes of the scene, in any order
    explicit growth_of_pairs(std::span<const box> some) {
        vec3d lengths{};
        box lower_corners = empty_box();
        for (const box& b : some) {
            lower_corners = merged(lower_corners, box{b.min, b.min});
            for (int k = 0; k < 3; ++k) lengths[k] += double{b.max[k]} - double{b.min[k]};
        }
        const auto apart = [&](int k) { return double{lower_corners.max[k]} - double{lower_corners.min[k]}; };
        longest_margin_ = 4 * (lengths[0] + lengths[1] + lengths[2]) / (3.0 * static_cast<double>(some.size()));
        for (std::size_t i = 1; i < some.size(); ++i) {
            std::array<double, 4> product{1, 0, 0, 0};
            for (int k = 0; k < 3; ++k) {
                if (apart(k) <= lengths[k] / static_cast<double>(some.size())) continue;
                double reach = 0;
                for (const box& b : {some[i - 1], some[i]}) reach += double{b.max[k]} - double{b.min[k]};
                for (std::size_t power = 3; power > 0; --power)
                    product[power] = product[power] * reach + product[power - 1];
                product[0] *= reach;
            }
            for (std::size_t power = 0; power < 4; ++power) sum_[power] += product[power];
        }
    }

    [[nodiscard]] double at(double margin) const {
        const double by = 4 * margin;
        return sum_[0] > 0 ? 1 + by * (sum_[1] + by * (sum_[2] + by * sum_[3])) / sum_[0] : 1;
    }
    /// Four mean extents: further than that it is not to be trusted.
    [[nodiscard]] double longest_margin() const { return longest_margin_; }

private:
    std::array<double, 4> sum_{};
    double longest_margin_ = 0;
};

/// What limits the next list, whatever the boxes do.
struct list_horizon {
    /// That are expected, the list's own included: it serves no longer.
    std::size_t frames_left = std::numeric_limits<std::size_t>::max();
    bool in_new_memory = false;  ///< no list was made before, or its memory was released
};

/// What is known of a scene when the next list of neighbours is planned.
struct list_outlook {
    /// By how much boxes moved relative to each other since they were kept, at most until that frame, frame by frame;
    /// see `relative_motion`.
    std::span<const double> motion;
    std::size_t boxes = 0;
    std::size_t pairs = 0;  ///< that overlap
    growth_of_pairs growth;
    double correction = 1;  ///< pairs that the last list held beside those that overlapped, over what was reckoned
    list_horizon horizon;
};

/// The cheapest list: for how many frames it is to serve, its own included, and the margin by which boxes are grown for
/// that.
struct list_plan {
    std::size_t frames = 1;  ///< 1 where it does not pay
    double margin = 0;
    double cost = std::numeric_limits<double>::infinity();  ///< a frame, over that of a search
};

/// The margin that a list needs to serve so many frames after its own: what was seen in as many, the first of them or,
/// where boxes speed up, the last; further on as much more with each doubling of time as the last two doublings tell;
/// and a little more. So what jiggles about its place needs little more than it moved, what drifts ever more.
[[nodiscard]] inline double margin_after(std::span<const double> motion, std::size_t frames) {
    constexpr double a_little_more = 1.05;
    const std::size_t seen = motion.size();
    assert(frames > 0 && seen > 0);
    const auto moved_after = [&](std::size_t frame) { return frame > 0 ? motion[frame - 1] : 0; };
    if (frames <= seen)
        return a_little_more * std::max(moved_after(frames), moved_after(seen) - moved_after(seen - frames));
    // In half of that time, at the pace since the middle of it.
    const auto growth = [&](std::size_t frame, double moved) {
        const std::size_t middle = frame / 2;
        return (moved - moved_after(middle)) * static_cast<double>(frame) / static_cast<double>(2 * (frame - middle));
    };
    const double last = motion.back();
    const double grown = growth(seen, last);
    const double grown_before = seen < 4 ? 0 : growth(seen / 2, moved_after(seen / 2));
    const double times = static_cast<double>(frames) / static_cast<double>(seen);
    if (!(grown < 2 * grown_before)) return a_little_more * (last + 2 * grown * (times - 1));  // a drift
    const double ratio = std::max(0.3, grown / grown_before);
    // Evenly within a doubling.
    double more = 0;
    double next = ratio;
    double left = times;
    for (; left >= 2; left /= 2) {
        more += next;
        next *= ratio;
    }
    more += next * (left - 1);
    return a_little_more * (last + grown * more);
}

/// A list must cost less than this part of a search: what it takes of the caches is not reckoned. The next one of lists
/// that do may cost a little more: giving up what pays by a little costs more than that.
inline constexpr double worth_a_list = 0.87;
inline constexpr double worth_another_list = 0.95;

/// How many pairs a list with that margin is to hold.
[[nodiscard]] inline double pairs_listed(const list_outlook& seen, double margin) {
    const auto found = static_cast<double>(seen.pairs + 1);
    return found * (1 + seen.correction * (seen.growth.at(margin) - 1));
}

/// What a frame costs that is searched as it is, and one that a list serves.
[[nodiscard]] inline double cost_of_search(double boxes, double pairs, const cost_model& cost) {
    return boxes * cost.search_box + pairs * cost.search_pair;
}
[[nodiscard]] inline double cost_of_service(double boxes, double listed, const cost_model& cost) {
    return boxes * cost.watch_box + listed * cost.test_pair;
}
/// What it costs to make a list.
[[nodiscard]] inline double cost_of_making(double boxes, double listed, const cost_model& cost) {
    return boxes * cost.keep_box + cost_of_search(boxes, listed, cost);
}
/// The mean of as many frames, in the first of which the list is made.
[[nodiscard]] inline double cost_of_list(double boxes, double listed, std::size_t frames, const cost_model& cost) {
    return cost_of_making(boxes, listed, cost) / static_cast<double>(frames) + cost_of_service(boxes, listed, cost);
}
/// What a frame costs more, over all that are left, where the list is made in new memory: pages that are touched for
/// the first time make it take about four times as long as later ones, which reuse them.
[[nodiscard]] inline double cost_of_new_memory(double boxes, double listed, const list_horizon& horizon,
                                               const cost_model& cost) {
    constexpr double times_as_long = 4;
    if (!horizon.in_new_memory) return 0;
    return (times_as_long - 1) * cost_of_making(boxes, listed, cost) / static_cast<double>(horizon.frames_left);
}

/// Whether a frame that a list of so many pairs serves costs less than one that is searched.
[[nodiscard]] inline bool pays(std::size_t boxes, std::size_t pairs, std::size_t listed,
                               const cost_model& cost = machine_costs()) {
    const auto n = static_cast<double>(boxes);
    return cost_of_service(n, static_cast<double>(listed), cost) <
           worth_a_list * cost_of_search(n, static_cast<double>(pairs), cost);
}

/// Whether a list that is to serve so many frames yet is worth shortening, if half of the pairs that are tested are
/// then listed no more, or sure: that takes time, and the list will end sooner and another one be made.
/// @param pairs that overlap
/// @param tested of the list, in each frame
[[nodiscard]] inline bool pays_to_shorten(std::size_t boxes, std::size_t pairs, std::size_t tested, std::size_t frames,
                                          const cost_model& cost = machine_costs()) {
    const auto n = static_cast<double>(boxes);
    const double once = static_cast<double>(tested) * cost.test_pair;
    // Each is tested twice: whether it stays, and whether it is sure.
    const double shortened = n * cost.keep_box + 2 * once;
    const double made_sooner = n * cost.keep_box + cost_of_search(n, static_cast<double>(pairs), cost);
    return once / 2 * static_cast<double>(frames) > shortened + made_sooner;
}

/// The plan that costs least a frame.
/// @param worth what it must cost less than, over a search in every frame
/// @param most a frame that a list serves costs less, over one that is searched, or the list is not looked at
[[nodiscard]] inline list_plan plan_list(const list_outlook& seen, double worth = worth_a_list,
                                         double most = std::numeric_limits<double>::infinity(),
                                         const cost_model& cost = machine_costs()) {
    constexpr std::array<std::size_t, 19> lifetimes{2,  3,  4,  5,  6,  8,  10,  12,  16, 20,
                                                    24, 32, 40, 48, 64, 96, 128, 192, 256};
    const auto n = static_cast<double>(seen.boxes);
    list_plan best;
    const std::size_t frames_left = seen.horizon.frames_left;
    if (seen.motion.empty() || frames_left < 2) return best;
    const double search = cost_of_search(n, pairs_listed(seen, 0), cost);
    for (const std::size_t lifetime : lifetimes) {
        const std::size_t frames = std::min(lifetime, frames_left);
        const double margin = margin_after(seen.motion, frames - 1);
        if (!(margin <= seen.growth.longest_margin())) break;
        const double listed = pairs_listed(seen, margin);
        if (cost_of_service(n, listed, cost) / search >= std::min(best.cost, most)) break;
        const double each =
            (cost_of_list(n, listed, frames, cost) + cost_of_new_memory(n, listed, seen.horizon, cost)) / search;
        if (each < best.cost) best = {frames, margin, each};
        if (frames == frames_left) break;
    }
    if (best.cost >= worth) best.frames = 1;
    return best;
}

/// The margin of a plan that pays, longer where that costs next to nothing: boxes may move farther than they seem to.
/// Where more margin is not known to list more, nothing is known of what it lists.
[[nodiscard]] inline double spare_margin(const list_outlook& seen, const list_plan& plan,
                                         const cost_model& cost = machine_costs()) {
    constexpr double next_to_nothing = 1.01;
    constexpr double longer = 1.5;
    const auto n = static_cast<double>(seen.boxes);
    const auto cost_of = [&](double margin) { return cost_of_list(n, pairs_listed(seen, margin), plan.frames, cost); };
    const double most = next_to_nothing * cost_of(plan.margin);
    double margin = plan.margin;
    while (longer * margin <= seen.growth.longest_margin() &&
           seen.growth.at(longer * margin) > seen.growth.at(margin) && cost_of(longer * margin) <= most)
        margin *= longer;
    return margin;
}

}  // namespace aabb
