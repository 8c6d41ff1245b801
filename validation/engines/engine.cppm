/// What a file in NAME/ says of the engine NAME; seen by this module only.
module aabb.engines:engine;

import aabb.pipeline;
import aabb.std;

namespace aabb {

/// A triangle test of an engine's library, without its type.
struct library_test {
    std::string name;
    std::string summary;
    bool exact;
    std::vector<parameter_info> parameters;
    std::unique_ptr<triangle_test> (*make)(std::span<const setting> settings);
};

/// @tparam Test written like a strategy of the kind triangle
template <class Test>
[[nodiscard]] library_test library_test_of() {
    return {std::string(Test::name), std::string(Test::summary), strategy_is_exact<Test>, parameters_of<Test>(),
            [](std::span<const setting> settings) -> std::unique_ptr<triangle_test> {
                return std::make_unique<tested_by<Test>>(make_strategy<Test>(configured<Test>(settings)));
            }};
}

/// What the function NAME_engine() of each engine returns.
struct engine {
    std::string name;
    std::string summary;
    bool exact = true;                                   ///< its pair sets equal the exact ones on every input
    std::unique_ptr<global_stage> (*boxes)() = nullptr;  ///< null where it cannot stand in for global search
    std::unique_ptr<local_stage> (*meshes)() = nullptr;  ///< null where it cannot stand in for local detection
    std::vector<library_test> triangles = {};            ///< tests that its library has
};

/// @tparam Arguments of its constructor
template <class Stage, class Engine, auto... Arguments>
[[nodiscard]] std::unique_ptr<Stage> made() {
    return std::make_unique<Engine>(Arguments...);
}

/// Those that this build has, in the order of their lines in CMakeLists.txt. Defined in a generated unit.
[[nodiscard]] std::vector<engine> built_engines();

}  // namespace aabb
