/// Compositions and engines whose effect on a trajectory is told.
module aabblab.stiff:method;

import aabb.std;
import aabblab.trials;

namespace aabblab {

struct method {
    std::string label;
    contender who;
};

/// The default composition but for these strategies, as the command line takes them: "triangle moller:epsilon=none".
[[nodiscard]] method composed(std::string_view changes);

/// Every triangle test of the registry in each of its forms, and each engine that collides meshes.
[[nodiscard]] std::vector<method> triangle_methods();
/// Every way in which a tree may be stored smaller.
[[nodiscard]] std::vector<method> tree_methods();
/// Lists of neighbours that are searched for again in time, and lists that are not.
[[nodiscard]] std::vector<method> list_methods();

}  // namespace aabblab
