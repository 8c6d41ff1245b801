/// Says what is wrong with lists of external engines.
module aabblab.suites:wrong_lists;

import aabb.std;
import aabblab.configs;
import aabblab.trials;

namespace aabblab {

/// Notes what `check` says of each list that differs from the ground truth, and how to have the smallest scene in which
/// it does; and keeps the list in the folder of the results.
/// @param scene its index in the experiment
/// @param candidates those that have run on it
void report_wrong_lists(const experiment& e, std::size_t scene, std::span<const candidate> candidates,
                        const std::filesystem::path& folder);

}  // namespace aabblab
