module;

module aabb.base;

namespace aabb::detail {

void refuse_arithmetic(bool keeps_denormals, bool rounds_to_nearest, bool knows_nan) {
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
