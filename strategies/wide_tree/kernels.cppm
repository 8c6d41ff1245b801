module;
#if defined(__AVX2__)
#include <immintrin.h>
#endif

/// The SIMD kernels of the walks over wide trees, on top of those of `aabb.simd`.
export module aabb.wide_tree.kernels;

export import aabb.simd;
import aabb.std;

namespace aabb::simd::detail {

#if defined(__AVX512VBMI2__)
/// Stores the positions of the set bits as bytes, in order: compresses the bytes 0 to 63 by the set.
[[gnu::always_inline]] inline void store_set_bits_of_sixty_four(std::uint64_t set, void* to) noexcept {
    static constexpr auto identity = [] {
        std::array<std::uint8_t, 64> positions{};
        for (std::uint8_t i = 0; i < 64; ++i) positions[i] = i;
        return positions;
    }();
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi8(set, _mm512_loadu_si512(&identity)));
}
#endif
#if defined(__AVX512VBMI__)
/// Unpacks `count` numbers of 1 to 4 bytes each to u32, padded to sixteen with the first, by one permutation of bytes.
[[gnu::always_inline]] inline void unpack_sixteen_numbers(void* to, const void* from, std::size_t bytes,
                                                          std::uint32_t count) noexcept {
    // Byte b of number i comes from byte n * i + b, for numbers of n bytes: at[n] has the source of each of the 64
    // bytes, present[n] those with b < n. The others are 0.
    static constexpr auto patterns = [] {
        struct {
            alignas(64) std::uint8_t at[5][64];
            std::uint64_t present[5];
        } table{};
        for (unsigned n = 1; n < 5; ++n)
            for (unsigned i = 0; i < 64; ++i) {
                table.at[n][i] = static_cast<std::uint8_t>(i / 4 * n + i % 4);
                table.present[n] |= std::uint64_t{i % 4 < n} << i;
            }
        return table;
    }();
    const __m512i numbers = _mm512_maskz_permutexvar_epi8(
        patterns.present[bytes], _mm512_load_si512(patterns.at[bytes]), _mm512_loadu_si512(from));
    const auto rest = static_cast<__mmask16>(~0U << count);
    _mm512_storeu_si512(to, _mm512_mask_broadcastd_epi32(numbers, rest, _mm512_castsi512_si128(numbers)));
}
#endif
#if defined(__AVX512F__)
using eight_selected_floats = float __attribute__((vector_size(32)));
[[nodiscard, gnu::always_inline]] inline eight_selected_floats select_of_sixteen_lanes(const void* from,
                                                                                       const void* indices) noexcept {
    const __m512i at = _mm512_castsi256_si512(_mm256_loadu_si256(static_cast<const __m256i*>(indices)));
    return _mm512_castps512_ps256(_mm512_permutexvar_ps(at, _mm512_loadu_ps(from)));
}

