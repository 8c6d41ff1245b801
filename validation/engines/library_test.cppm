module aabb.engines:library_test;

import aabb.pipeline;
import aabb.policy;
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

}  // namespace aabb
