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
/// each from the lowest up, all counted in one pass. Ids may be any, also such as no scene has. Keeps its memory.
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
        const auto digit_of = [=](std::uint32_t id, std::size_t digit) {
            return id >> digit * digit_bits & (values - 1);
        };
        places_.assign(2 * digits * values, 0);
        const std::span places_of_b = std::span(places_).first(digits * values);
        const std::span places_of_a = std::span(places_).last(digits * values);
        for (const auto [a, b] : pairs)
            for (std::size_t digit = 0; digit < digits; ++digit) {
                ++places_of_b[digit * values + digit_of(b, digit)];
                ++places_of_a[digit * values + digit_of(a, digit)];
            }
        other_.resize(pairs.size());
        std::span<aabb::index_pair> from = pairs, to = other_;
        for (std::size_t digit = 0; digit < 2 * digits; ++digit) {
            const std::span places = std::span(places_).subspan(digit * values, values);
            std::exclusive_scan(places.begin(), places.end(), places.begin(), std::size_t{0});
            const auto id = digit < digits ? &aabb::index_pair::b : &aabb::index_pair::a;
            for (const aabb::index_pair& pair : from) to[places[digit_of(pair.*id, digit % digits)]++] = pair;
            std::swap(from, to);
        }
    }

private:
    std::vector<aabb::index_pair> other_;
    std::vector<std::size_t> places_;  // by digit and its value: where the next pair with it goes
};

}  // namespace aabblab
