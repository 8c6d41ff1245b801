module;
#if defined(__AVX2__)
#include <immintrin.h>
#endif

/// Vectors of the register width for which the build was configured: 16, 8 or 4 lanes. The code uses the compiler's
/// vector extensions, and intrinsics only for operations that these lack.
export module aabb.simd:lanes;

import aabb.std;
import :width;

// Intrinsics of both widths; vectors are passed through memory, which the optimizer removes.
namespace aabb::simd::detail {

#if defined(__AVX512F__)
[[gnu::always_inline]] inline void compress_sixteen(void* to, const void* from, std::uint32_t set) noexcept {
    _mm512_storeu_si512(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(set), _mm512_loadu_si512(from)));
}
#endif

#if defined(__AVX2__)
/// The permutation that packs each set of lanes, as eight bytes.
inline constexpr std::array<std::uint64_t, 256> packed_places = [] {
    std::array<std::uint64_t, 256> permutations{};
    for (std::uint64_t set = 0; set < 256; ++set) {
        unsigned n = 0;
        for (std::uint64_t lane = 0; lane < 8; ++lane)
            if (set >> lane & 1U) permutations[set] |= lane << 8 * n++;
    }
    return permutations;
}();

[[gnu::always_inline]] inline void compress_eight(void* to, const void* from, std::uint32_t set) noexcept {
    const __m256i places = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(static_cast<long long>(packed_places[set])));
    _mm256_storeu_si256(static_cast<__m256i*>(to),
                        _mm256_permutevar8x32_epi32(_mm256_loadu_si256(static_cast<const __m256i*>(from)), places));
}
#endif

}  // namespace aabb::simd::detail

export namespace aabb::simd {

using floats = float __attribute__((vector_size(4 * width)));
using words = std::uint32_t __attribute__((vector_size(4 * width)));
using flags = std::int32_t __attribute__((vector_size(4 * width)));  ///< result of a comparison: -1 in lanes that hold

inline constexpr std::uint32_t every_lane = static_cast<std::uint32_t>((std::uint64_t{1} << width) - 1);

[[nodiscard, gnu::always_inline]] inline floats broadcast(float x) noexcept {
    return floats{} + x;
}
[[nodiscard, gnu::always_inline]] inline words broadcast(std::uint32_t x) noexcept {
    return words{} + x;
}

/// 0, 1, 2, …
[[nodiscard, gnu::always_inline]] inline words places() noexcept {
    words v{};
    for (std::size_t i = 0; i < width; ++i) v[i] = static_cast<std::uint32_t>(i);
    return v;
}

[[nodiscard, gnu::always_inline]] inline words load(const std::uint32_t* from) noexcept {
    words v;
    std::memcpy(&v, from, sizeof v);
    return v;
}
[[gnu::always_inline]] inline void store(std::uint32_t* to, words v) noexcept {
    std::memcpy(to, &v, sizeof v);
}

/// Bit i is set if the comparison holds in lane i.
[[nodiscard, gnu::always_inline]] inline std::uint32_t bits(flags comparison) noexcept {
    using bools = bool __attribute__((ext_vector_type(width)));
    using pattern = std::conditional_t<width == 16, std::uint16_t, std::uint8_t>;
    return __builtin_bit_cast(pattern, __builtin_convertvector(comparison, bools)) & every_lane;
}

/// Bit l of lane i is set if l is less than lane i of `ends`, which may be negative.
[[nodiscard, gnu::always_inline]] inline words lanes_below(words ends) noexcept {
    const auto signed_ends = reinterpret_cast<flags>(ends);
    const flags positive = signed_ends > 0 ? signed_ends : flags{};
    const flags clamped = positive < static_cast<int>(width) ? positive : flags{} + static_cast<int>(width);
    return every_lane >> (static_cast<std::uint32_t>(width) - reinterpret_cast<words>(clamped));
}

/// The set of the lanes below `end`.
[[nodiscard, gnu::always_inline]] inline std::uint32_t lanes_below(std::size_t end) noexcept {
    return end >= width ? every_lane : (std::uint32_t{1} << end) - 1;
}

/// Whether a permutation of lanes may depend on data: processors with vectors of four lanes have none that does.
inline constexpr bool has_compress = width > 4;

/// The lanes whose bit is set, one after the other; those behind them are unspecified.
[[nodiscard, gnu::always_inline]] inline words compress(words v, std::uint32_t set) noexcept {
    words packed{};
#if defined(__AVX512F__)
    if constexpr (width == 16) return detail::compress_sixteen(&packed, &v, set), packed;
#endif
#if defined(__AVX2__)
    if constexpr (width == 8) return detail::compress_eight(&packed, &v, set), packed;
#endif
    for (std::size_t i = 0, n = 0; i < width; n += set >> i & 1U, ++i) packed[n] = v[i];
    return packed;
}

/// Compress-store: writes the lanes whose bit is set to `to`, one after the other. `to` must have room for a whole
/// vector, since the elements behind the stored lanes may be overwritten.
/// @returns the number of stored lanes
[[gnu::always_inline]] inline std::size_t compress_store(std::uint32_t* to, words v, std::uint32_t set) noexcept {
    const auto stored = static_cast<std::size_t>(std::popcount(set));
    if constexpr (has_compress) return store(to, compress(v, set)), stored;
    for (std::size_t i = 0, n = 0; i < width; n += set >> i & 1U, ++i) to[n] = v[i];
    return stored;
}

}  // namespace aabb::simd
