module;
#include <cassert>

export module aabb.global_search:pair_set;

import aabb.geometry;
import aabb.std;

export namespace aabb {

/// A set of pairs that is iterated as an array: the pairs are stored in a vector, and a hash table with linear probing
/// and a load factor of at most 1/2 finds their indices.
class pair_set {
public:
    [[nodiscard]] inline std::span<const index_pair> pairs() const noexcept { return pairs_; }

    /// Appends a pair unless it is present, and stores its index in the hash table, which is at most half full.
    /// @throws input_error beyond 2^32 - 1 pairs
    inline void insert(index_pair pair) {
        if (2 * (pairs_.size() + 1) > table_.size()) grow();
        const std::size_t slot = slot_of(pair);
        if (table_[slot] != none) return;
        if (pairs_.size() == none) throw input_error("more than 2^32 - 1 pairs overlap");
        pairs_.push_back(pair);
        table_[slot] = static_cast<std::uint32_t>(pairs_.size() - 1);
    }

    /// Erases a pair if it is present. The last pair takes its place, so that the array has no gaps.
    inline void erase(index_pair pair) {
        if (pairs_.empty()) return;
        const std::size_t slot = slot_of(pair);
        const std::uint32_t index = table_[slot];
        if (index == none) return;
        table_[slot_of(pairs_.back())] = index;
        pairs_[index] = pairs_.back();
        pairs_.pop_back();
        close_gap(slot);
    }

    /// Keeps the memory.
    void clear() noexcept {
        pairs_.clear();
        std::ranges::fill(table_, none);
    }

    template <class Predicate>
    void erase_if(Predicate goes) {
        for (std::size_t i = pairs_.size(); i-- > 0;)
            if (goes(pairs_[i])) erase(pairs_[i]);
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(pairs_, table_); }

private:
    static constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

    /// The slot where probing begins: Fibonacci hashing, the high bits of a product with 2^64 over the golden ratio.
    [[nodiscard]] inline std::size_t home_of(index_pair pair) const noexcept {
        const std::uint64_t both = std::uint64_t{pair.a} << 32 | pair.b;
        const std::uint64_t mixed = (both ^ both >> 29) * 0x9e3779b97f4a7c15U;
        return mixed >> (64 - std::countr_zero(table_.size()));
    }

    /// The slot of a pair, or the free slot into which it would be inserted.
    [[nodiscard]] inline std::size_t slot_of(index_pair pair) const noexcept {
        std::size_t slot = home_of(pair);
        while (table_[slot] != none && pairs_[table_[slot]] != pair) slot = next(slot);
        return slot;
    }

    [[nodiscard]] inline std::size_t next(std::size_t slot) const noexcept { return (slot + 1) & (table_.size() - 1); }

    /// Empties a slot of `table_`. A search ends at the first empty slot, so a later entry moves into this gap if its
    /// search, from its home slot, would cross it, and leaves the next gap. Deleted slots need no marks.
    inline void close_gap(std::size_t gap) {
        for (std::size_t at = next(gap); table_[at] != none; at = next(at)) {
            const std::size_t home = home_of(pairs_[table_[at]]);
            const std::size_t mask = table_.size() - 1;  // distances are modulo the size, a power of two
            // An entry whose home lies behind the gap stays: probing for it does not cross the gap.
            if (((at - home) & mask) < ((at - gap) & mask)) continue;
            table_[gap] = table_[at];
            gap = at;
        }
        table_[gap] = none;
    }

    void grow() {
        table_.assign(table_.empty() ? 64 : 2 * table_.size(), none);
        assert(std::has_single_bit(table_.size()) && 2 * pairs_.size() <= table_.size());
        for (std::size_t i = 0; i < pairs_.size(); ++i) table_[slot_of(pairs_[i])] = static_cast<std::uint32_t>(i);
    }

    std::vector<index_pair> pairs_;
    std::vector<std::uint32_t> table_;  // indices into pairs_; the size is a power of two
};

}  // namespace aabb
