/// Who plays.
module aabblab.extreme:contenders;

import aabb.pipeline;
import aabb.registry;
import aabb.std;

namespace aabblab {

/// Every combination of a stage that makes sense, exact ones only; with each value of those parameters that have names
/// for their values, where that is asked for.
[[nodiscard]] std::vector<aabb::composition> exact_compositions(aabb::stage stage, bool named_values);

/// The usual local detection with each triangle test that is inexact.
[[nodiscard]] std::vector<aabb::composition> inexact_compositions();

struct named_test {
    std::string name;
    bool exact;
    bool usual;  ///< without settings
    std::unique_ptr<aabb::triangle_test> test;
};
/// Strategies with each named value of their parameters, and tests of libraries.
[[nodiscard]] std::vector<named_test> all_triangle_tests();

}  // namespace aabblab
