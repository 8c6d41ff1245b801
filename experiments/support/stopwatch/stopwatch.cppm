/// The clocks that all times are taken with.
export module aabblab.stopwatch;

import aabb.std;

export namespace aabblab {

/// To be called before anything is timed whose time is what is asked for.
/// @throws aabb::input_error where a clock goes in steps of more than a hundredth of a millisecond.
void require_fine_clock();

/// Wall time of one call, in milliseconds.
[[nodiscard]] double milliseconds_of(auto&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Of one call, in milliseconds.
struct elapsed {
    double wall_ms = 0;
    double cpu_ms = 0;  ///< that this thread had a processor: what waits for one, or for a neighbour, is not in it

    elapsed& operator+=(const elapsed& other) {
        wall_ms += other.wall_ms;
        cpu_ms += other.cpu_ms;
        return *this;
    }
};

/// Processor time of this thread so far.
[[nodiscard]] double thread_cpu_ms();
/// Of a call that does nothing: reading the clock takes as long as a frame of some dozen boxes.
[[nodiscard]] double empty_cpu_ms();

/// Wall time and processor time of one call. The wall clock is read inside, where it costs nothing to speak of.
[[nodiscard]] elapsed elapsed_in(auto&& work) {
    const double start = thread_cpu_ms();
    const double wall = milliseconds_of(work);
    const double cpu = thread_cpu_ms() - start - empty_cpu_ms();
    return {wall, cpu > 0 ? cpu : 0};
}

/// "2026-01-31T12:00:00Z"
[[nodiscard]] std::string date_now();

}  // namespace aabblab
