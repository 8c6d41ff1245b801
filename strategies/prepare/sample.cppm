/// Estimates from a random sample of boxes.
export module aabb.prepare.sample;

export import aabb.global_search;
import aabb.prepare.pair_list;
import aabb.prepare.relative_motion;
import aabb.std;

export namespace aabb {

/// A pseudorandom id below `count`: ids at regular strides may all belong to objects of one kind.
/// @param ids_drawn number of ids drawn so far
[[nodiscard]] inline std::uint32_t draw_id(std::uint32_t& ids_drawn, std::size_t count) noexcept {
    // Fibonacci hashing (Knuth, The Art of Computer Programming, 6.4), twice: a single pass yields regular strides.
    constexpr std::uint64_t golden_ratio = 0x9e3779b97f4a7c15U;
    std::uint64_t hash = ++ids_drawn * golden_ratio;
    hash = (hash ^ hash >> 32U) * golden_ratio;
    return static_cast<std::uint32_t>((hash >> 32U) * count >> 32U);
}

/// Draws the boxes of random ids, to estimate how the number of overlapping pairs grows with the boxes.
/// @param ids_drawn the state of the random numbers, see `draw_id`
/// @return the drawn boxes, which fill `buffer` except for those of absent objects
[[nodiscard]] inline std::span<const box> draw_boxes(std::span<const box> boxes, const membership& objects,
                                                     std::uint32_t& ids_drawn, std::span<box> buffer) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < buffer.size() && i < boxes.size(); ++i) {
        const std::uint32_t id = draw_id(ids_drawn, boxes.size());
        if (objects.contains(id)) buffer[count++] = boxes[id];
    }
    return buffer.first(count);
}

/// Estimated numbers of pairs, from testing eight sampled boxes against one in 32 of all boxes.
struct pair_estimate {
    double overlapping = 0;
    double within_margin = 0;  ///< pairs that overlap when both boxes are grown by the margin
    std::size_t counted = 0;   ///< number of such pairs in the sample
};
/// Estimates the length of a Verlet list before it is made: tests eight random boxes, as they are and grown by the
/// margin, against one in 32 of all boxes, and extrapolates to all pairs.
/// @param ids_drawn the state of the random numbers, see `draw_id`
[[nodiscard]] inline pair_estimate estimate_pairs(std::span<const box> boxes, const membership& objects,
                                                  std::uint32_t& ids_drawn, double margin) {
    constexpr std::size_t tested = 8, one_in = 32;
    std::array<box, tested> buffer;
    const std::span<const box> sample = draw_boxes(boxes, objects, ids_drawn, buffer);
    std::array<box, tested> grown;
    // Growing one box of a pair by twice the margin is equivalent to growing both by the margin.
    grow(sample, 2 * margin, grown);
    const std::size_t others = std::max(tested, boxes.size() / one_in);
    std::size_t overlapping = 0;
    pair_estimate estimate;
    for (std::size_t k = 0; k < others && !boxes.empty(); ++k) {
        const box& b = boxes[draw_id(ids_drawn, boxes.size())];
        for (std::size_t i = 0; i < sample.size(); ++i) {
            if (!overlap_at_once(b, grown[i]) || b == sample[i]) continue;  // not a pair, or the same box
            ++estimate.counted;
            overlapping += static_cast<std::size_t>(overlap_at_once(b, sample[i]));
        }
    }
    const auto n = static_cast<double>(objects.size());
    // From the tested pairs to all n² / 2.
    const double scale =
        sample.empty() ? 0 : n / static_cast<double>(sample.size()) * n / static_cast<double>(others) / 2;
    estimate.overlapping = static_cast<double>(overlapping) * scale;
    estimate.within_margin = static_cast<double>(estimate.counted) * scale;
    return estimate;
}

/// A sample of boxes whose motion is a lower bound on that of the scene.
class motion_sample {
public:
    /// The number of frames for which a sample is watched.
    static constexpr unsigned longest = 8;

    /// @param ids_drawn as in `draw_id`
    void keep(std::span<const box> boxes, std::uint32_t& ids_drawn) {
        for (std::size_t i = 0; i < ids_.size() && !boxes.empty(); ++i) {
            ids_[i] = draw_id(ids_drawn, boxes.size());
            kept_[i] = boxes[ids_[i]];
        }
    }

    /// How far the boxes of the sample have moved relative to each other since `keep`: a lower bound on
    /// `motion_between` for all boxes. 0 if no object of the sample is left.
    [[nodiscard]] double least_motion(std::span<const box> boxes, const membership& objects) const {
        std::array<box, few> from{}, to{};
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
