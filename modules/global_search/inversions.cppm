module;
#include <cassert>

export module aabb.global_search:inversions;

import aabb.base;
import aabb.std;
import :projection;

export namespace aabb {

/// Counts the pairs of a list that stand in the wrong order, the measure of "almost sorted", by merging: n log n steps.
class inversion_counter {
public:
    [[nodiscard]] std::uint64_t count(std::span<const projection> list) {
        keys_.clear();
        for (const projection& p : list) keys_.push_back(p.key);
        merged_.resize(keys_.size());
        std::uint64_t inversions = 0;
        for (std::size_t width = 1; width < keys_.size(); width *= 2) {
            for (std::size_t begin = 0; begin < keys_.size(); begin += 2 * width)
                inversions +=
                    merge(begin, std::min(begin + width, keys_.size()), std::min(begin + 2 * width, keys_.size()));
            keys_.swap(merged_);
        }
        assert(std::ranges::is_sorted(keys_));
        return inversions;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(keys_) + bytes_of(merged_); }

private:
    /// Each key of the second run passes what is left of the first.
    [[nodiscard]] std::uint64_t merge(std::size_t begin, std::size_t middle, std::size_t end) {
        std::uint64_t inversions = 0;
        std::size_t left = begin;
        std::size_t right = middle;
        for (std::size_t out = begin; out < end; ++out) {
            const bool passes = left == middle || (right < end && keys_[right] < keys_[left]);
            if (passes) inversions += middle - left;
            merged_[out] = keys_[passes ? right++ : left++];
        }
        return inversions;
    }

    std::vector<float> keys_;
    std::vector<float> merged_;
};

/// Stands where nothing is counted.
struct no_inversion_counter {
    [[nodiscard]] static constexpr std::uint64_t count(std::span<const projection>) noexcept { return 0; }
};

}  // namespace aabb
