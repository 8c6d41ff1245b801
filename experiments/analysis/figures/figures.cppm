/// Figures for a paper: readable in black and white, and by the colour-blind.
export module aabblab.figures;

import aabb.std;

export import :figure;

export namespace aabblab {

/// Writes NAME.csv (the points), NAME.svg and NAME.pdf into the folder, which it makes. The same figures give the same
/// bytes.
/// @throws aabb::input_error where a file cannot be written.
void draw(const std::filesystem::path& folder, std::span<const figure> figures);

/// The text of NAME.csv: a line a point, with the number of its series, from 1.
[[nodiscard]] std::string csv_of(const figure& f);

[[nodiscard]] std::string svg_of(const figure& f);
[[nodiscard]] std::string pdf_of(const figure& f);

}  // namespace aabblab
