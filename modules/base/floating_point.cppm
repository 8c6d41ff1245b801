module;
#if defined(__FAST_MATH__) || __FINITE_MATH_ONLY__
#error "aabblab needs the arithmetic of IEEE 754: compile without -ffast-math, -Ofast or -ffinite-math-only"
#endif

/// The floating-point arithmetic on which exact results depend. Interfaces are compiled with the options of their
/// importers, so each file whose results depend on every rounding disables reordering and contraction by pragmas.
export module aabb.base:floating_point;

import aabb.std;
import :frame_state;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)

namespace aabb::detail {

// Volatile, so that the checks run in the actual arithmetic instead of being folded by the compiler.
inline const volatile double least_double = std::numeric_limits<double>::denorm_min();
inline const volatile double near_one = 1 + 0x1p-30;
inline const volatile double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Reports the first fault of the arithmetic; if no condition is false, products and sums are fused. Out of line, so
/// that `require_ieee_arithmetic`, which every query calls, stays small.
[[noreturn]] void reject_arithmetic(bool keeps_denormals, bool rounds_to_nearest, bool knows_nan) {
    if (!keeps_denormals)
        throw input_error(
            "results cannot be exact: this thread flushes denormal numbers to zero, perhaps because a library was "
            "linked with -ffast-math; clear FTZ and DAZ before the query");
    if (!rounds_to_nearest)
        throw input_error(
            "results cannot be exact: this thread does not round to nearest; call std::fesetround(FE_TONEAREST) before "
            "the query");
    if (!knows_nan)
        throw input_error("results cannot be exact: comparisons ignore NaN; compile without -ffinite-math-only");
    throw input_error(
        "results cannot be exact: products and sums are fused; compile with -ffp-contract=on instead of "
        "-ffp-contract=fast, and without -funsafe-math-optimizations");
}

}  // namespace aabb::detail

export namespace aabb {

/// Rejects arithmetic other than that of IEEE 754, on which exact results depend, at the cost of a few additions per
/// query. Always inline, so that it checks the options of the importer: `-ffp-contract=fast` overrides the pragmas, and
/// no macro reveals it. Volatile operands keep the compiler from evaluating it.
/// @throws input_error if denormals are flushed to zero, as by a library linked with -ffast-math, rounding is not to
/// nearest, products are fused into sums, or comparisons ignore NaN
[[gnu::always_inline]] inline void require_ieee_arithmetic() {
    const double least = detail::least_double;  // the least positive double, a denormal number
    const double root = detail::near_one;       // 1 + 2^-30
    const bool keeps_denormals = least + least != 0;
    const bool rounds_to_nearest = 1 + least == 1 - least;  // both are 1; a directed rounding changes one of them
    // The square is 1 + 2^-29 + 2^-60, whose last term is lost unless the product and the difference are fused.
    const bool fuses = root * root - (1 + 0x1p-29) != 0;
    const double nan = detail::not_a_number;
    const bool knows_nan = nan != nan;
    if (!keeps_denormals || !rounds_to_nearest || !knows_nan || fuses) [[unlikely]]
        detail::reject_arithmetic(keeps_denormals, rounds_to_nearest, knows_nan);
}

}  // namespace aabb
