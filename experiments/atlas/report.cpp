module aabblab.atlas;

import aabblab.files;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.page;

namespace aabblab {

namespace {

struct section {
    std::string title{}, text{};
    std::string file;  ///< stem of the CSV file
    table content;
    bool is_shown = true;  ///< in the page; otherwise only in its file
};

/// All sections of the atlas: a table each, with its title and text. Long tables are written to files only.
std::vector<section> sections_of(const std::vector<atlas_scene>& atlas, const std::vector<border_law>& laws) {
    const std::vector<judged_statement> judged = judged_statements(atlas);
    std::vector<section> sections{
        {"The fastest",
         "By processor time per frame after the first. Shown: the interval of the ratio of the second fastest lies "
         "above 1. As "
         "fast: not significantly slower than the fastest.",
         "winners", winners_table(atlas)},
        {"The fastest without columns", "The same among candidates without columns and auto.", "winners_classic",
         winners_table(without_columns(atlas))},
        {"Regret of using one everywhere",
         "The time per frame relative to that of the fastest of each scene. Candidates that early stopping "
         "ended have a single repeat.",
         "regrets", regrets_table(atlas, atlas_time::per_frame)},
        {"The same with the first frame and the construction",
         "By the time of all frames. Scenes are short, so the first frame matters: insertion sort takes quadratic time "
         "in it.",
         "regrets_whole", regrets_table(atlas, atlas_time::whole_run)}};
    std::vector<atlas_scene> held_out;
    std::ranges::copy_if(atlas, std::back_inserter(held_out), &atlas_scene::is_held_out);
    if (!held_out.empty())
        sections.push_back({"The same per frame, in the scenes outside the map", "", "regrets_unseen",
                            regrets_table(held_out, atlas_time::per_frame)});
    sections.push_back(
        {"Borders",
         "A border is the value of one parameter, all others equal, at which two candidates take the same time, "
         "interpolated between the logarithms of their ratios. A law predicts it by least squares from terms of the "
         "scene: " +
             std::string(legend_of_laws) +
             " The factor is that of the 95 % prediction interval, by Student's t. Unseen borders are of scenes drawn "
             "with another seed, to which no law was fitted. A Verlet list's time includes that of the first frame. "
             "borders.csv has each border with its interval.",
         "border_laws", laws_table(laws)});
    sections.push_back({.file = "border_coefficients", .content = coefficients_table(laws), .is_shown = false});
    sections.push_back({.file = "borders", .content = borders_table(laws), .is_shown = false});
    sections.push_back({.file = "cells", .content = cells_table(atlas), .is_shown = false});
    sections.push_back(
        {"Published statements",
         "Statements are judged by the rule of the paper's claims: each ratio is a geometric mean over scenes, its "
         "interval widens if they disagree, and all are decided together. A ratio below 1 favours the statement. A "
         "verdict on a proxy is one on what was played, which is not what the source describes.",
         "statements", statements_table(judged)});
    sections.push_back({"Ratios of the statements", "", "statement_ratios", ratios_table(judged)});
    return sections;
}

}  // namespace

/// Writes the atlas to a folder: figures, a CSV file per table, and the page as Markdown and HTML.
void write_atlas(const std::filesystem::path& folder, const std::vector<atlas_scene>& atlas,
                 const std::vector<border_law>& laws) {
    const std::vector<section> sections = sections_of(atlas, laws);
    std::vector<figure> figures = atlas_figures(atlas);
    std::ranges::move(border_figures(laws), std::back_inserter(figures));
    std::filesystem::create_directories(folder);
    draw(folder / "figures", figures);
    constexpr const char* title = "Atlas of broad phases (global search)";
    page out(title);
    out.title(title);
    const auto held_out = static_cast<std::size_t>(std::ranges::count_if(atlas, &atlas_scene::is_held_out));
    out.paragraph(
        fmt::format("{} scenes of the map, {} other scenes.", grouped(atlas.size() - held_out), grouped(held_out)));
    for (const figure& f : figures) out.add(f);
    for (const section& s : sections) {
        write_file(folder / (s.file + ".csv"), to_csv(s.content));
        if (!s.is_shown) continue;
        out.heading(s.title);
        if (!s.text.empty()) out.paragraph(s.text);
        out.add(s.content);
    }
    write_file(folder / "atlas.md", out.markdown());
    write_file(folder / "atlas.html", out.html());
}

}  // namespace aabblab
