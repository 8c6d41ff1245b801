/// Labels of an atlas, their regrets, and ratios with their errors.
module aabblab.atlas:labels;

import aabb.std;
import aabblab.atlas;
import aabblab.statistics;

namespace aabblab {

inline constexpr span_of_time per_frame = span_of_time::frame;

/// All labels, in the order of their first appearance.
[[nodiscard]] inline std::vector<std::string> labels_of(const std::vector<atlas_scene>& atlas) {
    std::vector<std::string> labels;
    for (const atlas_scene& scene : atlas)
        for (const atlas_line& line : scene.lines)
            if (std::ranges::find(labels, line.label) == labels.end()) labels.push_back(line.label);
    return labels;
}

/// The strategies of a line without their parameters: "neighbour_list + bucket + columns + simd".
[[nodiscard]] inline std::string family_of(std::string_view label) {
    std::string family;
    for (std::size_t i = 0; i < label.size(); ++i) {
        if (label[i] == ':') i = std::min(label.find(' ', i), label.size());
        if (i < label.size()) family += label[i];
    }
    return family;
}

/// Times relative to the fastest, one per scene that has the label, in ascending order.
[[nodiscard]] inline std::vector<double> regrets_of(const std::vector<atlas_scene>& atlas, const std::string& label,
                                                    span_of_time span) {
    std::vector<double> regrets;
    for (const atlas_scene& scene : atlas)
        if (const atlas_line* line = scene.find(label)) regrets.push_back(line->ms(span) / scene.least_ms(span));
    std::ranges::sort(regrets);
    return regrets;
}

/// The logarithm of the ratio of two lines. If their own repeats give no error, it is pooled from the repeats of all
/// lines of the scene; without any repeats the result is unknown.
[[nodiscard]] inline estimate log_ratio_in(const atlas_scene& scene, const atlas_line& arm, const atlas_line& base,
                                           span_of_time span) {
    const estimate of_repeats = log_ratio(arm, base, span);
    if (of_repeats.error > 0) return of_repeats;
    double squares = 0, degrees = 0;
    for (const atlas_line& line : scene.lines) {
        const std::vector<double>& times = line.times(span);
        const auto count = static_cast<double>(times.size());
        double mean = 0;
        for (const double ms : times) mean += std::log(ms) / count;
        for (const double ms : times) squares += (std::log(ms) - mean) * (std::log(ms) - mean);
        degrees += count - 1;
    }
    if (degrees == 0) return {std::nan(""), 0, 1};
    return {of_repeats.value, std::sqrt(2 * squares / degrees), degrees};
}

}  // namespace aabblab
