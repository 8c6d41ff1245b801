export module aabb.prepare.list_plan;

import aabb.costs;
export import aabb.prepare.displacement_law;
export import aabb.prepare.sample;
import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

// The cost per frame of a Verlet list whose boxes are grown by a margin m and which serves k frames, including the one
// that makes it (Verlet, "Computer 'experiments' on classical fluids", 1967; Chialvo and Debenedetti, "On the use of
// the Verlet neighbor list in molecular dynamics", 1990, minimize it likewise):
//
//     M(m) / k + S(m),  m = d(k - 1),
//     M(m) = n (keep + search) + L(m) find,  searching n boxes that are grown and kept,
//     S(m) = n watch + L(m) test,            serving a frame from the list,
//     L(m) = P (1 + c (g(m) - 1)),           the number of listed pairs,
//
// where d is the displacement of boxes (`displacement_law`), P the number of overlapping pairs, g their growth for
// uniformly spread boxes (`growth_of_pairs`) and c the correction learned from the last list. Without a list a frame
// costs n search + P find. The cost per box and per pair is a machine cost (`cost_model`).
export namespace aabb {

/// The factor by which the number of overlapping pairs grows with the margin of the boxes. For uniformly spread boxes,
/// the number is proportional to the mean over pairs of the product of their summed extents on the three axes, a
/// polynomial in the margin. An axis on which boxes lie closer than their extents is ignored: they overlap anyway.
class growth_of_pairs {
public:
    growth_of_pairs() = default;
    /// Sums the polynomial (e0 + x) (e1 + x) (e2 + x) over pairs of successive sampled boxes: ek is the sum of both
    /// extents on axis k, x its growth, four margins. An axis on which boxes lie closer than that sum has no factor.
    explicit growth_of_pairs(std::span<const box> sample) {
        vec3d lengths{};
        box lower_corners = empty_box();
        for (const box& b : sample) {
            lower_corners = merged(lower_corners, box{b.min, b.min});
            for (int k = 0; k < 3; ++k) lengths[k] += double{b.max[k]} - double{b.min[k]};
        }
        const auto spread = [&](int k) { return double{lower_corners.max[k]} - double{lower_corners.min[k]}; };
        // Four mean extents, beyond which the polynomial is not reliable.
        longest_margin_ = 4 * (lengths[0] + lengths[1] + lengths[2]) / (3.0 * static_cast<double>(sample.size()));
        for (std::size_t i = 1; i < sample.size(); ++i) {
            std::array<double, 4> product{1, 0, 0, 0};
            // product[i] is the coefficient of x^i; each axis multiplies the polynomial by (extents + x).
            for (int k = 0; k < 3; ++k) {
                if (spread(k) <= lengths[k] / static_cast<double>(sample.size())) continue;
                double extents = 0;
                for (const box& b : {sample[i - 1], sample[i]}) extents += double{b.max[k]} - double{b.min[k]};
                for (std::size_t power = 3; power > 0; --power)
                    product[power] = product[power] * extents + product[power - 1];
                product[0] *= extents;
            }
            for (std::size_t power = 0; power < 4; ++power) sum_[power] += product[power];
        }
    }

    [[nodiscard]] double factor(double margin) const {
        const double x = 4 * margin;
        return sum_[0] > 0 ? 1 + x * (sum_[1] + x * (sum_[2] + x * sum_[3])) / sum_[0] : 1;
    }
    /// The share of the overlapping pairs that overlap by more than two margins.
    [[nodiscard]] double certain_share(double margin) const {
        return 8 * margin < longest_margin_ ? std::max(factor(-margin), 0.0) : 0;
    }
    /// Four mean extents; beyond that the model is not reliable.
    [[nodiscard]] double longest_margin() const { return longest_margin_; }

private:
    std::array<double, 4> sum_{};
    double longest_margin_ = 0;
};

/// Limits of the next list that do not depend on the motion of the boxes.
struct list_horizon {
    /// Number of frames until the list ends in any case, including the one that makes it.
    std::size_t frames_left = std::numeric_limits<std::size_t>::max();
    bool in_new_memory = false;  ///< the list needs new memory: it is the first, or the last one's was released
};

/// The estimates from which the next Verlet list is planned.
struct list_estimate {
    displacement_law law{};
    std::size_t boxes = 0;
    std::size_t pairs = 0;  ///< number of overlapping pairs
    growth_of_pairs growth{};
    double correction = 1;  ///< actual over estimated number of non-overlapping pairs in the last list
    list_horizon horizon{};

    /// Estimates the growth again, from a new sample.
    /// @param ids_drawn as in `draw_id`
    void resample(std::span<const box> boxes_by_id, const membership& objects, std::uint32_t& ids_drawn) {
        std::array<box, 16> sample;
        growth = growth_of_pairs(draw_boxes(boxes_by_id, objects, ids_drawn, sample));
    }
    /// The estimated number of pairs in a list with this margin.
    [[nodiscard]] double listed_pairs(double margin) const {
        return static_cast<double>(pairs + 1) * (1 + correction * (growth.factor(margin) - 1));
    }
    /// Learns the correction from a finished list. Adding one damps the ratio of small counts; the lower bound keeps a
    /// sample that overestimates the growth from predicting nearly empty lists for other margins.
    void learn(double margin, std::size_t listed) {
        constexpr double least = 0.3;
        const double estimate = static_cast<double>(pairs + 1) * (growth.factor(margin) - 1);
        const double excess = listed < pairs ? 0 : static_cast<double>(listed - pairs);
        correction = std::max(least, (excess + 1) / (estimate + 1));
    }
};

/// The cheapest list: its number of frames, including the one that makes it, and the margin needed to serve them.
struct list_plan {
    std::size_t frames = 1;  ///< 1 if no list is worth its cost
    double margin = 0;
    double cost = std::numeric_limits<double>::infinity();  ///< per frame, relative to a search

