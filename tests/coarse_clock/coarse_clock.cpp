// Preloaded, it has a program see clocks that go in steps of 15 ms, as some machines and emulators have them.
#include <sys/syscall.h>
#include <unistd.h>

#include <ctime>

extern "C" int clock_gettime(clockid_t which, timespec* now) {
    constexpr long step = 15'000'000;
    const auto result = static_cast<int>(syscall(SYS_clock_gettime, which, now));
    if (which != CLOCK_REALTIME) now->tv_nsec -= now->tv_nsec % step;
    return result;
}
