module;
#include <fmt/format.h>

module aabblab.digits;

namespace aabblab {

std::string fifteen_digits(double value) {
    return fmt::format("{:.15g}", value);
}

double whole_nanoseconds(double ms) {
    return std::round(ms * 1e6) / 1e6;
}

}  // namespace aabblab
