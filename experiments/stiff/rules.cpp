module;
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

module aabblab.stiff;

import :rules;

namespace aabblab {

std::string short_number(double value) {
    return fmt::format("{:.4g}", value);
}

stiff_row told(std::string subject, std::string quantity, double measured) {
    return {std::move(subject), std::move(quantity), measured, "", true};
}

stiff_row within(std::string subject, std::string quantity, double measured, double expected, double share) {
    return {std::move(subject), std::move(quantity), measured,
            fmt::format("{} ± {:.3g} %", short_number(expected), 100 * share),
            std::abs(measured - expected) <= share * std::abs(expected)};
}

stiff_row at_most(std::string subject, std::string quantity, double measured, double limit) {
    return {std::move(subject), std::move(quantity), measured, "≤ " + short_number(limit), measured <= limit};
}

stiff_row at_least(std::string subject, std::string quantity, double measured, double limit) {
    return {std::move(subject), std::move(quantity), measured, "≥ " + short_number(limit), measured >= limit};
}

}  // namespace aabblab
