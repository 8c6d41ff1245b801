module;
#if defined(__FAST_MATH__) || __FINITE_MATH_ONLY__
#error "aabblab needs the arithmetic of IEEE 754: compile without -ffast-math, -Ofast or -ffinite-math-only"
#endif

/// What answers may assume of floating-point arithmetic. Interfaces are compiled with the options of whoever imports
/// them, so a file whose results hang on every rounding says itself that sums and products stay as they are written.
export module aabb.base:floating_point;

import aabb.std;
import :frame_state;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)

namespace aabb::detail {

// Volatile: read when the program runs, or the compiler would compute in the arithmetic that it believes in.
inline const volatile double least_double = std::numeric_limits<double>::denorm_min();
inline const volatile double near_one = 1 + 0x1p-30;
inline const volatile double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// @throws input_error that says what is wrong with the arithmetic.
[[noreturn]] void refuse_arithmetic(bool keeps_denormals, bool rounds_to_nearest, bool knows_nan) {
    if (!keeps_denormals)
        throw input_error(
            "answers cannot be exact here: this thread flushes denormal numbers to zero, as a library linked with "
            "-ffast-math makes it do; clear FTZ and DAZ before the query");
    if (!rounds_to_nearest)
        throw input_error(
            "answers cannot be exact here: this thread does not round to nearest; call std::fesetround(FE_TONEAREST) "
            "before the query");
    if (!knows_nan)
        throw input_error(
            "answers cannot be exact here: NaN is taken for a number; compile without -ffinite-math-only");
    throw input_error(
        "answers cannot be exact here: products are fused into sums; compile with -ffp-contract=on in place of "
        "-ffp-contract=fast, and without -funsafe-math-optimizations");
}

}  // namespace aabb::detail

export namespace aabb {

/// Every query asks this first; it costs some additions. Always inline: it asks for whoever compiles the query, since
/// `-ffp-contract=fast` fuses whatever a file says, and no macro tells of it.
/// @throws input_error where the thread flushes denormals to zero, as a library linked with -ffast-math makes it do, or
/// does not round to nearest; where products are fused into sums, or NaN is taken for a number.
[[gnu::always_inline]] inline void require_ieee_arithmetic() {
    const double least = detail::least_double;
    const double root = detail::near_one;
    const bool keeps_denormals = least + least != 0;
    const bool rounds_to_nearest = 1 + least == 1 - least;
    const bool fuses = root * root - (1 + 0x1p-29) != 0;  // the exact square has 2^-60 more
    const double nan = detail::not_a_number;
    const bool knows_nan = nan != nan;
    if (!keeps_denormals || !rounds_to_nearest || !knows_nan || fuses) [[unlikely]]
        detail::refuse_arithmetic(keeps_denormals, rounds_to_nearest, knows_nan);
}

}  // namespace aabb
