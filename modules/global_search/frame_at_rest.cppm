module;
#include <array>
#include <cstddef>
#include <cstring>
#include <span>
#include <vector>

export module aabb.global_search:frame_at_rest;

import aabb.base;
import aabb.geometry;
import :membership;

export namespace aabb {

/// A frame whose pairs are kept for as long as nothing moves. Boxes are kept only when some of them stood still since
/// the frame before: a scene in motion pays for a look at those.
class frame_at_rest {
public:
    /// @returns whether all boxes are where they were in the frame that is kept, so that `pairs` has theirs
    [[nodiscard]] bool lasts(std::span<const box> boxes, const membership& objects) {
        const bool same_objects = objects.arrivals().empty() && !objects.any_departures() && boxes.size() == size_;
        if (same_objects && !boxes_.empty() && are_same(boxes, boxes_)) return true;
        release(boxes_);
        release(pairs_);
        size_ = boxes.size();
        const auto some = some_of(boxes);
        is_likely_ = same_objects && are_same(some, some_);
        some_ = some;
        return false;
    }

    void keep(std::span<const box> boxes, std::span<const index_pair> pairs) {
        if (!is_likely_) return;
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
    bool is_likely_ = false;
    std::vector<box> boxes_;  // of all objects, absent ones too; empty where no frame is kept
    std::vector<index_pair> pairs_;
};

}  // namespace aabb
