/// The clocks of all measurements.
export module aabblab.stopwatch;

import aabb.std;

export namespace aabblab {

/// Must be called before times are measured for results.
/// @throws aabb::input_error if the resolution of a clock is worse than a hundredth of a millisecond.
void require_fine_clock();

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

/// Processor time of this thread so far.
[[nodiscard]] double thread_cpu_ms();
/// The measured time of no work: reading the clock takes as long as a frame with a few dozen boxes.
[[nodiscard]] double empty_cpu_ms();

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

/// "2026-01-31T12:00:00Z"
[[nodiscard]] std::string date_now();

}  // namespace aabblab
