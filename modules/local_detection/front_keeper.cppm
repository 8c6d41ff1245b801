module;
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

export module aabb.local_detection:front_keeper;

import aabb.base;
import aabb.geometry;
import aabb.simd;
import :leaf_front;

export namespace aabb {

/// The fronts of many pairs of objects. Nobody says which object is which: a front is found again by its models and by
/// where they were in its last query, or because its pairs hold, the one behind the last found first, since objects
/// mostly come in the same order.
class front_keeper {
public:
    static constexpr std::size_t most = 1024;
    static constexpr std::size_t least_leaves = 64;  ///< of two meshes: fewer are walked before a front is found

    /// @param reach box of B's vertices, in its own frame
    /// @param near how far B may have moved since the front's last query
    /// @returns the front, or a new one, which has had no query
    [[nodiscard]] leaf_front& find(const model_pair& of, const box_motion& at, const box& reach, double near) {
        const std::array<float, 3> centre = centre_of(at, reach);
        const std::size_t place = place_of(of, at, reach, near, centre);
        for (std::size_t k = 0; k < 3; ++k) centres_[place / width][k][place % width] = centre[k];
        last_ = place;
        return fronts_[place];
    }

    [[nodiscard]] std::size_t bytes() const noexcept {
        std::size_t all = bytes_of(fronts_) + bytes_of(centres_);
        for (const leaf_front& f : fronts_) all += f.bytes();
        return all;
    }

private:
    static constexpr std::size_t width = 8;
    using row = std::array<float, width>;

    /// Of B, in A's frame: it moves no further than the rest.
    [[nodiscard]] static std::array<float, 3> centre_of(const box_motion& at, const box& reach) noexcept {
        vec3d centre = at.shift;
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 3; ++k)
                centre[k] +=
                    at.columns[static_cast<std::size_t>(j)][k] * ((double{reach.min[j]} + double{reach.max[j]}) / 2);
        return {static_cast<float>(centre[0]), static_cast<float>(centre[1]), static_cast<float>(centre[2])};
    }

    [[nodiscard]] std::size_t place_of(const model_pair& of, const box_motion& at, const box& reach, double near,
                                       const std::array<float, 3>& centre) {
        const auto is_it = [&](std::size_t place) {
            return fronts_[place].holds(of, at, reach) || fronts_[place].is_near(of, at, reach, near);
        };
        const std::size_t next = last_ + 1 < fronts_.size() ? last_ + 1 : 0;
        if (next < fronts_.size() && is_it(next)) return found_again(next);
        for (std::size_t group = 0; group < centres_.size(); ++group) {
            simd::eight_floats furthest{};
            for (std::size_t k = 0; k < 3; ++k) {
                const auto away = __builtin_elementwise_abs(
                    simd::load_eight<simd::eight_floats>(centres_[group][k].data()) - centre[k]);
                furthest = away > furthest ? away : furthest;
            }
            for (std::uint32_t near_ones = simd::bits_of_eight(furthest <= static_cast<float>(near)); near_ones != 0;
                 near_ones &= near_ones - 1) {
                const std::size_t place = group * width + static_cast<std::size_t>(std::countr_zero(near_ones));
                if (place < fronts_.size() && is_it(place)) return found_again(place);
            }
        }
        return new_place(of);
    }

    [[nodiscard]] std::size_t found_again(std::size_t place) noexcept {
        fronts_[place].is_used = true;
        return place;
    }

    /// Of as many as are kept, the next one that was not found again of late makes room.
    [[nodiscard]] std::size_t new_place(const model_pair& of) {
        std::size_t place = fronts_.size();
        if (place < most) {
            if (place == centres_.size() * width) centres_.emplace_back();
            fronts_.emplace_back();
        } else {
            while (std::exchange(fronts_[hand_].is_used, false)) hand_ = (hand_ + 1) % most;
            place = hand_;
            hand_ = (hand_ + 1) % most;
        }
        fronts_[place].begin(of);
        return place;
    }

    std::vector<leaf_front> fronts_;
    std::vector<std::array<row, 3>> centres_;  // of B in the fronts' last queries, by eights
    std::size_t last_ = 0;                     // found
    std::size_t hand_ = 0;                     // where room is sought
};

}  // namespace aabb
