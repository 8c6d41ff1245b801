module;
#include <algorithm>
#include <ctime>
#include <limits>

module aabblab.stopwatch;

namespace aabblab {

double thread_cpu_ms() {
    std::timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

double empty_cpu_ms() {
    // The least of many: what disturbs a reading only adds to it.
    static const double least = [] {
        double found = std::numeric_limits<double>::infinity();
        for (int i = 0; i < 1000; ++i) {
            const double start = thread_cpu_ms();
            static_cast<void>(milliseconds_of([] {}));
            found = std::min(found, thread_cpu_ms() - start);
        }
        return found;
    }();
    return least;
}

}  // namespace aabblab
