module;
#include <array>
#include <cstddef>
#include <string>
#include <string_view>

/// What tells series apart: a colour, and for black and white a dash and a point of its own.
module aabblab.figures:look;

namespace aabblab {

/// Okabe and Ito's colours for every eye, without their yellow, which white paper swallows, and with a grey.
inline constexpr std::array<std::string_view, 8> colours = {"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                                            "#E69F00", "#56B4E9", "#000000", "#8C8C8C"};

/// In gnuplot's terms: lengths of dash, gap, dash, gap.
inline constexpr std::array<std::string_view, 10> dashes = {
    "solid", "(10,4)", "(3,3)", "(12,3,3,3)", "(20,5)", "(12,3,3,3,3,3)", "(6,3)", "(20,4,3,4)", "(2,5)", "(12,4,6,4)"};

/// In gnuplot's numbers, shape by shape as far apart as they are: discs, open squares, triangles, …
inline constexpr std::array<int, 10> shapes = {7, 4, 9, 12, 5, 6, 11, 2, 13, 8};

/// The sizes that make these shapes look equally large.
inline constexpr std::array<double, 10> shape_sizes = {0.6, 0.7, 0.8, 0.9, 0.6, 0.7, 0.8, 0.7, 0.8, 0.8};

}  // namespace aabblab
