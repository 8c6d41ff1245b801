/// The description of an engine, which a file in NAME/ returns; internal to the module.
module aabb.engines:engine;

import aabb.pipeline;
import aabb.std;

namespace aabb {

/// A type-erased triangle test of an engine's library.
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
    bool exact = true;                                   ///< its pair sets equal the ground truth for all input
    std::unique_ptr<global_stage> (*boxes)() = nullptr;  ///< null if it has no broad phase
    std::unique_ptr<local_stage> (*meshes)() = nullptr;  ///< null if it has no narrow phase
    std::vector<library_test> triangles = {};            ///< the tests of its library
};

/// @tparam Arguments the arguments of the engine's constructor
template <class Stage, class Engine, auto... Arguments>
[[nodiscard]] std::unique_ptr<Stage> make_stage() {
    return std::make_unique<Engine>(Arguments...);
}

/// The engines of this build, in the order of CMakeLists.txt. Defined in a generated unit.
[[nodiscard]] std::vector<engine> built_engines();

}  // namespace aabb
