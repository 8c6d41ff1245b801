module;
#include <sched.h>

module aabblab.processor;

import aabb.std;

namespace aabblab {

namespace {

/// The ticks (hundredths of a second) for which each processor has been busy, by its number, from lines "cpu3 user nice
/// system …"; empty if /proc/stat is unavailable.
std::map<std::size_t, double> busy_ticks() {
    std::map<std::size_t, double> busy;
    std::ifstream in("/proc/stat");
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with("cpu") || line.starts_with("cpu ")) continue;
        std::istringstream fields(line.substr(3));
        std::size_t number = 0;
        double user = 0, nice = 0, system = 0;
        if (fields >> number >> user >> nice >> system) busy[number] = user + nice + system;
    }
    return busy;
}

}  // namespace

/// Pins this thread to the processor that was idlest during a short sample, where other load disturbs times least.
idlest_processor::idlest_processor() {
    constexpr auto sample_time = std::chrono::milliseconds(60);  // six ticks
    if (sched_getaffinity(0, sizeof before_, &before_) != 0 || CPU_COUNT(&before_) < 2) return;
    const std::map<std::size_t, double> busy_before = busy_ticks();
    std::this_thread::sleep_for(sample_time);
    double least = std::numeric_limits<double>::infinity();
    std::size_t idlest = CPU_SETSIZE;
    for (const auto& [number, ticks] : busy_ticks()) {
        const auto earlier = busy_before.find(number);
        if (number >= CPU_SETSIZE || !CPU_ISSET(number, &before_) || earlier == busy_before.end()) continue;
        // Ties go to the last processor, because interrupts tend to go to the first.
        if (ticks - earlier->second > least) continue;
        least = ticks - earlier->second;
        idlest = number;
    }
    if (idlest == CPU_SETSIZE) return;
    CPU_ZERO(&idlest_);
    CPU_SET(idlest, &idlest_);
    is_pinned_ = sched_setaffinity(0, sizeof idlest_, &idlest_) == 0;
}

}  // namespace aabblab
