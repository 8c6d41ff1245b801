/// Rules that derive verdicts from measurements.
module aabblab.stiff:rules;

import aabb.base;
import aabb.std;
import aabblab.fmt;
import aabblab.stiff;

namespace aabblab {

/// Up to four significant digits: "0.05".
[[nodiscard]] std::string short_number(double value) {
    return fmt::format("{:.4g}", value);
}

/// Runs one part of a study. If an integrator fails, it adds a row that does not hold.
void run_or_record_failure(stiff_result& result, std::string_view integrator, const std::function<void()>& part) {
    try {
        part();
    } catch (const aabb::input_error& error) {
        result.add({error.what(), std::string(integrator) + " cannot go on", 1, "never", stiff_verdict::fails});
    }
}

[[nodiscard]] stiff_row reported(std::string subject, std::string quantity, double measured) {
    return {std::move(subject), std::move(quantity), measured, ""};
}

[[nodiscard]] stiff_verdict verdict_if(bool holds) {
    return holds ? stiff_verdict::holds : stiff_verdict::fails;
}

/// A row that holds if the relative error is within the tolerance.
[[nodiscard]] stiff_row within(std::string subject, std::string quantity, double measured, double expected,
                               double relative_tolerance) {
    return {std::move(subject),
            std::move(quantity),
            measured,
            fmt::format("{} ± {:.3g} %", short_number(expected), 100 * relative_tolerance),
            verdict_if(std::abs(measured - expected) <= relative_tolerance * std::abs(expected)),
            expected};
}

[[nodiscard]] stiff_row at_most(std::string subject, std::string quantity, double measured, double limit) {
    return {std::move(subject), std::move(quantity), measured, "≤ " + short_number(limit),
            verdict_if(measured <= limit)};
}

[[nodiscard]] stiff_row at_least(std::string subject, std::string quantity, double measured, double limit) {
    return {std::move(subject), std::move(quantity), measured, "≥ " + short_number(limit),
            verdict_if(measured >= limit)};
}

[[nodiscard]] stiff_row between(std::string subject, std::string quantity, double measured, double least,
                                double greatest) {
    return {std::move(subject), std::move(quantity), measured, short_number(least) + " to " + short_number(greatest),
            verdict_if(least <= measured && measured <= greatest)};
}

/// The row if its expectation applies to its subject; otherwise the value is only reported.
[[nodiscard]] stiff_row expected_if(bool applies, stiff_row row) {
    return applies ? std::move(row) : reported(std::move(row.subject), std::move(row.quantity), row.measured);
}

}  // namespace aabblab
