/// What a few boxes, drawn by chance, tell of all.
export module aabb.prepare.sample;

export import aabb.global_search;
import aabb.prepare.pair_list;
import aabb.prepare.relative_motion;
import aabb.std;

export namespace aabb {

/// An id below `count`, by chance: what stands at regular places may be of one kind.
/// @param drawn how many were drawn before
[[nodiscard]] inline std::uint32_t drawn_id(std::uint32_t& drawn, std::size_t count) noexcept {
    // Fibonacci hashing (Knuth, The Art of Computer Programming, 6.4), twice: once alone it goes in even steps, which
    // may meet one kind only.
    constexpr std::uint64_t golden_ratio = 0x9e3779b97f4a7c15U;
    std::uint64_t hash = ++drawn * golden_ratio;
    hash = (hash ^ hash >> 32U) * golden_ratio;
    return static_cast<std::uint32_t>((hash >> 32U) * count >> 32U);
}

/// @param drawn as `drawn_id` has it
/// @return as many as `of` holds, fewer where some objects are absent
[[nodiscard]] inline std::span<const box> drawn_boxes(std::span<const box> boxes, const membership& objects,
                                                      std::uint32_t& drawn, std::span<box> of) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < of.size() && i < boxes.size(); ++i) {
        const std::uint32_t id = drawn_id(drawn, boxes.size());
        if (objects.contains(id)) of[count++] = boxes[id];
    }
    return of.first(count);
}

/// Pairs by a rough count: eight boxes against one of thirty-two others.
struct rough_reach {
    double overlapping = 0;
    double in_reach = 0;      ///< when grown by the margin
    std::size_t counted = 0;  ///< of the latter
};
/// @param drawn as `drawn_id` has it
[[nodiscard]] inline rough_reach rough_reach_of(std::span<const box> boxes, const membership& objects,
                                                std::uint32_t& drawn, double margin) {
    std::array<box, 8> some;
    const std::span<const box> asked = drawn_boxes(boxes, objects, drawn, some);
    std::array<box, 8> reach;
    // Both boxes of a pair are grown.
    grow(asked, 2 * margin, reach);
    const std::size_t others = std::max<std::size_t>(8, boxes.size() / 32);
    std::size_t overlapping = 0;
    rough_reach found;
    for (std::size_t k = 0; k < others && !boxes.empty(); ++k) {
        const box& b = boxes[drawn_id(drawn, boxes.size())];
        for (std::size_t i = 0; i < asked.size(); ++i) {
            if (!meet(b, reach[i]) || b == asked[i]) continue;
            ++found.counted;
            overlapping += static_cast<std::size_t>(meet(b, asked[i]));
        }
    }
    const auto n = static_cast<double>(objects.size());
    const double each = asked.empty() ? 0 : n / static_cast<double>(asked.size()) * n / static_cast<double>(others) / 2;
    found.overlapping = static_cast<double>(overlapping) * each;
    found.in_reach = static_cast<double>(found.counted) * each;
    return found;
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

    /// Not more than `motion_between` the kept one and this over all boxes; 0 where none of them is left.
    [[nodiscard]] double least_motion(std::span<const box> boxes, const membership& objects) const {
        std::array<box, few> from{};
        std::array<box, few> to{};
        std::size_t count = 0;
        for (std::size_t i = 0; i < few; ++i) {
            if (ids_[i] >= boxes.size() || !objects.contains(ids_[i])) continue;
            from[count] = kept_[i];
            to[count++] = boxes[ids_[i]];
        }
        return count > 0 ? motion_between(std::span(from).first(count), std::span(to).first(count)).margin : 0;
    }

private:
    static constexpr std::size_t few = 8;

    std::array<std::uint32_t, few> ids_{};
    std::array<box, few> kept_{};
};

}  // namespace aabb
