module;
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

export module aabb.local_detection:leaf_front;

import aabb.base;
import aabb.geometry;

export namespace aabb {

/// Two models, by their numbers, and as they are: each refit makes another state.
struct model_pair {
    std::array<std::uint64_t, 2> numbers;
    std::array<std::uint64_t, 2> states;
};

/// Two leaves, and which of their triangles may meet: bit 8 j + i for triangle i of A's leaf and j of B's.
struct kept_pair {
    std::uint32_t leaf_a;
    std::uint32_t leaf_b;
    std::uint64_t which;
};

/// Pairs of leaves of two trees whose triangles came within a margin of each other at one pose. As long as no point of
/// B has moved further than that in A's frame, all whose triangles meet are among them. Such pairs are kept from query
/// to query by front tracking (Ehmann and Lin, Computer Graphics Forum 20, 2001), and with a margin by neighbour lists
/// (Verlet, Physical Review 159, 1967).
class leaf_front {
public:
    explicit leaf_front(const model_pair& of) : numbers_(of.numbers) {}

    [[nodiscard]] std::span<const kept_pair> pairs() const noexcept { return pairs_; }

    /// Whether all pairs that meet at this pose are among these.
    /// @param reach box of B's vertices, in its own frame
    [[nodiscard]] bool holds(const model_pair& of, const box_motion& at, const box& reach) const noexcept {
        return margin_ >= 0 && made_states_ == of.states && most_apart(made_at_, at, reach) <= margin_;
    }
    /// Whether the last query was one of the same models about there.
    [[nodiscard]] bool is_near(const model_pair& of, const box_motion& at, const box& reach,
                               double near) const noexcept {
        return numbers_ == of.numbers && most_apart(last_at_, at, reach) <= near;
    }

    /// Notes a query.
    void take(const model_pair& of, const box_motion& at) noexcept {
        last_states_ = of.states;
        last_at_ = at;
        served_ += margin_ >= 0;
    }

    /// Where these do not hold, decides whether others are worth making: where B has moved little since the last query
    /// and neither has changed, unless those made before were of no use.
    /// @param size of a leaf
    /// @returns the margin, or nothing: one that serves long holds many pairs, so that it grows like the root of the
    /// step
    [[nodiscard]] std::optional<double> plan(const model_pair& of, const box_motion& at, const box& reach,
                                             double size) noexcept {
        if (margin_ >= 0) {
            failures_ = served_ < least_served ? std::min(failures_ + 1, most_failures) : 0;
            waits_ = (1U << failures_) - 1;
            margin_ = -1;
        }
        if (waits_ > 0) {
            --waits_;
            return std::nullopt;
        }
        if (last_states_ != of.states) return std::nullopt;
        const double step = most_apart(last_at_, at, reach);
        if (!(step <= most_step * size)) return std::nullopt;
        return std::sqrt(step * size / 5);
    }

    /// @param fill called as `fill(pairs)`, of which there are none
    template <class Fill>
    void make(const model_pair& of, const box_motion& at, double margin, const Fill& fill) {
        pairs_.clear();
        fill(pairs_);
        made_states_ = of.states;
        made_at_ = at;
        margin_ = margin;
        served_ = 0;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(pairs_); }

    /// Of a leaf's size: beyond, so much lies within a margin that serves long that a walk from the roots is faster.
    static constexpr double most_step = 1.0 / 32;

    /// A pair of triangles that met in the last query for one.
    std::optional<index_pair> hit;

private:
    static constexpr std::uint32_t least_served = 2;
    static constexpr std::uint32_t most_failures = 6;

    std::array<std::uint64_t, 2> numbers_;
    std::array<std::uint64_t, 2> last_states_{};  // of a query; no model's at first
    box_motion last_at_{};
    std::array<std::uint64_t, 2> made_states_{};
    box_motion made_at_{};
    double margin_ = -1;
    std::vector<kept_pair> pairs_;
    std::uint32_t served_ = 0;
    std::uint32_t failures_ = 0;
    std::uint32_t waits_ = 0;
};

}  // namespace aabb
