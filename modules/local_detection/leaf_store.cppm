module;
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

export module aabb.local_detection:leaf_store;

import aabb.base;

export namespace aabb {

inline constexpr std::size_t most_claims = 128;  ///< at once

/// Leaves that were read lately, found again by their number: each has one place, which it shares with others. First
/// all that are needed at a time are claimed, then those that are missing are read, so that none waits for another.
/// What a place holds can be read, by its own number, until another leaf is read into it.
template <class Leaf>
class leaf_store {
public:
    /// Forgets all, and takes few places where there will be few numbers.
    void begin(std::size_t numbers) {
        if (leaves_.size() < most_places && 2 * leaves_.size() <= numbers)
            leaves_.resize(std::min(most_places, std::bit_floor(numbers)));
        if (++begun_ != 0) return;
        // After all numbers of 32 bits: what was held under the first ones is not to come back.
        held_.fill(0);
        begun_ = 1;
    }

    void release_claims() noexcept { ++claim_; }

    /// @returns false where another one that is claimed has the place
    [[nodiscard]] inline bool claim(std::uint32_t number) noexcept {
        const std::size_t at = place(number);
        const std::uint64_t held = std::uint64_t{begun_} << 32U | number;
        const bool is_missing = held_[at] != held;
        // Of the two, one is mostly false and the other hard to foresee. What is told to be unforeseeable as a whole
        // stays one branch, where a compiler would make two of it.
        if (__builtin_unpredictable(static_cast<int>(is_missing) & static_cast<int>(claims_[at] == claim_)))
            return false;
        missing_[missing_count_] = number;
        missing_count_ += is_missing;
        held_[at] = held;
        claims_[at] = claim_;
        return true;
    }

    /// What was claimed and is not there, to be read before the next claim, or never before the next `begin`.
    [[nodiscard]] inline std::span<const std::uint32_t> take_missing() noexcept {
        return std::span(missing_).first(std::exchange(missing_count_, 0));
    }

    [[nodiscard]] inline Leaf& operator[](std::uint32_t number) noexcept { return leaves_[place(number)]; }

    [[nodiscard]] std::size_t places() const noexcept { return leaves_.size(); }
    [[nodiscard]] inline std::size_t place(std::uint32_t number) const noexcept {
        return number & (leaves_.size() - 1);
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(leaves_); }

private:
    static constexpr std::size_t most_places = 256;

    std::array<std::uint64_t, most_places> held_{};  // the number of the beginning, then that of the leaf
    std::uint32_t begun_ = 0;                        // how often; 0 stands for nothing held
    std::array<std::uint64_t, most_places> claims_{};
    std::uint64_t claim_ = 1;
    std::array<std::uint32_t, most_claims + 1> missing_{};
    std::size_t missing_count_ = 0;
    std::vector<Leaf> leaves_;
};

}  // namespace aabb
