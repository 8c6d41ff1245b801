export module aabb.pipeline:detector_in_double;

import aabb.geometry;
import aabb.std;

export namespace aabb {

/// A `detector` of boxes, or an `auto_detector`, that takes boxes in double. It searches the boxes rounded to floats,
/// and tests the pairs found in double, so that the result is exact.
template <class Detector>
class detector_in_double {
public:
    /// Takes the arguments of the detector.
    template <class... Arguments>
        requires std::constructible_from<Detector, Arguments...>
    explicit detector_in_double(Arguments&&... arguments) : detector_(std::forward<Arguments>(arguments)...) {}

    /// Like those of the detector.
    void insert(std::uint32_t id) { detector_.insert(id); }
    void remove(std::uint32_t id) { detector_.remove(id); }

    /// Like `pairs` of the detector.
    [[nodiscard]] std::span<const index_pair> pairs(std::span<const boxd> boxes) {
        const std::span<const index_pair> candidates = detector_.pairs(floats_.round(boxes));
        pairs_.assign(candidates.begin(), candidates.end());
        float_boxes::drop_disjoint(boxes, pairs_);
        return pairs_;
    }

private:
    Detector detector_;
    float_boxes floats_;
    std::vector<index_pair> pairs_;
};

}  // namespace aabb
