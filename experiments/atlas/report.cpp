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

/// The text above the table of cost models, with the regrets of relying on them in scenes held out from the fit.
std::string models_text(const std::vector<atlas_scene>& atlas, const std::vector<candidate_model>& models) {
    std::string text =
        "A linear model predicts the time per frame as a sum of costs per box, pair, inversion and so on, fitted to "
        "the scenes of the map. \"off by\" is the factor by which a prediction is too long or too short: its median "
        "and the worst. costs.csv has each cost with its interval.";
    std::vector<double> regrets = regrets_of_models(atlas, models);
    if (regrets.empty()) return text;
    return text + fmt::format(
                      " In the scenes that it was not fitted to, the candidate that it predicts to be the fastest "
                      "takes {:.2f} times as long as the fastest (median), {:.2f} at worst.",
                      quartiles_of(regrets).median, *std::ranges::max_element(regrets));
}

/// All sections of the atlas: a table each, with its title and text. Long tables are written to files only.
std::vector<section> sections_of(const std::vector<atlas_scene>& atlas) {
    const std::vector<border> borders = borders_of(atlas);
    const std::vector<atlas_scene> classic = without_columns(atlas);
    const std::vector<border> classic_borders = borders_of(classic);
    const std::vector<candidate_model> models = models_of(atlas);
    const std::vector<judged_statement> judged = judged_statements(atlas);
    std::vector<section> sections{
        {"The fastest",
         "By time per frame after the first. Shown: the interval of the ratio of the second fastest lies above 1. As "
         "fast: not significantly slower than the fastest.",
         "winners", winners_table(atlas)},
        {"The fastest without columns", "The same among candidates without columns and auto.", "winners_classic",
         winners_table(classic)},
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
         "A border is the value of one parameter, all others equal, at which the fastest of one scene and that of the "
         "next take the same time; it is interpolated between the logarithms of their ratios. The table has the "
         "geometric mean of the borders between the same two, with an interval that widens if scenes disagree, the "
         "least and the greatest. borders.csv has each border with its interval.",
         "borders_summary", borders_summary(borders)});
    sections.push_back({"Borders without columns", "", "borders_classic_summary", borders_summary(classic_borders)});
    sections.push_back({.file = "borders", .content = borders_table(borders), .is_shown = false});
    sections.push_back({.file = "borders_classic", .content = borders_table(classic_borders), .is_shown = false});
    sections.push_back({"Predicted times", models_text(atlas, models), "models", models_table(models)});
    sections.push_back({.file = "costs", .content = costs_table(models), .is_shown = false});
    sections.push_back({.file = "cells", .content = cells_table(atlas), .is_shown = false});
    sections.push_back(
        {"Published statements",
         "Statements are judged by the rule of the paper's claims: each ratio is a geometric mean over scenes, its "
         "interval widens if they disagree, and all are decided together. A ratio below 1 favours the statement.",
         "statements", statements_table(judged)});
    sections.push_back({"Ratios of the statements", "", "statement_ratios", ratios_table(judged)});
    return sections;
}

}  // namespace

/// Writes the atlas to a folder: figures, a CSV file per table, and the page as Markdown and HTML.
void write_atlas(const std::filesystem::path& folder, const std::vector<atlas_scene>& atlas) {
    const std::vector<section> sections = sections_of(atlas);
    const std::vector<figure> figures = atlas_figures(atlas);
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
