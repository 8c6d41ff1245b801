module;
#include <string>

/// gnuplot's command `plot` for all series of a panel.
module aabblab.figures:plot;

import :drawing;

namespace aabblab {

/// Functions that the command uses, which pick the points of a series from NAME.csv.
[[nodiscard]] std::string plot_functions(const drawing& d);

/// @param with_legend whether the legend is drawn by it
[[nodiscard]] std::string plot_command(const drawing& d, const shown_panel& panel, bool with_legend);

}  // namespace aabblab
