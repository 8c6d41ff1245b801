module;
#if defined(__AVX2__)
#include <immintrin.h>
#endif

/// SIMD kernels of the column search beyond `aabb.simd`: transposes, and arithmetic on two u16 packed in a u32.
export module aabb.columns.kernels;

export import aabb.simd;
import aabb.std;

namespace aabb::simd::detail {

/// Each lane holds two floats.
using pairs = double __attribute__((vector_size(4 * width)));

/// Collects pair `K` of each row: `a`, `b` and `c` hold `width / 2` rows of three pairs, one after another.
template <std::size_t K>
[[nodiscard, gnu::always_inline]] inline pairs every_third(pairs a, pairs b, pairs c) noexcept {
    constexpr std::size_t half = width / 2;
    // A shuffle has two operands: the first takes what is in `a` and `b`, the second adds what is in `c`.
    constexpr auto of_first_two = [](std::size_t i) { return 3 * i + K < width ? 3 * i + K : 0; };
    constexpr auto of_all = [](std::size_t i) { return 3 * i + K < width ? i : half + (3 * i + K - width); };
    const pairs from_first_two = shuffled<pairs, of_first_two>(a, b, std::make_index_sequence<half>{});
    return shuffled<pairs, of_all>(from_first_two, c, std::make_index_sequence<half>{});
}

/// Transposes columns 2 `K` and 2 `K` + 1 of `width` rows of six floats.
/// @param columns output: columns[j] has float j of each row
template <std::size_t K>
[[gnu::always_inline]] inline void transpose_pair(const pairs (&rows)[6], floats* columns) noexcept {
    const auto low = __builtin_bit_cast(floats, every_third<K>(rows[0], rows[1], rows[2]));
    const auto high = __builtin_bit_cast(floats, every_third<K>(rows[3], rows[4], rows[5]));
    constexpr auto even = [](std::size_t i) { return 2 * i; };
    constexpr auto odd = [](std::size_t i) { return 2 * i + 1; };
    columns[2 * K] = shuffled<floats, even>(low, high, std::make_index_sequence<width>{});
    columns[2 * K + 1] = shuffled<floats, odd>(low, high, std::make_index_sequence<width>{});
}

// Vectors are passed through memory, which the optimizer removes.
#if defined(__AVX512F__)
[[gnu::always_inline]] inline void gather_sixteen(const std::uint32_t* from, const void* places, void* to) noexcept {
    _mm512_storeu_si512(to, _mm512_i32gather_epi32(_mm512_loadu_si512(places), from, 4));
}
#endif
#if defined(__AVX2__)
[[gnu::always_inline]] inline void gather_eight(const std::uint32_t* from, const void* places, void* to) noexcept {
    const __m256i at = _mm256_loadu_si256(static_cast<const __m256i*>(places));
    _mm256_storeu_si256(static_cast<__m256i*>(to), _mm256_i32gather_epi32(reinterpret_cast<const int*>(from), at, 4));
}
#endif

}  // namespace aabb::simd::detail

