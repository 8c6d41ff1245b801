module;
#include <algorithm>
#include <string>
#include <vector>

/// Who plays in an atlas, and what it costs to use one of them everywhere.
module aabblab.atlas:labels;

import aabblab.atlas;

namespace aabblab {

/// Everybody, in the order in which they play.
[[nodiscard]] inline std::vector<std::string> labels_of(const std::vector<atlas_scene>& atlas) {
    std::vector<std::string> labels;
    for (const atlas_scene& scene : atlas)
        for (const atlas_line& line : scene.lines)
            if (std::ranges::find(labels, line.label) == labels.end()) labels.push_back(line.label);
    return labels;
}

/// Times over those of the fastest, of each scene that it plays, in ascending order.
[[nodiscard]] inline std::vector<double> regrets_of(const std::vector<atlas_scene>& atlas, const std::string& label,
                                                    span_of_time of) {
    std::vector<double> regrets;
    for (const atlas_scene& scene : atlas)
        if (const atlas_line* line = scene.find(label))
            // auto may be faster than whoever it is held against.
            regrets.push_back(std::max(1.0, line->ms(of) / scene.fastest(of).ms(of)));
    std::ranges::sort(regrets);
    return regrets;
}

}  // namespace aabblab
