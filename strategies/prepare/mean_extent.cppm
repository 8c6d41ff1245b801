export module aabb.prepare.mean_extent;

import aabb.global_search;
import aabb.std;

export namespace aabb {

/// A robust mean extent of boxes, over the three axes: boxes about 16 times as long as the median, or longer, are
/// excluded. A single box that bounds half of the scene would otherwise dominate the mean, and margins measured in it
/// would not fit the other boxes; up to half of all boxes may be outliers. Without outliers it is the mean. Boxes of
/// zero extent do not count for the median.
class typical_extent {
public:
    void add(const box& b) noexcept {
        double extent = 0;
        for (int k = 0; k < 3; ++k) extent += (double{b.max[k]} - double{b.min[k]}) / 3;
        octave& of = octaves_[octave_of(extent)];
        ++of.boxes;
        of.sum += extent;
    }

    /// The mean extent of the boxes without outliers; 0 if no box was added. Boxes are counted by octave, a range of
    /// extents from 2^i to 2^(i+1); those more than four octaves above the median are outliers. Extents of 0 (octave 0)
    /// count for the mean only: if they were the median, all others would be outliers.
    [[nodiscard]] double operator()() const noexcept {
        std::size_t longer = 0;  // number of boxes in octaves above `median`
        for (std::size_t i = 1; i < octaves_.size(); ++i) longer += octaves_[i].boxes;
        std::size_t median = 0;  // becomes the first octave with at most half of the boxes above it
        for (std::size_t half = longer / 2; longer > half; longer -= octaves_[median].boxes) ++median;
        octave inliers;
        for (std::size_t i = 0; i < std::min(median + octaves_from_median, octaves_.size()); ++i) {
            inliers.boxes += octaves_[i].boxes;
            inliers.sum += octaves_[i].sum;
        }
        return inliers.boxes == 0 ? 0 : inliers.sum / static_cast<double>(inliers.boxes);
    }

private:
    struct octave {
        std::size_t boxes = 0;
        double sum = 0;
    };
    static constexpr std::size_t octaves_from_median = 5;  // that of the median and four above
    static constexpr int least_exponent = -160;            // less than that of a third of the smallest float
    static constexpr std::size_t count = 160 + 130;        // covers up to twice the greatest float

    /// The index of an extent's octave, from 1 on; index 0 holds zero extents.
    [[nodiscard]] static std::size_t octave_of(double extent) noexcept {
        if (!(extent > 0)) return 0;
        const int exponent = static_cast<int>(std::bit_cast<std::uint64_t>(extent) >> 52U) - 1023;
        return static_cast<std::size_t>(std::clamp(exponent - least_exponent, 1, int{count} - 1));
    }

    std::array<octave, count> octaves_{};
};

/// `times` the typical extent of the present objects; 0 if there are none. The typical extent is the unit of margins.
[[nodiscard]] inline double typical_extents(double times, std::span<const box> boxes,
                                            const membership& objects) noexcept {
    typical_extent extents;
    for (std::uint32_t id = 0; id < boxes.size(); ++id)
        if (objects.contains(id)) extents.add(boxes[id]);
    return times * extents();
}

/// `times` the mean extent over the boxes of the present objects and the three axes; 0 if there are none. The mean
/// extent is the unit of the size above which objects are divided: outliers count, so that only few are divided.
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

}  // namespace aabb
