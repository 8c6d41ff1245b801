export module aabb.prepare.displacement_law;

import aabb.std;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

export namespace aabb {

/// How far boxes get relative to each other in a time, by a power law: d(t) = d(a) (t/a)^h, where a is how long they
/// have been watched. The exponent h tells how they move: 0 what swings about its place, 1/2 a random walk, 1 a drift,
/// 2 what falls from rest. It is the slope of d in doubly logarithmic scales since an earlier age (Einstein 1905 for
/// 1/2; Metzler and Klafter, "The random walk's guide to anomalous diffusion", 2000, for the others).
class displacement_law {
public:
    /// Nothing is known of how boxes move: they may drift.
    void forget() noexcept { *this = {}; }
    /// Ages count from this frame on. The exponent stays what it was until boxes are two frames old.
    void begin() noexcept {
        known_exponent_ = exponent();
        age_ = 0;
        farthest_ = at_octave_ = before_ = 0;
    }

    /// @param age in frames; greater than the last one, and no power of two is left out
    /// @param moved by how much boxes have moved relative to each other since the frame of age 0
    void observe(std::size_t age, double moved) noexcept {
        age_ = age;
        farthest_ = std::max(farthest_, moved);
        if (std::has_single_bit(age)) before_ = std::exchange(at_octave_, farthest_);
    }

    [[nodiscard]] std::size_t age() const noexcept { return age_; }
    /// The farthest that boxes have been.
    [[nodiscard]] double farthest() const noexcept { return farthest_; }

    [[nodiscard]] double exponent() const noexcept {
        if (age_ < 2 || !(before_ > 0)) return known_exponent_;
        const double times = static_cast<double>(age_) / static_cast<double>(std::bit_floor(age_ / 2));
        return std::min(std::log2(farthest_ / before_) / std::log2(times), fastest);
    }

    /// @param exponent of this law, for whoever asks more than once
    /// @param frames at least 1
    [[nodiscard]] double after(std::size_t frames, double exponent) const noexcept {
        return farthest_ * std::pow(static_cast<double>(frames) / static_cast<double>(age_), exponent);
    }
    [[nodiscard]] double after(std::size_t frames) const noexcept { return after(frames, exponent()); }
    /// The age at which they have come so far; infinite where they never do.
    [[nodiscard]] double until(double distance) const noexcept {
        return static_cast<double>(age_) * std::pow(distance / farthest_, 1 / exponent());
    }

private:
    static constexpr double drift = 1;
    static constexpr double fastest = 2;

    double known_exponent_ = drift;
    std::size_t age_ = 0;
    double farthest_ = 0;
    double at_octave_ = 0;  // how far at the greatest power of two that is no greater than the age
    double before_ = 0;     // and at half of that
};

}  // namespace aabb
