/// Rules that verdicts follow.
module aabblab.stiff:rules;

import aabb.std;
import :study;

namespace aabblab {

[[nodiscard]] stiff_row told(std::string subject, std::string quantity, double measured);
/// Measured differs from `expected` by no more than `share` of it.
[[nodiscard]] stiff_row within(std::string subject, std::string quantity, double measured, double expected,
                               double share);
[[nodiscard]] stiff_row at_most(std::string subject, std::string quantity, double measured, double limit);
[[nodiscard]] stiff_row at_least(std::string subject, std::string quantity, double measured, double limit);

/// Plays one part of a study. Where an integrator gives up, that is a row which does not hold.
void unless_it_gives_up(stiff_result& result, std::string_view integrator, const std::function<void()>& part);

/// "0.05", with as many digits as it needs.
[[nodiscard]] std::string short_number(double value);

}  // namespace aabblab
