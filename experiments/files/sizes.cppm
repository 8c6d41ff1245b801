module;
#include <array>
#include <string>

/// Numbers of bytes in sentences.
module aabblab.files:sizes;

namespace aabblab {

/// Two sizes, each in a unit that fits it; in bytes where they would look alike.
[[nodiscard]] std::array<std::string, 2> different_sizes(double a, double b);

}  // namespace aabblab
