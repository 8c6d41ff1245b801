/// What is played to measure costs.
module aabblab.calibrate:trial;

import aabb.costs;
import aabb.std;
import aabblab.calibrate;

namespace aabblab {

/// Costs that are fitted together, since the same plays tell them.
enum class cost_group : unsigned char { lists, cut, columns, median, sah, queries };

struct cost_group_info {
    std::string_view name;
    std::vector<double aabb::cost_model::*> costs;  ///< the first kinds of work; others are fitted beside them
};
[[nodiscard]] const std::array<cost_group_info, 6>& cost_groups();

/// A part of a play whose work is all of one group.
struct piece {
    cost_group group;
    std::vector<double> work;
};

/// One way to play one scene.
struct trial {
    std::string scene;
    bool held_out;  ///< not fitted to, but to check
    /// Counts the work of each piece.
    std::function<std::vector<piece>()> count;
    /// Nanoseconds of each, in the same order.
    std::function<std::vector<double>()> time;
};

[[nodiscard]] std::vector<trial> box_trials(calibration_size size);
[[nodiscard]] std::vector<trial> mesh_trials(calibration_size size);

}  // namespace aabblab