/// Sets bit 8 j + i where column i of `a` and column j of `b` share a number; both have three rows of eight. Each
/// comparison is of two copies of a row of `a` with two numbers of `b`, each broadcast to eight lanes.
[[nodiscard, gnu::always_inline]] inline std::uint64_t columns_with_shared_number(const void* a,
                                                                                  const void* b) noexcept {
    const __m512i first_two = _mm512_setr_epi32(0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1);
    const auto row = [](const void* of, int c) { return _mm256_loadu_si256(static_cast<const __m256i*>(of) + c); };
    std::uint64_t shared = 0;
    for (int two = 0; two < 4; ++two) {
        const __m512i which = _mm512_add_epi32(first_two, _mm512_set1_epi32(2 * two));
        __mmask16 any = 0;
        for (int d = 0; d < 3; ++d) {
            const __m512i of_b = _mm512_permutexvar_epi32(which, _mm512_castsi256_si512(row(b, d)));
            for (int c = 0; c < 3; ++c) any |= _mm512_cmpeq_epi32_mask(_mm512_broadcast_i64x4(row(a, c)), of_b);
        }
        shared |= std::uint64_t{any} << 16 * two;
    }
    return shared;
}
/// Sets bit 8 j + i where box i of `a` overlaps box j of `b` (three rows of lower bounds, then three of upper bounds).
/// Each comparison is of two copies of the boxes of `a` with two boxes of `b`, each broadcast to eight lanes.
[[nodiscard, gnu::always_inline]] inline std::uint64_t overlapping_pairs(const float* a, const float* b) noexcept {
    const __m512i first_two = _mm512_setr_epi32(0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1);
    const auto twice = [](const float* row) {
        return _mm512_castpd_ps(_mm512_broadcast_f64x4(_mm256_loadu_pd(reinterpret_cast<const double*>(row))));
    };
    // met[t] has a bit for each pair with box 2 t or 2 t + 1 of `b`, set while they overlap on all axes so far.
    __mmask16 met[4] = {0xffff, 0xffff, 0xffff, 0xffff};
    for (int k = 0; k < 3; ++k) {
        const __m512 lower = twice(a + 8 * k);
        const __m512 upper = twice(a + 24 + 8 * k);
        const __m512 lower_of_b = _mm512_castps256_ps512(_mm256_loadu_ps(b + 8 * k));
        const __m512 upper_of_b = _mm512_castps256_ps512(_mm256_loadu_ps(b + 24 + 8 * k));
        for (int two = 0; two < 4; ++two) {
            const __m512i which = _mm512_add_epi32(first_two, _mm512_set1_epi32(2 * two));
            met[two] = _mm512_mask_cmp_ps_mask(met[two], lower, _mm512_permutexvar_ps(which, upper_of_b), _CMP_LE_OQ);
            met[two] = _mm512_mask_cmp_ps_mask(met[two], upper, _mm512_permutexvar_ps(which, lower_of_b), _CMP_GE_OQ);
        }
    }
    return std::uint64_t{met[0]} | std::uint64_t{met[1]} << 16U | std::uint64_t{met[2]} << 32U |
           std::uint64_t{met[3]} << 48U;
}
#endif
#if defined(__AVX512BW__)
/// Interleaves the sign masks: bits 16 i to 16 i + 7 belong to eight numbers of `a`, the others to eight of `b`.
[[nodiscard, gnu::always_inline]] inline std::uint64_t negative_of_eights_in_turn(const void* a,
                                                                                  const void* b) noexcept {
    return _mm512_movepi8_mask(_mm512_packs_epi16(_mm512_loadu_si512(a), _mm512_loadu_si512(b)));
}
#endif
#if defined(__AVX2__)
[[gnu::always_inline]] inline void permute_eight(const float* from, const void* indices, void* to) noexcept {
    const __m256i at = _mm256_loadu_si256(static_cast<const __m256i*>(indices));
    _mm256_storeu_ps(static_cast<float*>(to), _mm256_permutevar8x32_ps(_mm256_loadu_ps(from), at));
}
#endif

using two_points_of_four = float __attribute__((vector_size(32)));
/// Loads two points; the fourth lane of each is padding.
[[nodiscard, gnu::always_inline]] inline two_points_of_four two_points(const float* p, const float* q) noexcept {
#if defined(__AVX512VL__)
    const __m256 low = _mm256_castps128_ps256(_mm_maskz_loadu_ps(0b111, p));
    return _mm256_insertf128_ps(low, _mm_maskz_loadu_ps(0b111, q), 1);
#else
    return two_points_of_four{p[0], p[1], p[2], 0, q[0], q[1], q[2], 0};
#endif
}

}  // namespace aabb::simd::detail

