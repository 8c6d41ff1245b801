/// The clocks of all measurements.
export module aabblab.stopwatch;

import aabb.std;

export namespace aabblab {

/// Must be called before times are measured for results.
/// @throws aabb::input_error if the resolution of a clock is worse than a hundredth of a millisecond.
void require_fine_clock();

/// Wall time of one call, in milliseconds.
[[nodiscard]] double milliseconds_of(auto&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// The times of one call, or sums of them, in milliseconds.
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
/// The measured time of an empty call: reading the clock takes as long as a frame with a few dozen boxes.
[[nodiscard]] double empty_cpu_ms();

/// Wall time and processor time of one call. The wall clock is read inside, because its cost is negligible.
[[nodiscard]] elapsed elapsed_in(auto&& work) {
    const double start = thread_cpu_ms();
    const double wall = milliseconds_of(work);
    const double cpu = thread_cpu_ms() - start - empty_cpu_ms();
    return {wall, cpu > 0 ? cpu : 0};
}

/// "2026-01-31T12:00:00Z"
[[nodiscard]] std::string date_now();

}  // namespace aabblab
