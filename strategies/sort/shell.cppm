export module aabb.sort.shell;

import aabb.global_search;
import aabb.sort.inserting;
import aabb.std;

export namespace aabb {

/// Shell sort, the paper's improved method (section 2): insertion sort over entries at a distance of a gap, for
/// decreasing gaps. When to use: lists with entries far from their place, which large gaps move in few steps; on almost
/// sorted lists the passes over large gaps are wasted comparisons.
class shell_sort {
public:
    static constexpr std::string_view name = "shell";
    static constexpr std::string_view summary =
        "Shell sort, the improved method: insertion sort over gaps that shrink to 1";

    enum class gap_sequence : std::uint8_t { shell, ciura, tokuda, ciura_eight, four_one };
    struct config {
        /// shell: n/2, n/4, … 1 (Shell 1959). ciura: the empirically best gaps up to 701 (Ciura 2001), continued by a
        /// factor of 2.25. tokuda: (9 (9/4)^k - 4) / 5, rounded up (Tokuda 1992). The number of these gaps grows with
        /// the list, so that even a sorted one takes O(n log n) comparisons. The other two are fixed: ciura_eight, only
        /// the published gaps of Ciura; four_one, 4 and 1.
        gap_sequence gaps = gap_sequence::ciura;
    };
    static constexpr std::tuple parameters{choice_parameter{
        "gaps", &config::gaps, std::array<std::string_view, 5>{"shell", "ciura", "tokuda", "ciura_eight", "four_one"},
        "the gap sequence; ciura_eight and four_one have eight and two gaps for lists of any length"}};

    shell_sort() = default;
    explicit shell_sort(const config& c) : config_(c) {}

    /// Sorts the entries at a distance of each gap of the sequence, in descending order to 1, by insertion.
    template <CounterPolicy Counters>
    constexpr void sort(std::span<projection> list, Counters& counters) const {
        if (config_.gaps == gap_sequence::shell) {
            for (std::size_t gap = list.size() / 2; gap > 0; gap /= 2) insert_each(list, counters, ignore_swaps{}, gap);
            return;
        }
        const std::span<const std::uint32_t> gaps = ascending(config_.gaps);
        for (std::size_t i = gaps.size(); i-- > 0;)
            if (gaps[i] < list.size()) insert_each(list, counters, ignore_swaps{}, std::size_t{gaps[i]});
    }

private:
    /// Ascending; the last gap exceeds half of any list of 2^32 entries, and the next one would overflow.
    using table = std::array<std::uint32_t, 27>;

    static constexpr std::size_t ciura_published = 8;
    static constexpr table ciura = [] {
        table gaps{1, 4, 10, 23, 57, 132, 301, 701};
        for (std::size_t i = ciura_published; i < gaps.size(); ++i)
            gaps[i] = static_cast<std::uint32_t>(gaps[i - 1] * std::uint64_t{9} / 4);
        return gaps;
    }();
    static constexpr table tokuda = [] {
        table gaps{};
        double exact = 1;
        for (std::uint32_t& gap : gaps) {
            gap = static_cast<std::uint32_t>(exact);
            if (static_cast<double>(gap) < exact) ++gap;
            exact = 2.25 * exact + 1;
        }
        return gaps;
    }();
    static_assert(tokuda[1] == 4 && tokuda[2] == 9 && tokuda[3] == 20 && tokuda[4] == 46 && tokuda[8] == 1182);
    static_assert(ciura.back() >= std::uint32_t{1} << 31 && tokuda.back() >= std::uint32_t{1} << 31);

    /// Detects overflow: each gap is about 9/4 of the previous one; reduced by 2^32, it would be less than twice it.
    static constexpr auto more_than_double = [](const table& gaps) {
        for (std::size_t i = 1; i < gaps.size(); ++i)
            if (gaps[i] / 2 < gaps[i - 1]) return false;
        return true;
    };
    static_assert(more_than_double(ciura) && more_than_double(tokuda));

    /// The ascending gaps of a sequence that does not depend on the length of the list; not for `shell`, whose does.
    [[nodiscard]] static constexpr std::span<const std::uint32_t> ascending(gap_sequence gaps) noexcept {
        switch (gaps) {
            case gap_sequence::tokuda: return tokuda;
            case gap_sequence::ciura_eight: return std::span(ciura).first(ciura_published);
            case gap_sequence::four_one: return std::span(ciura).first(2);
            default: return ciura;
        }
    }

    config config_;
};

static_assert(SortPolicy<shell_sort> && !SwapReportingSort<shell_sort>);

}  // namespace aabb
