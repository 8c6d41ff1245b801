/// Labels of an atlas, their regrets, and ratios with their errors.
module aabblab.atlas:labels;

import aabb.std;
import aabblab.atlas;
import aabblab.statistics;

namespace aabblab {

/// All labels, in the order of their first appearance.
[[nodiscard]] inline std::vector<std::string> labels_of(const std::vector<atlas_scene>& atlas) {
    std::vector<std::string> labels;
    for (const atlas_scene& scene : atlas)
        for (const atlas_candidate& candidate : scene.candidates)
            if (std::ranges::find(labels, candidate.label) == labels.end()) labels.push_back(candidate.label);
    return labels;
}

/// The strategies in a label without their parameters: "neighbour_list + bucket + columns + simd".
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
                                                    atlas_time time) {
    std::vector<double> regrets;
    for (const atlas_scene& scene : atlas)
        if (const atlas_candidate* candidate = scene.find(label))
            regrets.push_back(candidate->ms(time) / scene.least_ms(time));
    std::ranges::sort(regrets);
    return regrets;
}

/// The logarithm of the ratio of two candidates' times per frame in a scene. If their repeats give no error, since
/// early stopping left only one, the error is that of two times with the variance pooled over the repeats of all
/// candidates of the scene; the result is unknown (NaN) if none was repeated.
[[nodiscard]] inline estimate log_ratio_in(const atlas_scene& scene, const atlas_candidate& candidate,
                                           const atlas_candidate& baseline) {
    const estimate of_repeats = log_ratio(candidate, baseline);
    if (of_repeats.error > 0) return of_repeats;
    double squares = 0, degrees = 0;
    for (const atlas_candidate& any : scene.candidates) {
        const auto count = static_cast<double>(any.frame_ms.size());
        double mean = 0;
        for (const double ms : any.frame_ms) mean += std::log(ms) / count;
        for (const double ms : any.frame_ms) squares += (std::log(ms) - mean) * (std::log(ms) - mean);
        degrees += count - 1;
    }
    if (degrees == 0) return {std::nan(""), 0, 1};
    return {of_repeats.value, std::sqrt(2 * squares / degrees), degrees};
}

}  // namespace aabblab
