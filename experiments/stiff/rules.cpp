module;
#include <fmt/format.h>

module aabblab.stiff;

import :rules;
import aabb.base;

namespace aabblab {

std::string short_number(double value) {
    return fmt::format("{:.4g}", value);
}

void unless_it_gives_up(stiff_result& result, std::string_view integrator, const std::function<void()>& part) {
    try {
        part();
    } catch (const aabb::input_error& error) {
        result.rows.push_back({error.what(), "gives up: " + std::string(integrator), 1, "never", false});
    }
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
