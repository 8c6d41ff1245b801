/// Statements as they are written down.
module aabblab.atlas:statement;

import aabb.std;
import aabblab.atlas;
import aabblab.statistics;

namespace aabblab {

using scene_filter = std::function<bool(const atlas_scene&)>;

/// A time over another, over some scenes.
struct stated_ratio {
    std::string where;
    std::string arm;
    std::string base;
    scene_filter in;
    expectation expected = expectation::less;
    double band = equivalence_band;
    /// Where it is set, the ratio is over the same in these scenes: how much more it is here than there.
    scene_filter over = nullptr;
};

struct statement {
    std::string id;
    std::string source;
    std::string says;
    std::vector<stated_ratio> ratios;
};

[[nodiscard]] const std::vector<statement>& statements();

}  // namespace aabblab
