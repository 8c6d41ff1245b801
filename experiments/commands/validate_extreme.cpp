#include <CLI/CLI.hpp>

#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "commands.hpp"
#include "output.hpp"

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

void print_table(const std::string& heading, const table& t) {
    if (!t.rows.empty()) print(heading + "\n\n" + to_text(t, output_width()) + "\n");
}

void print_tables(const std::vector<extreme_row>& rows) {
    print_table("Boxes: by the definition, in a double loop", scene_table(rows, row_group::boxes));
    print_table("Meshes: by CGAL's exact kernel on every two triangles; -missing +invented",
                scene_table(rows, row_group::meshes));
    print_table("Meshes, by inexact triangle tests", inexact_scene_table(rows));
    print_table("The same by class", class_table(rows));
    print_table("Pairs of triangles that were found hard, by exact tests and as two meshes", case_table(rows));
    print_table("The same by inexact triangle tests, in every order of corners, float and double",
                inexact_case_table(rows));
}

int validate_extreme(const extreme_request& request) {
    outlive_reader();
    const auto size = request.quick ? aabb::extreme_size::quick : aabb::extreme_size::full;
    const std::vector<aabb::triangle_case> cases = read_triangle_cases(request.cases);
    const std::filesystem::path folder =
        request.out.value_or(request.quick ? "results/extreme-quick" : "results/extreme");
    std::filesystem::create_directories(folder);  // before the work, which takes a while
    const extreme_list list = all_extreme_scenes(size);
    for (const std::string& sentence : list.notes) note(sentence);
    std::vector<extreme_row> rows = play_scenes(list.scenes, size);
    for (extreme_row& row : play_cases(cases)) rows.push_back(std::move(row));
    print_tables(rows);
    for (const std::string& sentence : memory_in(rows, list.scenes)) print(sentence + "\n");
    print("\nRefused:\n");
    for (const std::string& sentence : refusals_in(rows)) print("  " + sentence + "\n");
    write_file(folder / "extreme.csv", to_csv(extreme_rows(rows)));
    const std::vector<std::string> failures = failures_in(rows);
    for (const std::string& sentence : failures) note(sentence);
    print("\nEvery answer is in " + visible((folder / "extreme.csv").string()) + "\n");
    print(failures.empty() ? "All that must be exact is exact, and what must be refused is refused.\n"
                           : std::to_string(failures.size()) + " answers are not what they must be.\n");
    return failures.empty() ? 0 : 1;
}

}  // namespace

void add_validate_extreme(CLI::App& validate, int& status) {
    auto* command = validate.add_subcommand(
        "extreme",
        "Every composition and engine where exactness is hardest: extreme scenes, bad input, other arithmetic, and "
        "pairs of triangles that were found hard");
    command->footer([] {
        table t{{{"Scenes:", false}, {"", false}}, {}};
        for (const aabb::extreme_scene& scene : all_extreme_scenes(aabb::extreme_size::full).scenes)
            t.rows.push_back({scene.name, scene.summary});
        const std::string text = to_text(t);
        return text.substr(0, text.size() - 1);  // the end of the line is printed behind it
    });
    auto request = std::make_shared<extreme_request>();
    command->add_option("--cases", request->cases, "Pairs of triangles (default validation/cases/triangles.toml)")
        ->type_name("FILE");
    command->add_option("--out", request->out, "Folder of extreme.csv (default results/extreme)")->type_name("DIR");
    command->add_flag("--quick", request->quick, "Default parameters only, and fewer coincident triangles");
    command->callback([request, &status] { status = validate_extreme(*request); });
}

}  // namespace aabblab
