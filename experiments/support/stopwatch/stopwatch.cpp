module;
#include <ctime>

module aabblab.stopwatch;

import aabb.base;
import aabblab.numbers;

namespace aabblab {

namespace {

/// About the time per frame of some hundred boxes; reading the clock takes less.
constexpr double longest_step_ms = 1e-2;

double wall_ms() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The step of a clock: the minimum of a few, because interrupts hide steps; stops at the first that is fine enough.
double step_of(double (*clock)()) {
    double step = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 10 && step > longest_step_ms; ++i) {
        const double before = clock();
        double after = before;
        while (after == before) after = clock();
        step = std::min(step, after - before);
    }
    return step;
}

}  // namespace

void require_fine_clock() {
    const double step = std::max(step_of(wall_ms), step_of(thread_cpu_ms));
    if (step > longest_step_ms)
        throw aabb::input_error("the clock of this machine has a resolution of " + three_digits(step) +
                                " ms, too coarse for these times; at most " + three_digits(longest_step_ms) +
                                " ms is required");
}

double thread_cpu_ms() {
    std::timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

/// The time of reading the clock, subtracted from all measurements: the minimum, because disturbances only add time.
double empty_cpu_ms() {
    static const double least = [] {
        double minimum = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 1000; ++i) {
            const double start = thread_cpu_ms();
            static_cast<void>(wall_stopwatch().ms());
            minimum = std::min(minimum, thread_cpu_ms() - start);
        }
        return minimum;
    }();
    return least;
}

std::string date_now() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text.data();
}

}  // namespace aabblab
