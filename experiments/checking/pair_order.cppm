/// The order of pairs in a list.
module aabblab.checking:pair_order;

import aabb.std;
import aabblab.checking;

namespace aabblab {

/// A number by which pairs compare as by a, then b, in a single comparison.
struct pair_key {
    constexpr std::uint64_t operator()(aabb::index_pair pair) const noexcept {
        return std::uint64_t{pair.a} << 32U | pair.b;
    }
};
inline constexpr pair_key key_of;

/// Whether the pairs are the same, in the same order.
[[nodiscard]] inline bool are_equal(std::span<const aabb::index_pair> p, std::span<const aabb::index_pair> q) {
    return p.size() == q.size() && (p.empty() || std::memcmp(p.data(), q.data(), p.size_bytes()) == 0);
}

/// Sorts pairs by a radix sort (Knuth, The Art of Computer Programming, 5.2.5): by the digits of b, then by those of a,
/// each from the lowest up. Ids may be any, also such as no scene has. Keeps its memory.
class pair_sorter {
public:
    void sort(std::span<aabb::index_pair> pairs) {
        std::uint32_t bits_of_ids = 1;
        for (const auto [a, b] : pairs) bits_of_ids |= a | b;
        const std::size_t id_bits = std::bit_width(bits_of_ids);
        const std::size_t count_bits = std::bit_width(pairs.size());
        // No more counters than twice the pairs, unless they fit in the first level of the cache.
        const std::size_t most_bits = std::max<std::size_t>(count_bits, 11);
        const std::size_t digits = (id_bits + most_bits - 1) / most_bits;
        const std::size_t digit_bits = (id_bits + digits - 1) / digits;
        const std::size_t values = std::size_t{1} << digit_bits;
        // Of few pairs, comparisons are fewer than counters.
        if (pairs.size() * count_bits < 2 * digits * values) {
            std::ranges::sort(pairs, {}, key_of);
            return;
        }
        other_.resize(pairs.size());
        std::span<aabb::index_pair> from = pairs, to = other_;
        for (const auto id : {&aabb::index_pair::b, &aabb::index_pair::a})
            for (std::size_t digit = 0; digit < digits; ++digit) {
                const std::size_t shift = digit * digit_bits;
                move_by(from, to, values,
                        [=](const aabb::index_pair& pair) { return pair.*id >> shift & (values - 1); });
                std::swap(from, to);
            }
    }

private:
    /// Moves pairs in the order of a digit, and within equal ones in their order.
    template <class DigitOf>
    void move_by(std::span<const aabb::index_pair> from, std::span<aabb::index_pair> to, std::size_t values,
                 DigitOf digit_of) {
        places_.assign(values, 0);
        for (const aabb::index_pair& pair : from) ++places_[digit_of(pair)];
        std::exclusive_scan(places_.begin(), places_.end(), places_.begin(), std::size_t{0});
        for (const aabb::index_pair& pair : from) to[places_[digit_of(pair)]++] = pair;
    }

    std::vector<aabb::index_pair> other_;
    std::vector<std::size_t> places_;  // by value of a digit: where the next pair with it goes
};

}  // namespace aabblab
