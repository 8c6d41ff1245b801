#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_parser.hpp"
#include "commands.hpp"
#include "output.hpp"

#include "atlas_measuring.hpp"

import aabb.base;
import aabblab.atlas;
import aabblab.statistics;
import aabblab.tables;

namespace aabblab {

namespace {

struct atlas_request {
    std::optional<std::string> out;
    bool quick = false;
    bool judge = false;

    [[nodiscard]] std::filesystem::path folder() const {
        return out.value_or(quick ? "results/atlas-quick" : "results/atlas");
    }
};

int run(const atlas_request& request) {
    outlive_reader();
    const std::filesystem::path folder = request.folder();
    std::vector<std::string> failures;
    if (!request.judge) failures = measure_atlas(folder, request.quick);
    const std::vector<atlas_scene> atlas = measured_atlas(folder);
    if (atlas.empty()) throw aabb::input_error("there are no results of an atlas in " + folder.string());
    for (const std::string& missing : unfinished_parts(folder)) note(missing);
    write_atlas(folder, atlas);
    print(
        "Who is the fastest in how many scenes, of a frame after the first; shown where\n"
        "the second is slower beyond noise, and as fast where it may not be:\n" +
        to_text(winners_table(atlas), output_width()) + "\n");
    print("In times as long as the fastest of each scene, of the same:\n" +
          to_text(regrets_table(atlas, span_of_time::frame), output_width()) + "\n");
    for (const judged_statement& s : judged_statements(atlas))
        print(wrapped(fmt::format("{}: {} Here: {}. ({})", s.id, s.says, text_of(s.verdict), s.source)) + "\n");
    print("\nMaps, borders and every ratio are in " + visible((folder / "atlas.html").string()) + "\n");
    return failures.empty() ? 0 : 1;
}

}  // namespace

void add_atlas(const command_parser& program, int& status) {
    const command_parser command = program.add_command(
        "atlas", "Which composition or engine wins in which scene, and what it costs to use one everywhere");
    auto request = std::make_shared<atlas_request>();
    command.add_flag("--quick", request->quick, "Small scenes, few repeats: a minute in place of half an hour");
    command.add_flag("--judge", request->judge, "Measure nothing: make the maps of results that are there");
    command
        .add_option("--out", request->out,
                    "Folder of results and maps (default results/atlas; with --quick results/atlas-quick)")
        .type_name("DIR");
    command.callback([request, &status] { status = run(*request); });
}

}  // namespace aabblab
