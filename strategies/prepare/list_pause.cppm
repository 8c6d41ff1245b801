module;
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <span>

export module aabb.prepare.list_pause;

import aabb.geometry;
import aabb.global_search;
import aabb.prepare.glimpse;
import aabb.prepare.list_forecast;
import aabb.prepare.list_plan;

export namespace aabb {

/// Frames that are searched as they are, since no list of neighbours paid: ever more each time, and then a few boxes
/// are looked at for eight frames, and again after a rest, until they say that one may. The fewer boxes there are, the
/// longer it takes to see that they have come to rest, and the less each of these frames costs.
class list_pause {
public:
    [[nodiscard]] bool lasts() const noexcept { return left_ > 0; }

    void begin(std::size_t boxes) noexcept {
        left_ = std::max(next_, rest(boxes)) + glimpse::longest;
        next_ = std::min(2 * next_, longest);
    }
    /// A few boxes are looked at from this frame on.
    void begin_with_look() noexcept { left_ = glimpse::longest + 1; }
    /// A list is kept: the next pause is short again.
    void shorten() noexcept { next_ = shortest; }

    /// A frame of it. Where even a few boxes move too far for any list, all do, and are not looked at for the rest of
    /// the eight frames.
    /// @param worth what a list must cost less than, over a search in every frame, to end the pause
    /// @returns whether all eight were in vain; others are looked at next
    bool pass(std::span<const box> boxes, const membership& objects, std::size_t found, list_forecast& forecast,
              const list_horizon& horizon, double worth) {
        --left_;
        const unsigned age = glimpse::longest - std::min(left_, glimpse::longest);
        if (std::has_single_bit(age) && !move_too_far_) {
            const list_plan plan =
                plan_list(forecast.outlook(glimpse_.least_motion(boxes, objects, age), objects.size(), found, horizon),
                          worth, worth);
            if (plan.frames > 1) {
                left_ = 0;
                return false;
            }
            move_too_far_ = std::isinf(plan.cost);
        }
        const bool in_vain = left_ == 0;
        if (in_vain) left_ = glimpse::longest + rest(objects.size());
        if (left_ == glimpse::longest) {
            forecast.look_anew_at_other_sizes(boxes, objects);
            glimpse_.keep(boxes, forecast.drawn());
            move_too_far_ = false;
        }
        return in_vain;
    }

private:
    static constexpr unsigned shortest = 6;
    static constexpr unsigned longest = 96;

    /// Frames between looks. Eight frames of looking take about as long as searching 70 boxes, however many there are:
    /// that is to be about a twentieth of what searching takes meanwhile.
    [[nodiscard]] static unsigned rest(std::size_t boxes) noexcept {
        return 1400 / static_cast<unsigned>(std::max<std::size_t>(boxes, 1));
    }

    unsigned left_ = 0;         // frames that are searched as they are before one is kept again
    unsigned next_ = shortest;  // as long as the next one is
    glimpse glimpse_;
    bool move_too_far_ = false;  // the few boxes, for any list
};

}  // namespace aabb
