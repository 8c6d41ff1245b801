/// Choices of a strategy as configs write them.
module aabblab.configs:choices;

import :document;
import aabb.policy;
import aabb.std;

namespace aabblab {

/// @throws aabb::input_error where there is no such choice.
using choice_check = std::function<void(const aabb::strategy_choice&)>;

/// A name, a table of a name and parameters, whose lists multiply, or a list of both.
/// @param example a name that there is
[[nodiscard]] std::vector<aabb::strategy_choice> choices_of(const document& doc, const node& value,
                                                            const std::string& example, const choice_check& require);

}  // namespace aabblab
