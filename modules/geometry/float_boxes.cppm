export module aabb.geometry:float_boxes;

import aabb.std;
import :box;
import :boxd;
import :index_pair;
import :vertex_frame;

export namespace aabb {

/// Lets a search of boxes of floats find the pairs of boxes in double. Bounds are rounded to floats in a coordinate
/// frame that all boxes share. This is monotone, so boxes that overlap still overlap as floats; pairs that overlap only
/// as floats are dropped.
class float_boxes {
public:
    float_boxes() = default;
    /// @param range of the boxes of all frames, which then have one frame of floats
    explicit float_boxes(const boxd& range) : frame_(vertex_frame::around(range.min, range.max)), range_(range) {
        has_frame_ = keeps_frame_ = true;
    }

    /// Rounds the boxes of the next frame. Their coordinate frame stays the same until boxes leave its range, so that
    /// what a search keeps between frames stays valid.
    /// @throws input_error as `require_valid`
    [[nodiscard]] std::span<const box> round(std::span<const boxd> boxes) {
        require_valid(boxes);
        fit_frame(boxes);
        rounded_.clear();
        for (const boxd& b : boxes) rounded_.push_back({frame_(b.min), frame_(b.max)});
        return rounded_;
    }

    /// @param boxes those of the last `round`
    static void drop_disjoint(std::span<const boxd> boxes, std::vector<index_pair>& pairs) {
        std::erase_if(pairs, [&](index_pair p) { return !boxes[p.a].overlaps(boxes[p.b]); });
    }

private:
    /// Makes a new coordinate frame, for a range twice as large as the boxes, if these leave the range of the last.
    void fit_frame(std::span<const boxd> boxes) {
        if (boxes.empty()) return;
        boxd all = boxes.front();
        for (const boxd& b : boxes)
            for (int k = 0; k < 3; ++k) {
                all.min[k] = std::min(all.min[k], b.min[k]);
                all.max[k] = std::max(all.max[k], b.max[k]);
            }
        bool fits = has_frame_;
        for (int k = 0; k < 3; ++k) fits &= all.min[k] >= range_.min[k] && all.max[k] <= range_.max[k];
        // What has shrunk to a small part of the range would be coarse in its floats.
        double extent = 0, extent_of_range = 0;
        for (int k = 0; k < 3; ++k) {
            extent = std::max(extent, all.max[k] / 2 - all.min[k] / 2);
            extent_of_range = std::max(extent_of_range, range_.max[k] / 2 - range_.min[k] / 2);
        }
        if (fits && (keeps_frame_ || 16 * extent >= extent_of_range)) return;
        for (int k = 0; k < 3; ++k) {
            const double margin = all.max[k] / 2 - all.min[k] / 2;
            range_.min[k] = std::max(all.min[k] - margin, std::numeric_limits<double>::lowest());
            range_.max[k] = std::min(all.max[k] + margin, std::numeric_limits<double>::max());
        }
        frame_ = vertex_frame::around(range_.min, range_.max);
        has_frame_ = true;
    }

    vertex_frame frame_;
    boxd range_{};
    bool has_frame_ = false;
    bool keeps_frame_ = false;  // as long as the boxes fit
    std::vector<box> rounded_;
};

}  // namespace aabb
