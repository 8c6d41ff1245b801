module;
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

export module aabb.prepare.list_forecast;

import aabb.geometry;
import aabb.global_search;
import aabb.prepare.list_plan;
import aabb.prepare.mean_extent;
import aabb.prepare.reach;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// How many pairs a list of neighbours will hold, as far as a few boxes tell, and what earlier lists held.
class list_forecast {
public:
    [[nodiscard]] list_outlook outlook(std::span<const double> motion, std::size_t boxes, std::size_t pairs,
                                       const list_horizon& horizon) const {
        return {motion, boxes, pairs, growth_, correction_, horizon};
    }

    void look_anew(std::span<const box> boxes, const membership& objects) {
        std::array<box, 16> some;
        const std::span<const box> drawn = drawn_boxes(boxes, objects, drawn_, some);
        growth_ = growth_of_pairs(drawn);
        extent_ = median_extent(drawn);
    }

    /// Where boxes are by far shorter or longer than those that were looked at, what lists held tells nothing.
    void look_anew_at_other_sizes(std::span<const box> boxes, const membership& objects) {
        constexpr double by_far = 4;
        std::array<box, 8> some;
        const double now = median_extent(drawn_boxes(boxes, objects, drawn_, some));
        if (now > extent_ / by_far && now < by_far * extent_) return;
        look_anew(boxes, objects);
        correction_ = 1;
        looked_up_ = 0;
    }

    /// Reckons the next list.
    /// @returns pairs beside those that overlap
    double foresee(const list_outlook& seen, double margin) {
        foreseen_ = pairs_listed(seen, margin) - pairs_listed(seen, 0);
        return foreseen_;
    }
    /// The next list is not reckoned.
    void foresee_nothing() noexcept { foreseen_ = 0; }
    [[nodiscard]] bool is_reckoned() const noexcept { return foreseen_ > 0; }

    /// What was reckoned turned out otherwise.
    /// @param beside pairs that the list held beside those that overlapped
    void correct(double beside) {
        if (is_reckoned()) correction_ = std::clamp(correction_ * beside / foreseen_, 0.3, 1000.0);
    }

    /// The longest margin of which it is known how long a list is, from one or from a sample; 0 where there was none.
    [[nodiscard]] double looked_up() const noexcept { return looked_up_; }
    void take_as_looked_up(double margin) noexcept { looked_up_ = margin; }

    /// Asks a sample how long the list will be that was reckoned last: it may hold each box with every other, or as
    /// boxes on a surface fewer than are reckoned.
    /// @param pays what was reckoned: only more pairs change that, and where it does not, only fewer
    /// @returns whether there is to be reckoned again
    bool look_up(std::span<const box> boxes, const membership& objects, double margin, std::size_t found, bool pays) {
        looked_up_ = margin;
        const double beside = pairs_in_reach(boxes, objects, drawn_, margin) - static_cast<double>(found);
        if (pays ? beside <= 2 * foreseen_ + static_cast<double>(objects.size()) : beside >= foreseen_) return false;
        correct(beside);
        return true;
    }

    /// A rough count of the pairs of a list with that margin.
    [[nodiscard]] rough_reach reach(std::span<const box> boxes, const membership& objects, double margin) {
        return rough_reach_of(boxes, objects, drawn_, margin);
    }

    /// Whether half of a list would not pay, by a rough count of it: it may hold each box with every other, whatever is
    /// reckoned.
    [[nodiscard]] static bool is_far_too_long(const rough_reach& reach, std::size_t boxes, std::size_t found) {
        constexpr std::size_t by_chance = 8;
        const auto overlapping = std::max(found, static_cast<std::size_t>(reach.overlapping));
        return reach.counted >= by_chance && !pays(boxes, overlapping, static_cast<std::size_t>(reach.in_reach / 2));
    }

    /// Boxes that were drawn for samples, for whoever draws others (`drawn_id`).
    [[nodiscard]] std::uint32_t& drawn() noexcept { return drawn_; }

private:
    growth_of_pairs growth_;
    double extent_ = 0;      // of boxes, when that was looked at
    double foreseen_ = 0;    // pairs of the list beside those that overlap, as they were reckoned
    double correction_ = 1;  // of that
    double looked_up_ = 0;
    std::uint32_t drawn_ = 0;
};

}  // namespace aabb
