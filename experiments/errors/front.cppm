/// What the figures of errors share.
module aabblab.errors:front;

import aabb.std;

namespace aabblab {

/// Two numbers of a method; less is better in both.
using cost = std::array<double, 2>;

/// Those that nothing else is better than in one number and at least as good in the other, by the first; of equal ones
/// one.
[[nodiscard]] std::vector<std::size_t> front_of(std::span<const cost> costs);

/// A text as part of the name of a file.
[[nodiscard]] std::string file_name(std::string text);

}  // namespace aabblab
