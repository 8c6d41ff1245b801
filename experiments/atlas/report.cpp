module aabblab.atlas;

import aabblab.files;
import aabblab.fmt;
import aabblab.numbers;
import aabblab.page;

namespace aabblab {

namespace {

struct section {
    std::string title;
    std::string text;
    std::string file;  ///< stem of the CSV file
    table content;
    bool shown = true;  ///< in the page; otherwise only in its file
};

std::vector<atlas_scene> of_map(const std::vector<atlas_scene>& atlas, bool unseen) {
    std::vector<atlas_scene> selected;
    std::ranges::copy_if(atlas, std::back_inserter(selected), [&](const atlas_scene& s) { return s.unseen == unseen; });
    return selected;
}

std::string models_text(const std::vector<atlas_scene>& atlas, const std::vector<line_model>& models) {
    std::string text =
        "A frame's time as a sum of costs, of boxes, of pairs, of inversions and more as the scene's measures have "
        "them, fitted to the map: how many times too long or too short it is, the median and the worst. Each cost has "
        "its interval in costs.csv.";
    std::vector<double> regrets = regrets_of_models(atlas, models);
    if (regrets.empty()) return text;
    return text + fmt::format(
                      " Whoever it predicts to be the fastest, in the scenes that it was not fitted to, takes "
                      "{:.2f} times as long as who is, a median; {:.2f} at worst.",
                      quartiles_of(regrets).median, *std::ranges::max_element(regrets));
}

std::vector<section> sections_of(const std::vector<atlas_scene>& atlas) {
    const std::vector<border> borders = borders_of(atlas);
    const std::vector<atlas_scene> classic = without_columns(atlas);
    const std::vector<border> classic_borders = borders_of(classic);
    const std::vector<line_model> models = models_of(atlas);
    const std::vector<judged_statement> judged = judged_statements(atlas);
    std::vector<section> sections{
        {"Who wins",
         "Of a frame after the first. Shown: the interval of the ratio of the next fastest lies above 1. As fast: not "
         "shown to be slower than the fastest.",
         "winners", winners_table(atlas)},
        {"Who wins without columns", "The same among those that have neither columns nor auto.", "winners_classic",
         winners_table(classic)},
        {"What it costs to use one everywhere",
         "The time of a frame over that of the fastest of each scene; who was not repeated has one repeat.", "regrets",
         regrets_table(atlas, span_of_time::frame)},
        {"The same with the first frame and the making",
         "Of all frames, as short as the scenes are; sorting by insertion takes quadratic time in the first.",
         "regrets_whole", regrets_table(atlas, span_of_time::whole)}};
    if (const auto unseen = of_map(atlas, true); !unseen.empty())
        sections.push_back({"The same of a frame, in the scenes that the map does not hold", "", "regrets_unseen",
                            regrets_table(unseen, span_of_time::frame)});
    sections.push_back(
        {"Borders",
         "Along one parameter, all others equal: where the fastest of one scene and that of the next take "
         "the same time, on a line between the logarithms of their ratios; the geometric mean, with an "
         "interval that widens where scenes disagree, the least and the greatest. Each border has its "
         "interval in borders.csv.",
         "borders_summary", borders_summary(borders)});
    sections.push_back({"Borders without columns", "", "borders_classic_summary", borders_summary(classic_borders)});
    sections.push_back({"", "", "borders", borders_table(borders), false});
    sections.push_back({"", "", "borders_classic", borders_table(classic_borders), false});
    sections.push_back({"Predicted times", models_text(atlas, models), "models", models_table(models)});
    sections.push_back({"", "", "costs", costs_table(models), false});
    sections.push_back({"", "", "cells", cells_table(atlas), false});
    sections.push_back(
        {"Statements of others",
         "Judged as the paper's claims are: each ratio is a geometric mean over scenes, its interval widens "
         "where they disagree, and all are decided together. Below 1 favours the statement.",
         "statements", statements_table(judged)});
    sections.push_back({"Their ratios", "", "statement_ratios", ratios_table(judged)});
    return sections;
}

std::string heading_of(const std::vector<atlas_scene>& atlas) {
    const auto unseen = static_cast<std::size_t>(std::ranges::count_if(atlas, &atlas_scene::unseen));
    return fmt::format("{} scenes of the map, {} others", grouped(atlas.size() - unseen), grouped(unseen));
}

}  // namespace

void write_atlas(const std::filesystem::path& folder, const std::vector<atlas_scene>& atlas) {
    const std::vector<section> sections = sections_of(atlas);
    const std::vector<figure> figures = atlas_figures(atlas);
    std::filesystem::create_directories(folder);
    draw(folder / "figures", figures);
    constexpr const char* title = "Atlas of global search";
    page out(title);
    out.title(title);
    out.paragraph(heading_of(atlas) + ".");
    for (const figure& f : figures) out.add(f);
    for (const section& s : sections) {
        write_file(folder / (s.file + ".csv"), to_csv(s.content));
        if (!s.shown) continue;
        out.heading(s.title);
        if (!s.text.empty()) out.paragraph(s.text);
        out.add(s.content);
    }
    write_file(folder / "atlas.md", out.markdown());
    write_file(folder / "atlas.html", out.html());
}

}  // namespace aabblab
