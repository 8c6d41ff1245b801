module;
#include <array>
#include <cstddef>
#include <span>
#include <utility>

export module aabb.prepare.rest_watch;

import aabb.geometry;

export namespace aabb {

/// Notices when boxes that had moved stand still: for two frames all are as far from where they were as in the frame
/// before, and some of them are where they were in the first of these. It may be mistaken.
class rest_watch {
public:
    /// @param moved since a frame that stays the same from call to call
    [[nodiscard]] bool came_to_rest(std::span<const box> boxes, double moved) {
        // Most frames end here: the boxes are looked at only where they may stand.
        if (std::exchange(moved_, moved) != moved) {
            looked_ = false;
            return false;
        }
        std::array<box, looked_at> some{};
        if (!boxes.empty())
            for (std::size_t i = 0; i < looked_at; ++i) some[i] = boxes[i * boxes.size() / looked_at];
        const bool stands = looked_ && some == some_;
        some_ = some;
        looked_ = true;
        return stands;
    }

private:
    static constexpr std::size_t looked_at = 8;

    std::array<box, looked_at> some_{};
    bool looked_ = false;
    double moved_ = -1;
};

}  // namespace aabb
