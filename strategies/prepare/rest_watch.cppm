module;
#include <array>
#include <cstddef>
#include <span>
#include <utility>

export module aabb.prepare.rest_watch;

import aabb.geometry;

export namespace aabb {

/// Notices when boxes that had moved stand still: some of them do, and all are as far from where they were as in the
/// frame before. It may be mistaken.
class rest_watch {
public:
    /// @param moved since a frame that stays the same from call to call
    [[nodiscard]] bool came_to_rest(std::span<const box> boxes, double moved) {
        std::array<box, looked_at> some{};
        if (!boxes.empty())
            for (std::size_t i = 0; i < looked_at; ++i) some[i] = boxes[i * boxes.size() / looked_at];
        const bool stands = some == some_;
        some_ = some;
        return std::exchange(moved_, moved) == moved && stands;
    }

private:
    static constexpr std::size_t looked_at = 8;

    std::array<box, looked_at> some_{};
    double moved_ = -1;
};

}  // namespace aabb
