#include <sstream>

#include "checked_lists.hpp"

// The programs that call a library as its users do, in experiments/checking/libraries.

namespace {

std::vector<std::string> list_programs() {
    std::istringstream names(AABBLAB_LISTS);
    std::vector<std::string> programs;
    for (std::string name; names >> name;) programs.push_back(name);
    return programs;
}

}  // namespace

TEST_CASE_METHOD(in_folder, "The programs that call libraries write lists of boxes and triangles that check can read") {
    const std::string boxes = folder / "boxes.aabbs";
    // 0 and 1 overlap by much, 2 is far away.
    write_boxes(boxes, {{{0, 0, 0, 2, 2, 2}, {1, 1, 1, 3, 3, 3}, {40, 0, 0, 42, 2, 2}},
                        {{0, 0, 0, 2, 2, 2}, {1, 1, 1, 3, 3, 3}, {40, 0, 0, 42, 2, 2}}});
    const std::vector<std::string> meshes{folder / "a.off", folder / "b.off"};
    run_well({"order", "icosphere:triangles=80", "--out", meshes[0]});
    run_well({"order", "torus_knot:triangles=200", "--out", meshes[1]});
    for (const std::string& program : list_programs()) {
        CAPTURE(program);
        CHECK(run_command({program, "--version"}).out.size() > 4);
        for (const std::vector<std::string>& inputs : std::vector<std::vector<std::string>>{{boxes}, meshes}) {
            const std::string list = folder / "list.csv";
            const program_result ended = run_command(joined(joined({program}, inputs), {list}));
            INFO(ended.err);
            REQUIRE(ended.status == 0);
            const auto report = checked(joined(inputs, {list}));
            INFO(report.dump());
            CHECK(report["correct"] > 0);
            CHECK((inputs == meshes || report["right"] == true));  // few have exact tests of triangles
        }
        CHECK(run_command({program, folder / "none.aabbs", folder / "list.csv"}).status == 2);
    }
}
