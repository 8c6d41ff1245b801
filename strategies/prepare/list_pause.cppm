export module aabb.prepare.list_pause;

export import aabb.prepare.list_plan;
import aabb.std;

export namespace aabb {

/// Frames that are searched as they are, since no list of neighbours was worth its cost: twice as many each time, so
/// that lists tried in vain cost ever less of all frames, and what such a pause loses is at most as long as what went
/// before (exponential back-off; Karlin, Manasse, Rudolph and Sleator, "Competitive snoopy caching", 1988, for what it
/// may cost). Then a few boxes are looked at for eight frames, and again after a rest, until a list may be worth it.
class list_pause {
public:
    [[nodiscard]] bool lasts() const noexcept { return left_ > 0; }

    void begin(std::size_t boxes) noexcept {
        left_ = std::max(next_, rest(boxes)) + glimpse::longest;
        next_ = std::min(2 * next_, longest);
    }
    /// A few boxes are looked at from this frame on.
    void begin_with_look() noexcept { left_ = glimpse::longest + 1; }
    /// A list served as long as it was to: the next pause is short again.
    void shorten() noexcept { next_ = shortest; }

    /// A frame of it. Where even a few boxes move too far for any list, all do, and are not looked at for the rest of
    /// the eight frames. Otherwise the pause ends.
    /// @param seen with the law of these boxes
    /// @param law of the boxes that are looked at
    /// @param drawn as `drawn_id` has it
    /// @returns whether all eight were in vain; others are looked at next
    bool pass(std::span<const box> boxes, const membership& objects, list_outlook& seen, std::uint32_t& drawn) {
        --left_;
        const unsigned age = glimpse::longest - std::min(left_, glimpse::longest);
        if (std::has_single_bit(age) && !move_too_far_) {
            seen.law.observe(age, glimpse_.least_motion(boxes, objects));
            const list_plan plan = plan_list(seen);
            if (plan.frames > 1) {
                left_ = 0;
                return false;
            }
            move_too_far_ = plan.is_hopeless();
        }
        const bool in_vain = left_ == 0;
        if (in_vain) left_ = glimpse::longest + rest(objects.size());
        if (left_ == glimpse::longest) {
            seen.look_anew(boxes, objects, drawn);
            seen.law.forget();
            glimpse_.keep(boxes, drawn);
            move_too_far_ = false;
        }
        return in_vain;
    }

private:
    static constexpr unsigned shortest = 1;
    static constexpr unsigned longest = 64;

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
