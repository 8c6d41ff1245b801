export module aabb.prepare.mean_extent;

import aabb.global_search;
import aabb.std;

export namespace aabb {

/// How long boxes are, over the three axes, that are not by far longer than the others: the mean without those that are
/// about 16 times as long as the median, or longer. One box that bounds half of space would decide the mean alone, so
/// that what is measured in it, as margins are, tells nothing of the others; up to half of all boxes may be such. Where
/// none is so long it is the mean. Boxes without extent do not count for the median.
class typical_extent {
public:
    void add(const box& b) noexcept {
        double extent = 0;
        for (int k = 0; k < 3; ++k) extent += (double{b.max[k]} - double{b.min[k]}) / 3;
        octave& of = octaves_[octave_of(extent)];
        ++of.boxes;
        of.sum += extent;
    }

    /// 0 where nothing was added.
    [[nodiscard]] double operator()() const noexcept {
        std::size_t longer = 0;
        for (std::size_t i = 1; i < octaves_.size(); ++i) longer += octaves_[i].boxes;
        std::size_t median = 0;
        for (std::size_t half = longer / 2; longer > half; longer -= octaves_[median].boxes) ++median;
        octave usual;
        for (std::size_t i = 0; i < std::min(median + octaves_above, octaves_.size()); ++i) {
            usual.boxes += octaves_[i].boxes;
            usual.sum += octaves_[i].sum;
        }
        return usual.boxes == 0 ? 0 : usual.sum / static_cast<double>(usual.boxes);
    }

private:
    struct octave {
        std::size_t boxes = 0;
        double sum = 0;
    };
    static constexpr std::size_t octaves_above = 5;  // that of the median, and four more
    static constexpr int least_exponent = -160;      // below that of the least float, over three
    static constexpr std::size_t count = 160 + 130;  // up to twice the greatest

    /// From 1 on, by the power of two below it; 0: no extent.
    [[nodiscard]] static std::size_t octave_of(double extent) noexcept {
        if (!(extent > 0)) return 0;
        const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(extent) >> 52U) - 1023;
        return static_cast<std::size_t>(std::clamp(exponent - least_exponent, 1, int{count} - 1));
    }

    std::array<octave, count> octaves_{};
};

/// `times` the typical extent of the objects that are present, each the mean over the three axes; 0 where nobody is. It
/// is the unit of margins.
[[nodiscard]] inline double typical_extents(double times, std::span<const box> boxes,
                                            const membership& objects) noexcept {
    typical_extent extents;
    for (std::uint32_t id = 0; id < boxes.size(); ++id)
        if (objects.contains(id)) extents.add(boxes[id]);
    return times * extents();
}

/// `times` the mean, over the boxes of the objects that are present and the three axes; 0 where nobody is. It is the
/// unit of the sizes from which objects are divided, which are few, however long.
[[nodiscard]] inline double mean_extents(double times, std::span<const box> boxes, const membership& objects) noexcept {
    double extents = 0;
    std::size_t present = 0;
    for (std::uint32_t id = 0; id < boxes.size(); ++id) {
        if (!objects.contains(id)) continue;
        for (int k = 0; k < 3; ++k) extents += double{boxes[id].max[k]} - double{boxes[id].min[k]};
        ++present;
    }
    return present == 0 ? 0 : times * extents / (3 * static_cast<double>(present));
}

/// The median over a few boxes of their extents, each a mean over the three axes: one huge box hardly changes it. 0
/// where there is none.
/// @param some at most 16
[[nodiscard]] inline double median_extent(std::span<const box> some) noexcept {
    std::array<double, 16> extents{};
    for (std::size_t i = 0; i < some.size(); ++i)
        for (int k = 0; k < 3; ++k) extents[i] += (double{some[i].max[k]} - double{some[i].min[k]}) / 3;
    const auto middle = extents.begin() + static_cast<std::ptrdiff_t>(some.size() / 2);
    std::nth_element(extents.begin(), middle, extents.begin() + static_cast<std::ptrdiff_t>(some.size()));
    return some.empty() ? 0 : *middle;
}

}  // namespace aabb