    /// Serving a frame alone costs too much, however many frames the list serves.
    [[nodiscard]] bool is_hopeless() const noexcept { return std::isinf(cost); }
};

/// A list must cost less than this share of a search, since the model ignores the cache space that it occupies.
inline constexpr double worth_a_list = 0.9;

/// The cost of searching a frame without a list, and of serving one from a list.
[[nodiscard]] inline double cost_of_search(double boxes, double pairs, const cost_model& cost) {
    return boxes * cost.search_box + pairs * cost.search_pair;
}
[[nodiscard]] inline double cost_of_service(double boxes, double listed, const cost_model& cost) {
    return boxes * cost.watch_box + listed * cost.test_pair;
}
/// The cost of making a list. Planning takes a constant time, modelled as additional boxes.
[[nodiscard]] inline double cost_of_making(double boxes, double listed, const cost_model& cost) {
    constexpr double boxes_of_planning = 64;
    return (boxes + boxes_of_planning) * cost.keep_box + cost_of_search(boxes + boxes_of_planning, listed, cost);
}
/// The additional cost per frame of making the list in new memory, spread over the remaining frames: page faults make
/// it take about four times as long as making later lists, which reuse the pages.
[[nodiscard]] inline double cost_of_new_memory(double boxes, double listed, const list_horizon& horizon,
                                               const cost_model& cost) {
    constexpr double times_as_long = 4;
    if (!horizon.in_new_memory) return 0;
    return (times_as_long - 1) * cost_of_making(boxes, listed, cost) / static_cast<double>(horizon.frames_left);
}

/// Whether serving a frame from a list of this length costs less than searching it.
[[nodiscard]] inline bool is_list_worth_it(std::size_t boxes, std::size_t pairs, std::size_t listed,
                                           const cost_model& cost = machine_costs()) {
    const auto n = static_cast<double>(boxes);
    return cost_of_service(n, static_cast<double>(listed), cost) <
           worth_a_list * cost_of_search(n, static_cast<double>(pairs), cost);
}

/// Whether shortening a Verlet list is worth its cost, assuming that it saves half of the tests in each further frame:
/// the shortening itself takes time, and the shorter list ends sooner, so that the next one is made sooner.
/// @param tested number of listed pairs that each frame tests
/// @param frames number of frames that the list still serves
[[nodiscard]] inline bool is_shortening_worth_it(std::size_t boxes, std::size_t pairs, std::size_t tested,
                                                 std::size_t frames, const cost_model& cost = machine_costs()) {
    const auto n = static_cast<double>(boxes);
    const double one_round = static_cast<double>(tested) * cost.test_pair;
    // Each pair is tested twice: whether it stays listed, and whether it is certain.
    const double shortened = n * cost.keep_box + 2 * one_round;
    const double made_sooner = n * cost.keep_box + cost_of_search(n, static_cast<double>(pairs), cost);
    return one_round / 2 * static_cast<double>(frames) > shortened + made_sooner;
}

/// Whether it is worth its cost to find the certain pairs of a list, which later frames then do not test. Finding them
/// takes as long as two tests of each pair.
[[nodiscard]] inline bool is_marking_worth_it(const list_estimate& estimate, std::size_t listed, double margin) {
    const double certain = static_cast<double>(estimate.pairs) * estimate.growth.certain_share(margin);
    const double frames_left = estimate.law.age_at(margin) - static_cast<double>(estimate.law.age());
    return certain * frames_left > 2 * static_cast<double>(listed);
}

/// The plan of least cost per frame, relative to a search; of plans within 1%, the one for the most frames, since
/// motion may be underestimated. A list for more frames is made less often, but its greater margin adds pairs to test.
/// @param worth a list must cost less than this share of a search per frame
[[nodiscard]] inline list_plan plan_list(const list_estimate& estimate, double worth = worth_a_list,
                                         const cost_model& cost = machine_costs()) {
    constexpr double about_as_little = 1.01;
    constexpr std::size_t longest = 1024;  // frames
    const auto n = static_cast<double>(estimate.boxes);
    list_plan best;
    const std::size_t frames_left = estimate.horizon.frames_left;
    if (estimate.law.age() == 0 || frames_left < 2) return best;  // no motion is known, or there is no frame to serve
    const double search = cost_of_search(n, estimate.listed_pairs(0), cost);
    const double exponent = estimate.law.exponent();
    // Numbers of served frames after the one that makes the list: 1, 2, 3, 4, 6, 8, 12, …, up to all remaining frames.
    for (std::size_t after = 1, next = 2; after < longest;
         after = std::exchange(next, next + std::bit_floor(next) / 2)) {
        after = std::min(after, frames_left - 1);
        const double margin = estimate.law.displacement_after(after, exponent);
        if (!(margin <= estimate.growth.longest_margin())) break;
        const double listed = estimate.listed_pairs(margin);
        const double serving = cost_of_service(n, listed, cost) / search;
        if (serving >= std::min(best.cost, worth)) break;  // and longer lists, of greater margins, cost even more
        const double making = cost_of_making(n, listed, cost) / static_cast<double>(after + 1) +
                              cost_of_new_memory(n, listed, estimate.horizon, cost);
        const double per_frame = serving + making / search;
        if (per_frame <= about_as_little * best.cost) best = {after + 1, margin, std::min(per_frame, best.cost)};
        if (after == frames_left - 1) break;
    }
    if (best.cost >= worth) best.frames = 1;
    return best;
}

}  // namespace aabb