export namespace aabb::simd {

/// Transposes eight points to a structure of arrays: returns their x, y and z as three vectors. It joins four vectors
/// of two points each, x y z 0, in two levels of shuffles; both halves of a vector are shuffled alike.
[[nodiscard, gnu::always_inline]] inline std::array<eight_floats, 3> transpose_eight_points(
    const float* const* points) noexcept {
    const auto row = [&](int i) { return detail::two_points(points[i], points[i + 4]); };
    // In each half, `low` makes x x y y of two rows, and `high` z z 0 0.
    const auto low = [](eight_floats p, eight_floats q) {
        return __builtin_shufflevector(p, q, 0, 8, 1, 9, 4, 12, 5, 13);
    };
    const auto high = [](eight_floats p, eight_floats q) {
        return __builtin_shufflevector(p, q, 2, 10, 3, 11, 6, 14, 7, 15);
    };
    const auto first_halves = [](eight_floats p, eight_floats q) {
        return __builtin_shufflevector(p, q, 0, 1, 8, 9, 4, 5, 12, 13);
    };
    const auto last_halves = [](eight_floats p, eight_floats q) {
        return __builtin_shufflevector(p, q, 2, 3, 10, 11, 6, 7, 14, 15);
    };
    const eight_floats xy_01 = low(row(0), row(1));
    const eight_floats xy_23 = low(row(2), row(3));
    return {first_halves(xy_01, xy_23), last_halves(xy_01, xy_23),
            first_halves(high(row(0), row(1)), high(row(2), row(3)))};
}

/// Permutes eight numbers; only the lowest three bits of each index are used.
[[nodiscard, gnu::always_inline]] inline eight_floats permuted(const float* from, eight_words indices) noexcept {
    eight_floats v;
#if defined(__AVX2__)
    detail::permute_eight(from, &indices, &v);
#else
    for (int i = 0; i < 8; ++i) v[i] = from[indices[i] & 7U];
#endif
    return v;
}

[[nodiscard, gnu::always_inline]] inline sixteen_floats joined(eight_floats low, eight_floats high) noexcept {
    return __builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}

/// Selects eight of sixteen numbers, which are in registers, by a permutation: index i is in bits 4 i to 4 i + 3.
[[nodiscard, gnu::always_inline]] inline eight_floats select_eight_of_sixteen(const sixteen_floats& from,
                                                                              std::uint32_t packed_indices) noexcept {
    constexpr eight_words shift{0, 4, 8, 12, 16, 20, 24, 28};
    const eight_words at = (eight_words{} + packed_indices) >> shift;  // higher bits are ignored
#if defined(__AVX512F__)
    return detail::select_of_sixteen_lanes(&from, &at);
#else
    std::array<float, 16> numbers;
    std::memcpy(numbers.data(), &from, sizeof from);
    // Bit 3 of an index chooses the half, the lower three bits the number in it.
    const eight_floats low = permuted(numbers.data(), at);
    const eight_floats high = permuted(numbers.data() + 8, at);
    return (at & 8U) != 0 ? high : low;
#endif
}

[[nodiscard, gnu::always_inline]] inline float sum(eight_floats v) noexcept {
    v += __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3);
    v += __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5);
    return v[0] + v[1];
}

/// Compares all 64 pairs of eight numbers and eight: sets bit 8 j + i where number i of `a` is at most number j of `b`.
[[nodiscard, gnu::always_inline]] inline std::uint64_t pairs_no_greater(const std::uint8_t* a, eight_bytes b) noexcept {
    using bytes = std::uint8_t __attribute__((vector_size(64)));
    using signed_bytes = std::int8_t __attribute__((vector_size(64)));
    using bools = bool __attribute__((ext_vector_type(64)));
    using rows = std::uint64_t __attribute__((vector_size(64)));
    // The numbers of `a` are repeated in turn, and each number of `b` eight times in a row.
    std::uint64_t row = 0;
    std::memcpy(&row, a, sizeof row);
    const auto left = reinterpret_cast<bytes>(rows{} + row);
    constexpr auto eight_times = [](std::size_t i) { return i / 8; };
    const auto right = shuffled<bytes, eight_times>(b, b, std::make_index_sequence<64>{});
    const signed_bytes is_no_greater = left <= right;
    return __builtin_bit_cast(std::uint64_t, __builtin_convertvector(is_no_greater, bools));
}

