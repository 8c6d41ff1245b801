module;
#include <algorithm>
#include <array>
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
/// pairs of them of the product of what they reach on three axes, a polynomial in the margin. An axis on which no box
/// has an extent counts for nothing: all lie at one height there, mostly.
class growth_of_pairs {
public:
    growth_of_pairs() = default;
    /// @param some boxes of the scene, in any order
    explicit growth_of_pairs(std::span<const box> some) {
        vec3d lengths{};
        for (const box& b : some)
            for (int k = 0; k < 3; ++k) lengths[k] += double{b.max[k]} - double{b.min[k]};
        longest_margin_ = 4 * (lengths[0] + lengths[1] + lengths[2]) / (3.0 * static_cast<double>(some.size()));
        for (std::size_t i = 1; i < some.size(); ++i) {
            std::array<double, 4> product{1, 0, 0, 0};
            for (int k = 0; k < 3; ++k) {
                if (lengths[k] == 0) continue;
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

/// What is known of a scene when the next list of neighbours is planned.
struct list_outlook {
    /// By how much boxes moved relative to each other since the last search, frame by frame; see `relative_motion`.
    std::span<const double> motion;
    std::size_t boxes = 0;
    std::size_t pairs = 0;  ///< that overlap
    growth_of_pairs growth;
    double correction = 1;  ///< pairs that the last list held beside those that overlapped, over what was reckoned
};

/// For how many frames a list is to serve, its own included, and the margin by which boxes are grown for that.
struct list_plan {
    std::size_t frames = 1;  ///< 1 where no list pays
    double margin = 0;
    double cost = std::numeric_limits<double>::infinity();  ///< of the cheapest list a frame, over that of a search
};

/// The margin that a list needs to serve so many frames after its own: what was seen, and further on in a line through
/// the second half of it, and a little more. So what jiggles about its place needs little more than it moved, what
/// drifts ever more.
[[nodiscard]] inline double margin_after(std::span<const double> motion, std::size_t frames) {
    constexpr double a_little_more = 1.01;
    const std::size_t seen = motion.size();
    if (frames <= seen) return a_little_more * *std::ranges::max_element(motion.first(frames));
    const std::size_t half = seen / 2;
    const double last = *std::ranges::max_element(motion);
    const double before = half > 0 ? motion[half - 1] : 0;
    const double slope = std::max(0.0, last - before) / static_cast<double>(seen - half);
    return a_little_more * (last + slope * static_cast<double>(frames - seen));
}

/// A list must cost less than this part of a search: what it takes of the caches is not reckoned.
inline constexpr double worth_a_list = 0.87;

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

/// Whether a frame that a list of so many pairs serves costs less than one that is searched.
[[nodiscard]] inline bool pays(std::size_t boxes, std::size_t pairs, std::size_t listed,
                               const cost_model& cost = machine_costs()) {
    const auto n = static_cast<double>(boxes);
    return cost_of_service(n, static_cast<double>(listed), cost) <
           worth_a_list * cost_of_search(n, static_cast<double>(pairs), cost);
}

/// The plan that costs least a frame.
[[nodiscard]] inline list_plan plan_list(const list_outlook& seen, const cost_model& cost = machine_costs()) {
    constexpr std::array<std::size_t, 19> lifetimes{2,  3,  4,  5,  6,  8,  10,  12,  16, 20,
                                                    24, 32, 40, 48, 64, 96, 128, 192, 256};
    const auto n = static_cast<double>(seen.boxes);
    list_plan best;
    if (seen.motion.empty()) return best;
    const double search = cost_of_search(n, pairs_listed(seen, 0), cost);
    double least = worth_a_list * search;
    for (const std::size_t frames : lifetimes) {
        const double margin = margin_after(seen.motion, frames - 1);
        if (!(margin <= seen.growth.longest_margin())) break;
        const double listed = pairs_listed(seen, margin);
        const double served = cost_of_service(n, listed, cost);
        const double made = n * cost.keep_box + cost_of_search(n, listed, cost);
        const double each = made / static_cast<double>(frames) + served;
        best.cost = std::min(best.cost, each / search);
        if (served >= least) break;
        if (each >= least) continue;
        least = each;
        best.frames = frames;
        best.margin = margin;
    }
    return best;
}

}  // namespace aabb
