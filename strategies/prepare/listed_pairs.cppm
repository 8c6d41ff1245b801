export module aabb.prepare.listed_pairs;

import aabb.geometry;
import aabb.simd;
import aabb.std;

export namespace aabb {

/// The least and the greatest numbers of a box on all three axes, each with a fourth one of no account.
using corner = float __attribute__((vector_size(16)));
[[nodiscard, gnu::always_inline]] inline corner lower_of(const box& b) noexcept {
    corner v;
    std::memcpy(&v, &b, sizeof v);
    return v;
}
[[nodiscard, gnu::always_inline]] inline corner upper_of(const box& b) noexcept {
    corner v;
    std::memcpy(&v, reinterpret_cast<const char*>(&b) + sizeof(box) - sizeof v, sizeof v);
    return __builtin_shufflevector(v, v, 1, 2, 3, 0);
}

/// As `overlaps`, on three axes at a time.
[[nodiscard, gnu::always_inline]] inline bool meet(const box& a, const box& b) noexcept {
    using bools = bool __attribute__((ext_vector_type(4)));
    const auto held = (lower_of(a) <= upper_of(b)) & (lower_of(b) <= upper_of(a));
    return (std::bit_cast<std::uint8_t>(__builtin_convertvector(held, bools)) & 7U) == 7U;
}

/// Stores those that overlap: a vector of pairs at a time and without a branch, since which they are cannot be
/// foreseen.
/// @param to may be where the list is; written are some beyond the last, at most as many as the list has and a vector
/// @return how many
inline std::size_t store_meeting(std::span<const box> boxes, std::span<const index_pair> list, index_pair* to) {
    constexpr std::size_t at_a_time = simd::width / 2;
    std::size_t end = 0;
    std::size_t i = 0;
    for (; i + at_a_time <= list.size(); i += at_a_time) {
        std::uint32_t both_words = 0;
#pragma clang loop unroll(full)
        for (std::size_t k = 0; k < at_a_time; ++k)
            both_words |= (meet(boxes[list[i + k].a], boxes[list[i + k].b]) ? 3U : 0U) << 2 * k;
        simd::words some;
        std::memcpy(&some, &list[i], sizeof some);
        end += simd::store_where(&to[end].a, some, both_words) / 2;
    }
    for (const index_pair pair : list.subspan(i)) {
        to[end] = pair;
        end += static_cast<std::size_t>(meet(boxes[pair.a], boxes[pair.b]));
    }
    return end;
}

/// Appends those that overlap. A part at a time, so that what they are stored in stays in the cache, and room that they
/// turn out not to need is not made.
inline void append_meeting(std::span<const box> boxes, std::span<const index_pair> list,
                           std::vector<index_pair>& pairs) {
    constexpr std::size_t at_a_time = 1024;
    std::array<index_pair, at_a_time + simd::width / 2> met;
    for (std::size_t i = 0; i < list.size(); i += at_a_time) {
        const std::size_t found =
            store_meeting(boxes, list.subspan(i, std::min(at_a_time, list.size() - i)), met.data());
        pairs.insert(pairs.end(), met.begin(), met.begin() + static_cast<std::ptrdiff_t>(found));
    }
}

}  // namespace aabb
