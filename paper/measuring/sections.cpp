module;
#include <fmt/format.h>

module aabblab.measuring;

import aabblab.atlas;
import aabblab.errors;
import aabblab.record;
import aabblab.results;
import aabblab.suites;
import aabblab.tables;

namespace aabblab {

namespace {

/// Error against run time, from the results of the studies that are there.
report_section errors_section(const std::filesystem::path& folder, bool quick) {
    report_section section{
        .id = "errors",
        .title = "Error against run time",
        .paragraphs = {"Beyond the paper: what methods get wrong, and what that saves. Every answer is held against "
                       "the exact one; a method that gets nothing wrong stands at one wrong answer in all."},
        .figures = {},
        .tables = {}};
    for (const error_study& study : studies_with_curves(quick)) {
        const std::filesystem::path results = folder_of_study(folder, study);
        if (!study.whole && std::filesystem::exists(results / "errors.csv")) {
            const std::vector<error_point> points = read_error_rows(results / "errors.csv");
            for (const pair_group group : groups_in(points)) {
                section.paragraphs.push_back(group_statement(points, group));
                section.figures.push_back(group_figure(points, group));
                section.tables.push_back(
                    {section.figures.back().name,
                     fmt::format("In {}: shares of pairs with a wrong answer, of intersecting ones that were missed, "
                                 "of others that were invented.",
                                 title_of(group)),
                     error_summary(points, group)});
            }
        } else if (study.whole && std::filesystem::exists(results / "results.csv")) {
            const std::vector<scene_summary> scenes = summarise(verified_rows(results));
            std::ranges::copy(metric_statements(study, scenes), std::back_inserter(section.paragraphs));
            std::ranges::copy(metric_figures(study, scenes), std::back_inserter(section.figures));
            for (const scene_summary& scene : scenes)
                section.tables.push_back({fmt::format("{}_{}", study.name, &scene - scenes.data() + 1),
                                          heading_of(scene), table_of(scene, study.whole->shown)});
        }
    }
    return section;
}

/// Of a suite, where it was played.
std::optional<report_section> suite_section(const std::filesystem::path& folder, const std::string& suite,
                                            const std::string& title, const std::string& about) {
    if (!std::filesystem::exists(file_of_suite(folder, suite))) return std::nullopt;
    suite_report report = kept_report(file_of_suite(folder, suite));
    report_section section{suite, title, {about}, std::move(report.figures), std::move(report.tables)};
    std::ranges::move(report.paragraphs, std::back_inserter(section.paragraphs));
    return section;
}

/// The small atlas, where it was measured.
std::optional<report_section> atlas_section(const std::filesystem::path& folder) {
    const std::vector<atlas_scene> atlas = measured_atlas(folder_of_atlas(folder));
    if (atlas.empty()) return std::nullopt;
    return report_section{
        "atlas",
        "Atlas of global search",
        {fmt::format("Beyond the paper: which composition or engine is the fastest in each of {} small scenes. "
                     "`./aabblab atlas` plays the whole atlas, and judges statements of others on it.",
                     atlas.size())},
        atlas_figures(atlas),
        {{"winners", "Who wins a frame after the first.", winners_table(atlas)},
         {"regrets", "What it costs to use one everywhere: a frame's time over that of the fastest of each scene.",
          regrets_table(atlas, span_of_time::frame)},
         {"regrets_whole", "The same of all frames, the first and the making included.",
          regrets_table(atlas, span_of_time::whole)}}};
}

}  // namespace

std::vector<report_section> sections_of_reproduction(const std::filesystem::path& folder, bool quick) {
    std::vector<report_section> sections;
    if (report_section errors = errors_section(folder, quick); !errors.figures.empty())
        sections.push_back(std::move(errors));
    if (auto extreme =
            suite_section(folder, "extreme", "Extreme scenes",
                          "Beyond the paper: every composition and engine where exactness is hardest, exact, "
                          "refused with the reason, or wrong."))
        sections.push_back(*std::move(extreme));
    if (auto stiff = suite_section(folder, "stiff", "Stiff scenes",
                                   "Beyond the paper: bodies stepped in time, pushed by the contacts that are found, "
                                   "and held against closed forms and published results."))
        sections.push_back(*std::move(stiff));
    if (auto atlas = atlas_section(folder)) sections.push_back(*std::move(atlas));
    return sections;
}

}  // namespace aabblab