/// Compares six rows of eight numbers with one number per row: sets bit i where number i of each row is at most that.
/// @param most of the rows, in their order; two more are not used
[[nodiscard, gnu::always_inline]] inline std::uint32_t columns_no_greater(const std::uint8_t* rows,
                                                                          eight_bytes most) noexcept {
    using bytes = std::uint8_t __attribute__((vector_size(64)));
    using signed_bytes = std::int8_t __attribute__((vector_size(64)));
    using bools = bool __attribute__((ext_vector_type(64)));
    bytes left{};  // zeros in two more rows, which are no greater than anything
    std::memcpy(&left, rows, 48);
    constexpr auto eight_times = [](std::size_t i) { return i / 8; };
    const auto right = shuffled<bytes, eight_times>(most, most, std::make_index_sequence<64>{});
    const signed_bytes is_no_greater = left <= right;
    auto columns = __builtin_bit_cast(std::uint64_t, __builtin_convertvector(is_no_greater, bools));
    columns &= columns >> 32U;
    columns &= columns >> 16U;
    columns &= columns >> 8U;
    return static_cast<std::uint32_t>(columns & 0xffU);
}

/// Sets bit 8 j + i where column i of `a` and column j of `b` share a number; both have three rows of eight.
[[nodiscard, gnu::always_inline]] inline std::uint64_t columns_with_shared_number(const std::uint32_t* a,
                                                                                  const std::uint32_t* b) noexcept {
#if defined(__AVX512F__)
    return detail::columns_with_shared_number(a, b);
#else
    std::uint64_t shared = 0;
    for (std::size_t j = 0; j < 8; ++j) {
        auto any = load_eight<eight_words>(a) == b[j];  // repeated below, but gives the flags their type
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t d = 0; d < 3; ++d) any |= load_eight<eight_words>(a + 8 * c) == b[8 * d + j];
        shared |= std::uint64_t{bits_of_eight(any)} << 8 * j;
    }
    return shared;
#endif
}

/// Unpacks `count` numbers (1 to 16) of 1 to 4 bytes each; the first one pads the rest. Reads 64 bytes.
[[gnu::always_inline]] inline void unpack_sixteen(std::uint32_t* to, const std::byte* from, std::size_t bytes,
                                                  std::uint32_t count) noexcept {
#if defined(__AVX512VBMI__)
    detail::unpack_sixteen_numbers(to, from, bytes, count);
#else
    const std::uint32_t mask = 0xffffffff >> (32 - 8 * bytes);
    for (std::uint32_t i = 0; i < 16; ++i) {
        std::memcpy(&to[i], from + bytes * (i < count ? i : 0), sizeof to[i]);
        to[i] &= mask;
    }
#endif
}

/// Tests all 64 pairs of eight boxes and eight: sets bit 8 j + i where box i of `a` overlaps box j of `b`. Each side
/// has six rows of eight numbers: three of lower bounds, then three of upper bounds.
[[nodiscard, gnu::always_inline]] inline std::uint64_t overlapping_pairs(const float* a, const float* b) noexcept {
#if defined(__AVX512F__)
    return detail::overlapping_pairs(a, b);
#else
    std::uint64_t met = 0;
    for (std::size_t j = 0; j < 8; ++j) {
        auto row = load_eight<eight_floats>(a) <= b[24 + j];  // repeated for k = 0, but gives the flags their type
        for (std::size_t k = 0; k < 3; ++k)
            row &= (load_eight<eight_floats>(a + 8 * k) <= b[24 + 8 * k + j]) &
                   (load_eight<eight_floats>(a + 24 + 8 * k) >= b[8 * k + j]);
        met |= std::uint64_t{bits_of_eight(row)} << 8 * j;
    }
    return met;
#endif
}

