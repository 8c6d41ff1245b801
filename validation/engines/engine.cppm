/// What a file in NAME/ says of the engine NAME; seen by this module only.
module aabb.engines:engine;

import aabb.pipeline;
import aabb.std;
import :library_test;

namespace aabb {

/// What the function NAME_engine() of each engine returns.
struct engine {
    std::string name;
    std::string summary;
    bool exact = false;                                  ///< its pair sets equal the exact ones on every input
    std::unique_ptr<global_stage> (*boxes)() = nullptr;  ///< null where it cannot stand in for global search
    std::unique_ptr<local_stage> (*meshes)() = nullptr;  ///< null where it cannot stand in for local detection
    std::vector<library_test> triangles = {};            ///< tests that its library has
};

/// Those that this build has, in the order of their lines in CMakeLists.txt. Defined in a generated unit.
[[nodiscard]] std::vector<engine> built_engines();

}  // namespace aabb
