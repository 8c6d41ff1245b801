module;
#ifdef __SSE2__
#include <xmmintrin.h>
#endif

#include <cassert>
#include <cfenv>

module aabb.extreme;

namespace aabb {

namespace {

void flush_denormals() {
#ifdef __SSE2__
    // Bits of SSE's control register: denormal results become zero, denormal operands count as zero.
    constexpr unsigned flush_to_zero = 1U << 15, denormals_are_zero = 1U << 6;
    _mm_setcsr(_mm_getcsr() | flush_to_zero | denormals_are_zero);
#endif
}

}  // namespace

bool can_flush_denormals() noexcept {
#ifdef __SSE2__
    return true;
#else
    return false;
#endif
}

/// Runs the work in a new thread, whose floating-point mode ends with it. Exceptions are rethrown here.
void in_arithmetic(arithmetic kind, const std::function<void()>& work) {
    assert(kind != arithmetic::denormals_flushed || can_flush_denormals());
    std::async(std::launch::async, [&] {
        if (kind == arithmetic::denormals_flushed) flush_denormals();
        if (kind == arithmetic::rounded_upward) std::fesetround(FE_UPWARD);
        work();
    }).get();
}

}  // namespace aabb