/// Tests all 64 pairs of eight boxes and eight in 16-bit integers: sets bit 8 j + i where box i of `a` overlaps box j
/// of `b`. Each side has six rows of eight numbers: three of lower bounds, then three of upper bounds.
[[nodiscard, gnu::always_inline]] inline std::uint64_t overlapping_pairs(const std::int16_t* a,
                                                                         const std::int16_t* b) noexcept {
    using eight_halves = std::int16_t __attribute__((vector_size(16)));
    using four_rows = std::int16_t __attribute__((vector_size(64)));
    // Boxes i and j are disjoint if a difference upper - lower is negative. A row of eight pairs collects the signs of
    // its differences by OR: `even` has the rows with even j, `odd` those with odd j, since AVX-512 packs the signs of
    // two vectors by taking eight of each in turn. Differences saturate, so that none overflows to the other sign.
    four_rows even{};
    four_rows odd{};
    const auto indices = std::make_index_sequence<32>{};
    constexpr auto in_turn = [](std::size_t i) { return i % 8; };
    constexpr auto even_ones = [](std::size_t i) { return i / 8 * 2; };
    constexpr auto odd_ones = [](std::size_t i) { return i / 8 * 2 + 1; };
    for (std::size_t k = 0; k < 3; ++k) {
        const auto four_times = [&](eight_halves v) { return shuffled<four_rows, in_turn>(v, v, indices); };
        const auto each_even = [&](eight_halves v) { return shuffled<four_rows, even_ones>(v, v, indices); };
        const auto each_odd = [&](eight_halves v) { return shuffled<four_rows, odd_ones>(v, v, indices); };
        const auto row = [k](const std::int16_t* of, std::size_t first) {
            return load_eight<eight_halves>(of + 8 * (first + k));
        };
        const four_rows lower = four_times(row(a, 0));
        const four_rows upper = four_times(row(a, 3));
        const eight_halves lower_of_b = row(b, 0);
        const eight_halves upper_of_b = row(b, 3);
        even |= __builtin_elementwise_sub_sat(each_even(upper_of_b), lower) |
                __builtin_elementwise_sub_sat(upper, each_even(lower_of_b));
        odd |= __builtin_elementwise_sub_sat(each_odd(upper_of_b), lower) |
               __builtin_elementwise_sub_sat(upper, each_odd(lower_of_b));
    }
#if defined(__AVX512BW__)
    return ~detail::negative_of_eights_in_turn(&even, &odd);
#else
    using bytes = std::int8_t __attribute__((vector_size(32)));
    using bools = bool __attribute__((ext_vector_type(32)));
    const auto disjoint_even = __builtin_convertvector(even < 0, bytes);
    const auto disjoint_odd = __builtin_convertvector(odd < 0, bytes);
    const auto bits = [](bytes v) {
        return std::uint64_t{__builtin_bit_cast(std::uint32_t, __builtin_convertvector(v, bools))};
    };
    // Interleaves the rows of eight of both vectors.
    constexpr auto low_rows = [](std::size_t i) { return i / 16 * 8 + i % 8 + i / 8 % 2 * 32; };
    constexpr auto high_rows = [](std::size_t i) { return 16 + i / 16 * 8 + i % 8 + i / 8 % 2 * 32; };
    const std::uint64_t first = bits(shuffled<bytes, low_rows>(disjoint_even, disjoint_odd, indices));
    const std::uint64_t last = bits(shuffled<bytes, high_rows>(disjoint_even, disjoint_odd, indices));
    return ~(first | last << 32U);
#endif
}

/// Stores the positions of the set bits, in order; up to 64 bytes at `to` are overwritten.
[[gnu::always_inline]] inline void store_set_bits(std::uint8_t* to, std::uint64_t set) noexcept {
#if defined(__AVX512VBMI2__)
    detail::store_set_bits_of_sixty_four(set, to);
#else
    for (; set != 0; set &= set - 1) *to++ = static_cast<std::uint8_t>(std::countr_zero(set));
#endif
}

}  // namespace aabb::simd
