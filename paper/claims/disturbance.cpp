module;
#include <fmt/format.h>

module aabblab.claims;

namespace aabblab {

namespace {

/// Of the time of all frames, in per cent. A quiet machine takes a thousandth away for its own needs.
constexpr double most_waiting = 2;
/// By which one repeat differs from the next in the median, in per cent.
constexpr double most_difference = 5;

/// What repeats and their clocks tell of the machine.
struct signs {
    double wall_ms = 0;
    double cpu_ms = 0;
    std::vector<double> differences;  ///< of processor time from one repeat to the next, as shares
};

signs signs_of(const measurements& m) {
    signs found;
    for (const std::string& experiment : m.experiments())
        for (const condition& c : m.of(experiment)) {
            for (const double ms : c.values(measured("frame_ms"))) found.wall_ms += ms;
            for (const double ms : c.values(measured("frame_cpu_ms"))) found.cpu_ms += ms;
            const std::vector<double> some = c.differences(measured("frame_cpu_ms"));
            found.differences.insert(found.differences.end(), some.begin(), some.end());
        }
    return found;
}

}  // namespace

std::string disturbance_of(std::span<const measurements> machines) {
    std::string text;
    for (const measurements& m : machines) {
        const signs found = signs_of(m);
        if (!(found.wall_ms > 0)) continue;
        const double waiting = std::max(0.0, 100 * (1 - found.cpu_ms / found.wall_ms));
        const double difference = found.differences.empty() ? 0 : 100 * quartiles_of(found.differences).median;
        if (waiting <= most_waiting && difference <= most_difference) continue;
        text += (text.empty() ? "The machine" : " The machine") +
                (machines.size() > 1 ? " of " + m.name() : std::string()) + " was not quiet:";
        if (difference > most_difference)
            text += fmt::format(
                " one repeat differs from the next by {:.1f} % in the median, on a quiet one by less than "
                "{:.0f} %.",
                difference, most_difference);
        if (waiting > most_waiting)
            text += fmt::format(
                " of the time of all frames the program waited {:.1f} % for a processor, on a quiet one "
                "less than {:.0f} %.",
                waiting, most_waiting);
        text += " Ratios may be off by more than their intervals say.";
    }
    return text;
}

}  // namespace aabblab
