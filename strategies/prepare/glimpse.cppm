module;
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

export module aabb.prepare.glimpse;

import aabb.geometry;
import aabb.global_search;
import aabb.prepare.relative_motion;

export namespace aabb {

/// An id below `count`, by chance: what stands at regular places may be of one kind.
/// @param drawn how many were drawn before
[[nodiscard]] inline std::uint32_t drawn_id(std::uint32_t& drawn, std::size_t count) noexcept {
    // Fibonacci hashing (Knuth, The Art of Computer Programming, 6.4).
    const std::uint32_t hash = ++drawn * 0x9e3779b1U;
    return static_cast<std::uint32_t>(std::uint64_t{hash} * count >> 32U);
}

/// A few boxes, which say that all have moved at least so far.
class glimpse {
public:
    /// Frames that it looks on.
    static constexpr unsigned longest = 8;

    /// @param drawn as `drawn_id` has it
    void keep(std::span<const box> boxes, std::uint32_t& drawn) {
        for (std::size_t i = 0; i < ids_.size() && !boxes.empty(); ++i) {
            ids_[i] = drawn_id(drawn, boxes.size());
            kept_[i] = boxes[ids_[i]];
        }
    }

    /// Frame by frame, not more than `motion_between` the kept one and any until that, over all boxes; 0 where none is
    /// left. Frames that were not looked at are as the next one.
    /// @param age how many frames ago it was kept, each power of two in turn
    [[nodiscard]] std::span<const double> least_motion(std::span<const box> boxes, const membership& objects,
                                                       unsigned age) {
        std::array<box, few> from{};
        std::array<box, few> to{};
        std::size_t count = 0;
        for (std::size_t i = 0; i < few; ++i) {
            if (ids_[i] >= boxes.size() || !objects.contains(ids_[i])) continue;
            from[count] = kept_[i];
            to[count++] = boxes[ids_[i]];
        }
        double moved = count > 0 ? motion_between(std::span(from).first(count), std::span(to).first(count)).margin : 0;
        if (age > 1) moved = std::max(moved, motion_[age / 2 - 1]);
        for (std::size_t frame = age / 2; frame < age; ++frame) motion_[frame] = moved;
        return std::span(motion_).first(age);
    }

private:
    static constexpr std::size_t few = 8;

    std::array<std::uint32_t, few> ids_{};
    std::array<box, few> kept_{};
    std::array<double, longest> motion_{};
};

}  // namespace aabb
