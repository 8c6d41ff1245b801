#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "command_parser.hpp"
#include "commands.hpp"
#include "output.hpp"

#include "suite_report.hpp"

import aabb.extreme;
import aabblab.configs;
import aabblab.extreme;
import aabblab.files;
import aabblab.tables;

namespace aabblab {

namespace {

struct extreme_request {
    std::string cases = AABBLAB_CASES;
    std::optional<std::string> out;
    bool quick = false;
};

/// The tables that are told, with what stands above them.
std::vector<captioned_table> tables_of(const std::vector<extreme_row>& rows) {
    std::vector<captioned_table> all = {
        {"extreme_boxes", "Boxes: by the definition, in a double loop", scene_table(rows, row_group::boxes)},
        {"extreme_meshes", "Meshes: by CGAL's exact kernel on every two triangles; -missing +invented",
         scene_table(rows, row_group::meshes)},
        {"extreme_tests", "Meshes, by inexact triangle tests", inexact_scene_table(rows)},
        {"extreme_classes", "The same by class", class_table(rows)},
        {"extreme_cases", "Pairs of triangles that were found hard, by exact tests and as two meshes",
         case_table(rows)},
        {"extreme_case_tests", "The same by inexact triangle tests, in every order of corners, float and double",
         inexact_case_table(rows)}};
    std::erase_if(all, [](const captioned_table& t) { return t.content.rows.empty(); });
    return all;
}

int validate_extreme(const extreme_request& request) {
    outlive_reader();
    const std::filesystem::path folder =
        request.out.value_or(request.quick ? "results/extreme-quick" : "results/extreme");
    const suite_report report = play_extreme_suite(folder, request.cases, request.quick, true);
    print("\nEvery answer is in " + visible((folder / "extreme.csv").string()) + "\n");
    print(report.failures.empty() ? "All that must be exact is exact, and what must be refused is refused.\n"
                                  : std::to_string(report.failures.size()) + " answers are not what they must be.\n");
    return report.failures.empty() ? 0 : 1;
}

}  // namespace

std::string usual_cases() {
    return AABBLAB_CASES;
}

suite_report play_extreme_suite(const std::filesystem::path& folder, const std::string& cases, bool quick, bool shown) {
    const auto size = quick ? aabb::extreme_size::quick : aabb::extreme_size::full;
    const std::vector<aabb::triangle_case> hard = read_triangle_cases(cases);
    std::filesystem::create_directories(folder);  // before the work, which takes a while
    const extreme_list list = all_extreme_scenes(size);
    for (const std::string& sentence : list.notes) note(sentence);
    std::vector<extreme_row> rows = play_scenes(list.scenes, size);
    // What is finished stays, whatever happens afterwards.
    write_file(folder / "extreme.csv", to_csv(extreme_rows(rows)));
    for (extreme_row& row : play_cases(hard)) rows.push_back(std::move(row));
    suite_report report;
    report.tables = tables_of(rows);
    report.paragraphs = memory_in(rows, list.scenes);
    report.failures = failures_in(rows);
    write_file(folder / "extreme.csv", to_csv(extreme_rows(rows)));
    if (shown) {
        for (const captioned_table& t : report.tables)
            print(t.caption + "\n\n" + to_text(t.content, output_width()) + "\n");
        for (const std::string& sentence : report.paragraphs) print(sentence + "\n");
        print("\nRefused:\n");
        for (const std::string& sentence : refusals_in(rows)) print("  " + sentence + "\n");
    }
    for (const std::string& sentence : report.failures) note(sentence);
    return report;
}

void add_validate_extreme(const command_parser& validate, int& status) {
    const command_parser command = validate.add_command(
        "extreme",
        "Every composition and engine where exactness is hardest: extreme scenes, bad input, other arithmetic, and "
        "pairs of triangles that were found hard");
    command.footer([] {
        std::string text = "Scenes:\n";
        for (const aabb::extreme_scene& scene : all_extreme_scenes(aabb::extreme_size::full).scenes)
            text += entry(scene.name, scene.summary);
        return text.substr(0, text.size() - 1);  // the end of the line is printed behind it
    });
    auto request = std::make_shared<extreme_request>();
    command.add_option("--cases", request->cases, "Pairs of triangles (default validation/cases/triangles.toml)")
        .type_name("FILE");
    command
        .add_option("--out", request->out,
                    "Folder of extreme.csv (default results/extreme, with --quick results/extreme-quick)")
        .type_name("DIR");
    command.add_flag("--quick", request->quick, "Default parameters only, and fewer coincident triangles");
    command.callback([request, &status] { status = validate_extreme(*request); });
}

}  // namespace aabblab
