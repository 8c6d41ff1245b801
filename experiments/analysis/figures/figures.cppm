module;
#include <filesystem>
#include <span>
#include <string>

/// Figures for a paper, drawn by gnuplot: readable in black and white, and by the colour-blind.
export module aabblab.figures;

export import :figure;

export namespace aabblab {

/// Writes NAME.csv (the points), NAME.gp (a gnuplot script that draws them, to be changed and run again by whoever
/// wants another look), NAME.svg and NAME.pdf into the folder, which it makes. The same figures give the same
/// bytes, but for a date that newer versions of cairo hide in a compressed part of the PDF.
/// @throws aabb::input_error where a file cannot be written, or gnuplot is not there or fails.
void draw(const std::filesystem::path& folder, std::span<const figure> figures);

/// The text of NAME.csv: a line a point, with the number of its series, from 1.
[[nodiscard]] std::string csv_of(const figure& f);

/// The text of NAME.gp.
[[nodiscard]] std::string script_of(const figure& f);

}  // namespace aabblab
