module aabblab.suites;

import aabb.extreme;
import aabblab.extreme;
import aabblab.files;
import aabblab.output;

namespace aabblab {

namespace {

/// The tables that are told, with what stands above them.
std::vector<named_table> tables_of(const std::vector<extreme_row>& rows) {
    std::vector<named_table> all = {
        {"extreme_boxes", "Boxes: by the definition, in a double loop", scene_table(rows, row_group::boxes)},
        {"extreme_meshes", "Meshes: by CGAL's exact kernel on every two triangles; -missing +invented",
         scene_table(rows, row_group::meshes)},
        {"extreme_tests", "Meshes, by inexact triangle tests", inexact_scene_table(rows)},
        {"extreme_classes", "The same by class", class_table(rows)},
        {"extreme_cases", "Pairs of triangles that were found hard, by exact tests and as two meshes",
         case_table(rows)},
        {"extreme_case_tests", "The same by inexact triangle tests, in every order of corners, float and double",
         inexact_case_table(rows)}};
    std::erase_if(all, [](const named_table& t) { return t.content.rows.empty(); });
    return all;
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
        for (const named_table& t : report.tables)
            print(t.caption + "\n\n" + to_text(t.content, output_width()) + "\n");
        for (const std::string& sentence : report.paragraphs) print(sentence + "\n");
        print("\nRefused:\n");
        for (const std::string& sentence : refusals_in(rows)) print("  " + sentence + "\n");
    }
    for (const std::string& sentence : report.failures) note(sentence);
    return report;
}

}  // namespace aabblab
