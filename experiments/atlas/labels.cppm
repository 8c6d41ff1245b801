module;
#include <string>
#include <vector>

/// What the parts of the atlas share.
module aabblab.atlas:map;

import aabblab.atlas;

namespace aabblab {

/// Everybody, in the order in which they play.
[[nodiscard]] inline std::vector<std::string> labels_of(const std::vector<atlas_scene>& atlas) {
    std::vector<std::string> labels;
    for (const atlas_scene& scene : atlas)
        for (const atlas_line& line : scene.lines) {
            bool known = false;
            for (const std::string& label : labels) known = known || label == line.label;
            if (!known) labels.push_back(line.label);
        }
    return labels;
}

}  // namespace aabblab
