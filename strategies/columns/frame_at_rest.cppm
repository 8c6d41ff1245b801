export module aabb.columns.frame_at_rest;

import aabb.base;
import aabb.geometry;
import aabb.global_search;
import aabb.std;

export namespace aabb {

/// A frame whose pairs are kept for as long as nothing moves. Boxes are kept only when some of them stood still since
/// the frame before: a scene in motion pays for a look at those. Where those stand still and others do not, frames are
/// kept ever more rarely, down to one of 64.
class frame_at_rest {
public:
    /// @returns whether all boxes are where they were in the frame that is kept, so that `pairs` has theirs
    [[nodiscard]] bool lasts(std::span<const box> boxes, const membership& objects) {
        const bool same_objects = objects.arrivals() == 0 && !objects.any_departures() && boxes.size() == size_;
        if (!boxes_.empty()) {
            if (same_objects && are_same(boxes, boxes_)) {
                pause_ = 0;
                return true;
            }
            boxes_.clear();
            pairs_.clear();
            pause_ = std::min(2 * pause_ + 1, 63U);
            waited_ = 0;
        }
        size_ = boxes.size();
        const auto some = some_of(boxes);
        is_to_be_kept_ = same_objects && are_same(some, some_) && ++waited_ > pause_;
        some_ = some;
        return false;
    }

    void keep(std::span<const box> boxes, std::span<const index_pair> pairs) {
        if (!is_to_be_kept_) return;
        pairs_.assign(pairs.begin(), pairs.end());
        boxes_.assign(boxes.begin(), boxes.end());
    }

    [[nodiscard]] std::span<const index_pair> pairs() const noexcept { return pairs_; }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(boxes_) + bytes_of(pairs_); }

private:
    static constexpr std::size_t looked_at = 64;

    [[nodiscard]] static bool are_same(std::span<const box> a, std::span<const box> b) noexcept {
        return std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
    }
    [[nodiscard]] static std::array<box, looked_at> some_of(std::span<const box> boxes) noexcept {
        std::array<box, looked_at> some{};
        if (!boxes.empty())
            for (std::size_t i = 0; i < looked_at; ++i) some[i] = boxes[i * boxes.size() / looked_at];
        return some;
    }

    std::size_t size_ = 0;
    std::array<box, looked_at> some_{};
    bool is_to_be_kept_ = false;
    unsigned pause_ = 0;  // frames that are not kept, though some boxes stand still
    unsigned waited_ = 0;
    std::vector<box> boxes_;  // of all objects, absent ones too; empty where no frame is kept
    std::vector<index_pair> pairs_;
};

}  // namespace aabb
