module;
#include <ctime>

/// The clocks of all measurements.
export module aabblab.stopwatch;

import aabb.base;
import aabb.std;
import aabblab.numbers;

namespace aabblab {

/// About the time per frame of some hundred boxes; reading the clock takes less.
constexpr double longest_step_ms = 1e-2;

double wall_ms() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The step of a clock in milliseconds, the minimum of up to ten between different readings, because interrupts may
/// hide steps; one of `longest_step_ms`, fine enough, ends the measurement.
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

}  // namespace aabblab

export namespace aabblab {

/// Processor time of this thread so far.
[[nodiscard]] double thread_cpu_ms() {
    std::timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

/// Must be called before times are measured for results.
/// @throws aabb::input_error if the resolution of a clock is worse than a hundredth of a millisecond.
void require_fine_clock() {
    const double step = std::max(step_of(wall_ms), step_of(thread_cpu_ms));
    if (step > longest_step_ms)
        throw aabb::input_error("the clock of this machine has a resolution of " + three_digits(step) +
                                " ms, too coarse for these times; at most " + three_digits(longest_step_ms) +
                                " ms is required");
}

/// Wall time since its construction.
class wall_stopwatch {
public:
    [[nodiscard]] double ms() const {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_).count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Times measured by one stopwatch, or sums of them, in milliseconds.
struct elapsed {
    double wall_ms = 0;
    double cpu_ms = 0;  ///< processor time of this thread; excludes waiting and preemption

    elapsed& operator+=(const elapsed& other) {
        wall_ms += other.wall_ms;
        cpu_ms += other.cpu_ms;
        return *this;
    }
};

/// The processor time that a stopwatch measures around no work. It is subtracted from all measurements, as reading the
/// clocks takes as long as a frame with a few dozen boxes. The minimum is taken, because disturbances only add time.
[[nodiscard]] double empty_cpu_ms() {
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

/// Wall time and processor time since its construction or last lap. The wall clock is read inside, because its cost is
/// negligible.
class stopwatch {
public:
    /// Reads the times, and restarts.
    [[nodiscard]] elapsed lap() {
        const elapsed times{wall_.ms(), std::max(thread_cpu_ms() - start_ - empty_cpu_ms(), 0.0)};
        *this = {};
        return times;
    }

private:
    double start_ = thread_cpu_ms();
    wall_stopwatch wall_;
};

/// The time now, in UTC: "2026-01-31T12:00:00Z"
[[nodiscard]] std::string date_now() {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
    return text.data();
}

}  // namespace aabblab
