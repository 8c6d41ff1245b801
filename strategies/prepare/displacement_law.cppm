export module aabb.prepare.displacement_law;

import aabb.std;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

export namespace aabb {

/// The displacement of boxes relative to each other over time, as a power law: d(t) = d(a) (t/a)^h, where a is the
/// observed time. The exponent h characterizes the motion: 0 oscillation, 1/2 random walk, 1 drift, 2 free fall from
/// rest. It is the slope of d on a log-log scale since an earlier age (Einstein 1905 for 1/2; Metzler and Klafter, "The
/// random walk's guide to anomalous diffusion", 2000, for the others).
class displacement_law {
public:
    /// Discards all observations; without any, boxes are assumed to drift.
    void forget() noexcept { *this = {}; }
    /// Restarts ages at this frame. The exponent keeps its value until two frames have been observed.
    void begin() noexcept {
        known_exponent_ = exponent();
        age_ = 0;
        farthest_ = at_octave_ = before_ = 0;
    }

    /// @param age in frames; increasing from call to call, without skipping a power of two
    /// @param moved relative displacement of the boxes since the frame of age 0
    void observe(std::size_t age, double moved) noexcept {
        age_ = age;
        farthest_ = std::max(farthest_, moved);
        if (std::has_single_bit(age)) before_ = std::exchange(at_octave_, farthest_);
    }

    [[nodiscard]] std::size_t age() const noexcept { return age_; }
    /// The greatest observed displacement.
    [[nodiscard]] double farthest() const noexcept { return farthest_; }
    [[nodiscard]] double exponent() const noexcept {
        if (age_ < 2 || !(before_ > 0)) return known_exponent_;
        const double times = static_cast<double>(age_) / static_cast<double>(std::bit_floor(age_ / 2));
        return std::min(std::log2(farthest_ / before_) / std::log2(times), fastest);
    }

    /// @param exponent that of this law, passed in so that repeated calls compute it once
    /// @param frames at least 1
    [[nodiscard]] double displacement_after(std::size_t frames, double exponent) const noexcept {
        return farthest_ * std::pow(static_cast<double>(frames) / static_cast<double>(age_), exponent);
    }
    [[nodiscard]] double displacement_after(std::size_t frames) const noexcept {
        return displacement_after(frames, exponent());
    }
    /// The age at which the displacement equals a distance; infinite if it never does.
    [[nodiscard]] double age_at(double distance) const noexcept {
        return static_cast<double>(age_) * std::pow(distance / farthest_, 1 / exponent());
    }

private:
    static constexpr double drift = 1;
    static constexpr double fastest = 2;

    double known_exponent_ = drift;
    std::size_t age_ = 0;
    double farthest_ = 0;
    double at_octave_ = 0;  // displacement at the greatest power of two up to the age
    double before_ = 0;     // displacement at half of that age
};

}  // namespace aabb
