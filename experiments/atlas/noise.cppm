/// How sure ratios are of which there is one only.
module aabblab.atlas:noise;

import aabb.std;
import aabblab.atlas;
import aabblab.statistics;

namespace aabblab {

/// Of two lines of a scene. Where both have one repeat, repeats of others say how much they differ; nothing is known
/// where those have one too.
[[nodiscard]] inline estimate log_ratio_in(const atlas_scene& scene, const atlas_line& arm, const atlas_line& base,
                                           span_of_time of) {
    const estimate one = log_ratio(arm, base, of);
    if (one.error > 0) return one;
    double squares = 0;
    double degrees = 0;
    for (const atlas_line& line : scene.lines) {
        const std::vector<double>& times = line.times(of);
        const auto count = static_cast<double>(times.size());
        double mean = 0;
        for (const double ms : times) mean += std::log(ms) / count;
        for (const double ms : times) squares += (std::log(ms) - mean) * (std::log(ms) - mean);
        degrees += count - 1;
    }
    if (degrees == 0) return {std::nan(""), 0, 1};
    return {one.value, std::sqrt(2 * squares / degrees), degrees};
}

}  // namespace aabblab