export namespace aabb::simd {

/// Transposes `width` rows of six floats into columns.
[[gnu::always_inline]] inline void load_rows_of_six(const float* from, floats (&columns)[6]) noexcept {
    detail::pairs rows[6];
    std::memcpy(rows, from, sizeof rows);
    detail::transpose_pair<0>(rows, columns);
    detail::transpose_pair<1>(rows, columns);
    detail::transpose_pair<2>(rows, columns);
}

/// Loads `width` rows of four u32, one after another, as columns: columns[K] has element K of each row. A shuffle takes
/// two vectors, so that `low` has the elements of the first half of the rows, and `high` those of the second.
[[gnu::always_inline]] inline void load_rows_of_four(const std::uint32_t* from, words (&columns)[4]) noexcept {
    words vectors[4];
    std::memcpy(vectors, from, sizeof vectors);
    const auto collect_column = [&]<std::size_t K>(std::integral_constant<std::size_t, K>) {
        constexpr auto of_two = [](std::size_t i) { return 4 * (i % (width / 2)) + K; };
        constexpr auto joined = [](std::size_t i) { return i < width / 2 ? i : width + i - width / 2; };
        const auto lanes = std::make_index_sequence<width>{};
        const words low = shuffled<words, of_two>(vectors[0], vectors[1], lanes);
        const words high = shuffled<words, of_two>(vectors[2], vectors[3], lanes);
        columns[K] = shuffled<words, joined>(low, high, lanes);
    };
    collect_column(std::integral_constant<std::size_t, 0>{});
    collect_column(std::integral_constant<std::size_t, 1>{});
    collect_column(std::integral_constant<std::size_t, 2>{});
    collect_column(std::integral_constant<std::size_t, 3>{});
}

/// Transposes four columns of u32 and stores them as `width` rows, the inverse of `load_rows_of_four`.
[[gnu::always_inline]] inline void store_rows_of_four(std::uint32_t* to, const words (&&columns)[4]) noexcept {
    const auto store_vector = [&]<std::size_t R>(std::integral_constant<std::size_t, R>) {
        // Element j of these rows comes from row j / 4 and column j % 4; two columns are interleaved at a time.
        constexpr auto of_two = [](std::size_t i) { return R * width / 4 + i / 4 + (i % 2) * width; };
        constexpr auto joined = [](std::size_t i) { return i % 4 < 2 ? i : width + i; };
        const auto lanes = std::make_index_sequence<width>{};
        const words low = shuffled<words, of_two>(columns[0], columns[1], lanes);
        const words high = shuffled<words, of_two>(columns[2], columns[3], lanes);
        store(to + R * width, shuffled<words, joined>(low, high, lanes));
    };
    store_vector(std::integral_constant<std::size_t, 0>{});
    store_vector(std::integral_constant<std::size_t, 1>{});
    store_vector(std::integral_constant<std::size_t, 2>{});
    store_vector(std::integral_constant<std::size_t, 3>{});
}

/// Stores the pair of `id` and lane l, the lesser first, for each lane l in the set, one after the other. `to` must
/// have room for `width` pairs, since those behind the stored ones may be overwritten.
/// @returns the number of stored pairs
[[gnu::always_inline]] inline std::size_t store_ordered_pairs(std::uint32_t* to, std::uint32_t id, words ids,
                                                              std::uint32_t set) noexcept {
    const words first = broadcast(id);
    const words second = has_compress ? compress(ids, set) : ids;
    const words lesser = first < second ? first : second;
    const words greater = first < second ? second : first;
    if constexpr (!has_compress) {
        for (std::size_t i = 0, n = 0; i < width; n += 2 * (set >> i & 1U), ++i) {
            to[n] = lesser[i];
            to[n + 1] = greater[i];
        }
        return static_cast<std::size_t>(std::popcount(set));
    }
    constexpr auto lower_half = [](std::size_t i) { return i / 2 + i % 2 * width; };
    constexpr auto upper_half = [](std::size_t i) { return width / 2 + i / 2 + i % 2 * width; };
    const auto lanes = std::make_index_sequence<width>{};
    store(to, shuffled<words, lower_half>(lesser, greater, lanes));
    store(to + width, shuffled<words, upper_half>(lesser, greater, lanes));
    return static_cast<std::size_t>(std::popcount(set));
}

using halves = std::uint16_t __attribute__((vector_size(4 * width)));  ///< two u16 per u32 lane

using narrow_halves = std::uint16_t __attribute__((vector_size(2 * width)));

/// Loads u16 and zero-extends them to u32.
[[nodiscard, gnu::always_inline]] inline words load_halves(const std::uint16_t* from) noexcept {
    narrow_halves v;
    std::memcpy(&v, from, sizeof v);
    return __builtin_convertvector(v, words);
}

[[gnu::always_inline]] inline void store_low_halves(std::uint16_t* to, words v) noexcept {
    const auto lower = __builtin_convertvector(v, narrow_halves);
    std::memcpy(to, &lower, sizeof lower);
}

/// The high u16 of the product of each pair of u16: maps a, as a coordinate below 2^16, to one of b equal cells.
[[nodiscard, gnu::always_inline]] inline words high_products(words a, words b) noexcept {
    using wide = std::uint32_t __attribute__((vector_size(8 * width)));
    const auto x = __builtin_convertvector(reinterpret_cast<halves>(a), wide);
    const auto y = __builtin_convertvector(reinterpret_cast<halves>(b), wide);
    return reinterpret_cast<words>(__builtin_convertvector(x * y >> 16, halves));
}

/// The saturating difference of each pair of u16: 0 if it would be negative.
[[nodiscard, gnu::always_inline]] inline words saturated_difference(words a, words b) noexcept {
    return reinterpret_cast<words>(
        __builtin_elementwise_sub_sat(reinterpret_cast<halves>(a), reinterpret_cast<halves>(b)));
}

/// Loads the elements at these indices: lane i is from[places[i]].
[[nodiscard, gnu::always_inline]] inline words gather(const std::uint32_t* from, words places) noexcept {
    words v;
#if defined(__AVX512F__)
    if constexpr (width == 16) return detail::gather_sixteen(from, &places, &v), v;
#endif
#if defined(__AVX2__)
    if constexpr (width == 8) return detail::gather_eight(from, &places, &v), v;
#endif
    for (std::size_t i = 0; i < width; ++i) v[i] = from[places[i]];
    return v;
}

/// The inclusive prefix sum over the lanes, in a logarithmic number of steps: each adds the vector shifted by 1, 2, 4…
[[nodiscard, gnu::always_inline]] inline words prefix_sum(words v) noexcept {
    const words zero{};
    const auto shifted = [&]<std::size_t By, std::size_t... I>(std::integral_constant<std::size_t, By>,
                                                               std::index_sequence<I...>) {
        return __builtin_shufflevector(v, zero, (I < By ? static_cast<int>(width + I) : static_cast<int>(I - By))...);
    };
    const auto add = [&]<std::size_t By>(std::integral_constant<std::size_t, By> distance) {
        if constexpr (By < width) v += shifted(distance, std::make_index_sequence<width>{});
    };
    add(std::integral_constant<std::size_t, 1>{});
    add(std::integral_constant<std::size_t, 2>{});
    add(std::integral_constant<std::size_t, 4>{});
    add(std::integral_constant<std::size_t, 8>{});
    return v;
}

}  // namespace aabb::simd
