export module aabb.sort.radix;

import aabb.global_search;
import aabb.sort.inserting;
import aabb.std;

export namespace aabb {

/// LSD radix sort of the keys with digits of 11 bits. When to use: long lists that are not almost sorted; its time does
/// not depend on the order. Sorted lists and digits that all keys share are skipped; short lists use insertion sort.
class radix_sort {
public:
    static constexpr std::string_view name = "radix";
    static constexpr std::string_view summary = "radix sort of the keys' bits: linear for any order";

    /// Moves the entries between two arrays by each of the three 11-bit digits of their keys, lowest first; one pass
    /// before counts all digits. Ordered lists are left as they are, and short ones are sorted by insertion.
    template <CounterPolicy Counters>
    void sort(std::span<projection> list, Counters& counters) {
        if (list.size() < 2) return;
        // Compares each entry up to the first that is out of order with the one before it.
        const auto ordered = std::ranges::is_sorted_until(list, {}, &projection::key);
        const bool is_ordered = ordered == list.end();
        counters.add(work::comparisons, static_cast<std::size_t>(ordered - list.begin()) - is_ordered);
        if (is_ordered) return;
        if (list.size() <= longest_to_insert) return insert_each(list, counters);
        other_.resize(list.size());
        std::array<std::array<std::uint32_t, digits>, passes> counts{};
        for (const projection& p : list)
            for (std::size_t pass = 0; pass < passes; ++pass) ++counts[pass][digit(p, pass)];
        std::span<projection> from = list;
        std::span<projection> to = other_;
        for (std::size_t pass = 0; pass < passes; ++pass) {
            std::array<std::uint32_t, digits>& next = counts[pass];
            if (next[digit(from[0], pass)] == list.size()) continue;  // all keys share this digit
            // Replaces the number of entries with each digit by the place where the next one goes.
            std::uint32_t before = 0;
            for (std::uint32_t& count : next) before += std::exchange(count, before);
            for (const projection& p : from) to[next[digit(p, pass)]++] = p;
            counters.add(work::moves, list.size());
            std::swap(from, to);
        }
        if (from.data() == list.data()) return;
        std::ranges::copy(from, list.begin());
        counters.add(work::moves, list.size());
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(other_); }

private:
    static constexpr std::size_t longest_to_insert = 64;
    static constexpr std::size_t bits = 11;
    static constexpr std::size_t passes = 3;
    static constexpr std::size_t digits = std::size_t{1} << bits;

    /// A digit of the key, mapped to an integer of the same order; the equal keys -0 and 0 map to adjacent integers.
    [[nodiscard]] static constexpr std::size_t digit(const projection& p, std::size_t pass) noexcept {
        const auto pattern = std::bit_cast<std::uint32_t>(p.key);
        const std::uint32_t ordered = pattern ^ (pattern >> 31 ? ~std::uint32_t{0} : std::uint32_t{1} << 31);
        return ordered >> (bits * pass) & (digits - 1);
    }

    std::vector<projection> other_;
};

static_assert(SortPolicy<radix_sort>);

}  // namespace aabb
