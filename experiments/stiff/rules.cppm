module;
#include <string>

/// Rules that verdicts follow.
module aabblab.stiff:rules;

import :study;

namespace aabblab {

[[nodiscard]] stiff_row told(std::string subject, std::string quantity, double measured);
/// Measured differs from `expected` by no more than `share` of it.
[[nodiscard]] stiff_row within(std::string subject, std::string quantity, double measured, double expected,
                               double share);
[[nodiscard]] stiff_row at_most(std::string subject, std::string quantity, double measured, double limit);
[[nodiscard]] stiff_row at_least(std::string subject, std::string quantity, double measured, double limit);

/// "0.05", with as many digits as it needs.
[[nodiscard]] std::string short_number(double value);

}  // namespace aabblab
