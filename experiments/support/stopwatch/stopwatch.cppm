module;
#include <chrono>

/// The one clock that all times are taken with.
export module aabblab.stopwatch;

export namespace aabblab {

/// Wall time of one call, in milliseconds.
template <class Work>
[[nodiscard]] double milliseconds_of(Work&& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace aabblab
