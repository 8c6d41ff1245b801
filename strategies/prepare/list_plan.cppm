export module aabb.prepare.list_plan;

import aabb.costs;
export import aabb.prepare.displacement_law;
export import aabb.prepare.sample;
import aabb.std;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

// What a list of neighbours costs a frame, if it is of boxes grown by a margin m and serves k frames, its own included
// (Verlet, "Computer 'experiments' on classical fluids", 1967; Chialvo and Debenedetti, "On the use of the Verlet
// neighbor list in molecular dynamics", 1990, who choose the least of it as here):
//
//     M(m) / k + S(m),  m = d(k - 1),
//     M(m) = n (keep + search) + L(m) find,  a search of n boxes that are grown and kept,
//     S(m) = n watch + L(m) test,            a frame that the list serves,
//     L(m) = P (1 + c (g(m) - 1)),           the pairs that are listed,
//
// where d is how far boxes move (`displacement_law`), P the pairs that overlap, g their growth where boxes are spread
// evenly (`growth_of_pairs`) and c what the last list held over that. Without a list a frame costs n search + P find.
// What one box or pair takes is a machine cost (`cost_model`).
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
    /// Which part of those that overlap does so by more than two margins.
    [[nodiscard]] double sure(double margin) const {
        return 8 * margin < longest_margin_ ? std::max(at(-margin), 0.0) : 0;
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
    displacement_law law{};
    std::size_t boxes = 0;
    std::size_t pairs = 0;  ///< that overlap
    growth_of_pairs growth{};
    double correction = 1;  ///< pairs that the last list held beside those that overlapped, over what was reckoned
    list_horizon horizon{};

    /// @param drawn as `drawn_id` has it
    void look_anew(std::span<const box> all, const membership& objects, std::uint32_t& drawn) {
        std::array<box, 16> some;
        growth = growth_of_pairs(drawn_boxes(all, objects, drawn, some));
    }
    /// How many pairs a list with that margin is to hold.
    [[nodiscard]] double listed(double margin) const {
        return static_cast<double>(pairs + 1) * (1 + correction * (growth.at(margin) - 1));
    }
    /// A list with that margin held so many. One pair more or less says nothing; and where a sample of boxes finds them
    /// spread by far too evenly, other margins are not believed to list next to nothing.
    void learn(double margin, std::size_t held) {
        constexpr double least = 0.3;
        const double reckoned = static_cast<double>(pairs + 1) * (growth.at(margin) - 1);
        const double beside = held < pairs ? 0 : static_cast<double>(held - pairs);
        correction = std::max(least, (beside + 1) / (reckoned + 1));
    }
};

/// The cheapest list: for how many frames it is to serve, its own included, and the margin by which boxes are grown for
/// that.
struct list_plan {
    std::size_t frames = 1;  ///< 1 where it is not worth its cost
    double margin = 0;
    double cost = std::numeric_limits<double>::infinity();  ///< a frame, over that of a search

    /// Frames that are served cost too much already, however many they are.
    [[nodiscard]] bool is_hopeless() const noexcept { return std::isinf(cost); }
};

/// A list must cost less than this part of a search: what it takes of the caches is not reckoned.
inline constexpr double worth_a_list = 0.9;

/// What a frame costs that is searched as it is, and one that a list serves.
[[nodiscard]] inline double cost_of_search(double boxes, double pairs, const cost_model& cost) {
    return boxes * cost.search_box + pairs * cost.search_pair;
}
[[nodiscard]] inline double cost_of_service(double boxes, double listed, const cost_model& cost) {
    return boxes * cost.watch_box + listed * cost.test_pair;
}
/// What it costs to make a list; planning it takes as long as if there were some boxes more.
[[nodiscard]] inline double cost_of_making(double boxes, double listed, const cost_model& cost) {
    constexpr double boxes_of_planning = 64;
    return (boxes + boxes_of_planning) * cost.keep_box + cost_of_search(boxes + boxes_of_planning, listed, cost);
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

/// Whether it pays to tell which pairs of a list are sure, so that they are not tested in later frames of its age: to
/// tell takes as long as two tests of each pair.
[[nodiscard]] inline bool pays_to_tell_sure(const list_outlook& seen, std::size_t listed, double margin) {
    const double sure = static_cast<double>(seen.pairs) * seen.growth.sure(margin);
    const double frames_left = seen.law.until(margin) - static_cast<double>(seen.law.age());
    return sure * frames_left > 2 * static_cast<double>(listed);
}

/// The plan that costs least a frame; of those that cost about as little the longest, since boxes may move farther than
/// they seem to.
[[nodiscard]] inline list_plan plan_list(const list_outlook& seen, double worth = worth_a_list,
                                         const cost_model& cost = machine_costs()) {
    constexpr double as_little = 1.01;
    constexpr std::size_t longest = 1024;
    const auto n = static_cast<double>(seen.boxes);
    list_plan best;
    const std::size_t frames_left = seen.horizon.frames_left;
    if (seen.law.age() == 0 || frames_left < 2) return best;
    const double search = cost_of_search(n, seen.listed(0), cost);
    const double exponent = seen.law.exponent();
    // Frames after the list's own: 1, 2, 3, 4, 6, 8, 12, …, and at last all that are left.
    for (std::size_t after = 1, next = 2; after < longest;
         after = std::exchange(next, next + std::bit_floor(next) / 2)) {
        after = std::min(after, frames_left - 1);
        const double margin = seen.law.after(after, exponent);
        if (!(margin <= seen.growth.longest_margin())) break;
        const double listed = seen.listed(margin);
        const double served = cost_of_service(n, listed, cost) / search;
        if (served >= std::min(best.cost, worth)) break;
        const double made = cost_of_making(n, listed, cost) / static_cast<double>(after + 1) +
                            cost_of_new_memory(n, listed, seen.horizon, cost);
        const double each = served + made / search;
        if (each <= as_little * best.cost) best = {after + 1, margin, std::min(each, best.cost)};
        if (after == frames_left - 1) break;
    }
    if (best.cost >= worth) best.frames = 1;
    return best;
}

}  // namespace aabb
