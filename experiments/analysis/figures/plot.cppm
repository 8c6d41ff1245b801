module;
#include <string>

/// gnuplot's command `plot` for all series.
module aabblab.figures:plot;

import :drawing;

namespace aabblab {

/// Functions that the command uses, which pick the points of a series from NAME.csv.
[[nodiscard]] std::string plot_functions(const drawing& d);

[[nodiscard]] std::string plot_command(const drawing& d);

}  // namespace aabblab
