export module aabb.prepare.list_backoff;

export import aabb.prepare.list_plan;
import aabb.std;

export namespace aabb {

/// Exponential back-off after a Verlet list that was not worth its cost: frames are searched directly, twice as many
/// each time, so that failed lists cost an ever smaller share of all frames, and a back-off lasts at most as long as
/// the frames before it (Karlin, Manasse, Rudolph and Sleator, "Competitive snoopy caching", 1988, bound the loss).
/// Then a sample of boxes is watched for eight frames, repeatedly with a rest in between, until a list may be worth it.
class list_backoff {
public:
    [[nodiscard]] bool is_active() const noexcept { return left_ > 0; }

    void begin(std::size_t boxes) noexcept {
        left_ = std::max(next_, frames_between_samples(boxes)) + motion_sample::longest;
        next_ = std::min(2 * next_, longest);
    }
    /// Begins by watching a sample of boxes from this frame on.
    void begin_with_sample() noexcept { left_ = motion_sample::longest + 1; }
    /// A list served as long as planned, so the next back-off is short again.
    void shorten() noexcept { next_ = shortest; }

    /// Advances a back-off by one frame; `left_` frames remain. In the last eight, the displacement of a random sample
    /// of boxes is measured, and the back-off ends early once a Verlet list seems worth its cost. If the sample already
    /// moves too far for any list, so does the whole scene, and these frames need no further measurement.
    /// @param estimate its law becomes that of the sample
    /// @param ids_drawn the state of the random numbers, see `draw_id`
    /// @returns whether all eight frames passed without a list; then another sample is watched later
    bool advance_frame(std::span<const box> boxes, const membership& objects, list_estimate& estimate,
                       std::uint32_t& ids_drawn) {
        --left_;
        const unsigned age = motion_sample::longest - std::min(left_, motion_sample::longest);  // of the sample, or 0
        // At the ages 1, 2, 4 and 8 the motion is measured, which suffices to fit its growth.
        if (std::has_single_bit(age) && !move_too_far_) {
            estimate.law.observe(age, sample_.least_motion(boxes, objects));
            const list_plan plan = plan_list(estimate);
            if (plan.frames > 1) {
                left_ = 0;
                return false;
            }
            move_too_far_ = plan.is_hopeless();
        }
        const bool has_failed = left_ == 0;
        if (has_failed) left_ = motion_sample::longest + frames_between_samples(objects.size());
        if (left_ == motion_sample::longest) {  // from now on a new sample is watched
            estimate.resample(boxes, objects, ids_drawn);
            estimate.law.forget();
            sample_.keep(boxes, ids_drawn);
            move_too_far_ = false;
        }
        return has_failed;
    }

private:
    static constexpr unsigned shortest = 1;
    static constexpr unsigned longest = 64;

    /// The number of frames between samples. Watching a sample for eight frames takes about as long as searching 70
    /// boxes, whatever the size of the scene, and is to cost about a twentieth of the searches meanwhile.
    [[nodiscard]] static unsigned frames_between_samples(std::size_t boxes) noexcept {
        return 1400 / static_cast<unsigned>(std::max<std::size_t>(boxes, 1));
    }

    unsigned left_ = 0;         // remaining frames of the back-off
    unsigned next_ = shortest;  // length of the next back-off
    motion_sample sample_;
    bool move_too_far_ = false;  // the sampled boxes move too far for any list
};

}  // namespace aabb
