module;
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#if defined(__AVX2__)
#include <immintrin.h>
#endif

/// Eight numbers at a time, whatever a register of the processor takes: for what comes in eights by its nature, such as
/// the children of a node.
export module aabb.simd:eights;

namespace aabb::simd::detail {

#if defined(__AVX512VBMI2__)
[[gnu::always_inline]] inline void places_of_sixty_four(std::uint64_t set, void* to) noexcept {
    static constexpr auto all = [] {
        struct {
            std::uint8_t at[64];
        } places{};
        for (std::uint8_t i = 0; i < 64; ++i) places.at[i] = i;
        return places;
    }();
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi8(set, _mm512_loadu_si512(&all)));
}
#endif
#if defined(__AVX2__)
[[gnu::always_inline]] inline void take_eight(const float* from, const void* places, void* to) noexcept {
    const __m256i at = _mm256_loadu_si256(static_cast<const __m256i*>(places));
    _mm256_storeu_ps(static_cast<float*>(to), _mm256_permutevar8x32_ps(_mm256_loadu_ps(from), at));
}
#endif

using two_points_of_four = float __attribute__((vector_size(32)));
/// Each with a fourth number that is not theirs.
[[nodiscard, gnu::always_inline]] inline two_points_of_four two_points(const float* p, const float* q) noexcept {
#if defined(__AVX512VL__)
    const __m256 low = _mm256_castps128_ps256(_mm_maskz_loadu_ps(7, p));
    return _mm256_insertf128_ps(low, _mm_maskz_loadu_ps(7, q), 1);
#else
    return two_points_of_four{p[0], p[1], p[2], 0, q[0], q[1], q[2], 0};
#endif
}

}  // namespace aabb::simd::detail

export namespace aabb::simd {

using eight_floats = float __attribute__((vector_size(32)));
using eight_doubles = double __attribute__((vector_size(64)));
using eight_words = std::uint32_t __attribute__((vector_size(32)));
using eight_bytes = std::uint8_t __attribute__((vector_size(8)));

template <class Vector, class Number>
[[nodiscard, gnu::always_inline]] inline Vector load_eight(const Number* from) noexcept {
    static_assert(sizeof(Vector) == 8 * sizeof(Number));
    Vector v;
    std::memcpy(&v, from, sizeof v);
    return v;
}

template <class Number, class Vector>
[[gnu::always_inline]] inline void store_eight(Number* to, Vector v) noexcept {
    static_assert(sizeof(Vector) == 8 * sizeof(Number));
    std::memcpy(to, &v, sizeof v);
}

/// Of eight points of three numbers: their columns, eight numbers each, one behind the other.
[[gnu::always_inline]] inline void store_columns_of_eight_points(const float* const* points, float* columns) noexcept {
    const auto row = [&](int i) { return detail::two_points(points[i], points[i + 4]); };
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
    store_eight(columns, first_halves(xy_01, xy_23));
    store_eight(columns + 8, last_halves(xy_01, xy_23));
    store_eight(columns + 16, first_halves(high(row(0), row(1)), high(row(2), row(3))));
}

/// Of eight numbers those at these places, of which the lowest three bits count.
[[nodiscard, gnu::always_inline]] inline eight_floats taken(const float* from, eight_words places) noexcept {
    eight_floats v;
#if defined(__AVX2__)
    detail::take_eight(from, &places, &v);
#else
    for (int i = 0; i < 8; ++i) v[i] = from[places[i] & 7U];
#endif
    return v;
}

[[nodiscard, gnu::always_inline]] inline float least(eight_floats v) noexcept {
    const auto lesser = [](eight_floats p, eight_floats q) { return p < q ? p : q; };
    v = lesser(v, __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3));
    v = lesser(v, __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5));
    return lesser(v, __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6))[0];
}

[[nodiscard, gnu::always_inline]] inline float sum(eight_floats v) noexcept {
    v += __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3);
    v += __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5);
    return v[0] + v[1];
}

/// Bit i for number i of a comparison.
template <class Flags>
[[nodiscard, gnu::always_inline]] inline std::uint32_t bits_of_eight(Flags flags) noexcept {
    using bools = bool __attribute__((ext_vector_type(8)));
    return __builtin_bit_cast(std::uint8_t, __builtin_convertvector(flags, bools));
}

/// Of each of eight numbers the whole part, no more than 254, and 0 where it is less or not a number.
[[nodiscard, gnu::always_inline]] inline eight_bytes whole_bytes(eight_floats v) noexcept {
    using eight_ints = std::int32_t __attribute__((vector_size(32)));
    const eight_floats none{};
    const eight_floats above = v > none ? v : none;
    const eight_floats most = none + 254;
    return __builtin_convertvector(__builtin_convertvector(above < most ? above : most, eight_ints), eight_bytes);
}

/// Bit 8 j + i is set where number i of `a` is at most number j of `b`.
[[nodiscard, gnu::always_inline]] inline std::uint64_t no_greater(const std::uint8_t* a, eight_bytes b) noexcept {
    using bytes = std::uint8_t __attribute__((vector_size(64)));
    using flags = std::int8_t __attribute__((vector_size(64)));
    using bools = bool __attribute__((ext_vector_type(64)));
    using rows = std::uint64_t __attribute__((vector_size(64)));
    std::uint64_t row = 0;
    std::memcpy(&row, a, sizeof row);
    const auto left = reinterpret_cast<bytes>(rows{} + row);
    const bytes right = __builtin_shufflevector(b, b, 0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 2, 2,
                                                2, 2, 3, 3, 3, 3, 3, 3, 3, 3, 4, 4, 4, 4, 4, 4, 4, 4, 5, 5, 5, 5, 5, 5,
                                                5, 5, 6, 6, 6, 6, 6, 6, 6, 6, 7, 7, 7, 7, 7, 7, 7, 7);
    const flags held = left <= right;
    return __builtin_bit_cast(std::uint64_t, __builtin_convertvector(held, bools));
}

/// The places of the bits that are set, in order; whatever stands behind them, up to 64 bytes, is lost.
[[gnu::always_inline]] inline void store_places(std::uint8_t* to, std::uint64_t set) noexcept {
#if defined(__AVX512VBMI2__)
    detail::places_of_sixty_four(set, to);
#else
    for (; set != 0; set &= set - 1) *to++ = static_cast<std::uint8_t>(std::countr_zero(set));
#endif
}

}  // namespace aabb::simd
