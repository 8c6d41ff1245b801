/// Vectors of eight elements, whatever the register width, for data in eights such as the children of a wide node.
export module aabb.simd:eights;

import aabb.std;

export namespace aabb::simd {

using eight_floats = float __attribute__((vector_size(32)));
using sixteen_floats = float __attribute__((vector_size(64)));
using eight_doubles = double __attribute__((vector_size(64)));
using eight_words = std::uint32_t __attribute__((vector_size(32)));
using eight_bytes = std::uint8_t __attribute__((vector_size(8)));
using sixteen_i16 = std::int16_t __attribute__((vector_size(32)));

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

[[nodiscard, gnu::always_inline]] inline float least(eight_floats v) noexcept {
    const auto lesser = [](eight_floats p, eight_floats q) { return p < q ? p : q; };
    v = lesser(v, __builtin_shufflevector(v, v, 4, 5, 6, 7, 0, 1, 2, 3));
    v = lesser(v, __builtin_shufflevector(v, v, 2, 3, 0, 1, 6, 7, 4, 5));
    return lesser(v, __builtin_shufflevector(v, v, 1, 0, 3, 2, 5, 4, 7, 6))[0];
}
[[nodiscard, gnu::always_inline]] inline float least(sixteen_floats v) noexcept {
    const eight_floats low = __builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7);
    const eight_floats high = __builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15);
    return least(low < high ? low : high);
}

/// Element i is element `Place(i)` of the concatenated vectors.
template <class Result, auto Place, class Vector, std::size_t... I>
[[nodiscard, gnu::always_inline]] inline Result shuffled(Vector a, Vector b, std::index_sequence<I...>) noexcept {
    return __builtin_bit_cast(Result, __builtin_shufflevector(a, b, static_cast<int>(Place(I))...));
}

/// Bit i is set if a comparison holds in lane i.
template <class Flags>
[[nodiscard, gnu::always_inline]] inline std::uint32_t bits_of_eight(Flags flags) noexcept {
    using bools = bool __attribute__((ext_vector_type(8)));
    return __builtin_bit_cast(std::uint8_t, __builtin_convertvector(flags, bools));
}

/// The same for sixteen lanes of 16 bits.
[[nodiscard, gnu::always_inline]] inline std::uint32_t bits_of_sixteen(sixteen_i16 flags) noexcept {
    using bools = bool __attribute__((ext_vector_type(16)));
    return __builtin_bit_cast(std::uint16_t, __builtin_convertvector(flags, bools));
}

/// The inverse of `bits_of_eight`: lane i is all ones if bit i is set.
[[nodiscard, gnu::always_inline]] inline eight_words flags_of_eight(std::uint8_t bits) noexcept {
    constexpr eight_words bit{1, 2, 4, 8, 16, 32, 64, 128};
    return __builtin_bit_cast(eight_words, (bit & std::uint32_t{bits}) == bit);
}

/// Truncates each lane to an integer, clamped to 0 to 254; NaN becomes 0.
[[nodiscard, gnu::always_inline]] inline eight_bytes whole_bytes(eight_floats v) noexcept {
    using eight_ints = std::int32_t __attribute__((vector_size(32)));
    const eight_floats zero{};
    const eight_floats above = v > zero ? v : zero;
    const eight_floats most = zero + 254;
    return __builtin_convertvector(__builtin_convertvector(above < most ? above : most, eight_ints), eight_bytes);
}

/// Truncates each lane to an i16, clamped to its range. The conversion is monotone.
[[nodiscard, gnu::always_inline]] inline sixteen_i16 whole_i16(sixteen_floats v) noexcept {
    using sixteen_ints = std::int32_t __attribute__((vector_size(64)));
    const sixteen_floats most = sixteen_floats{} + 32767;
    const sixteen_floats above = v > -most ? v : -most;
    return __builtin_convertvector(__builtin_convertvector(above < most ? above : most, sixteen_ints), sixteen_i16);
}

}  // namespace aabb::simd
