#include <nlohmann/json.hpp>

#include "command_parser.hpp"
#include "composing.hpp"

import aabblab.files;
import aabblab.inputs;
import aabblab.numbers;
import aabblab.pair_output;
import aabblab.trials;

namespace aabblab {

namespace {

struct pairs_request {
    std::string recording;
    method_options method{{aabb::stage::global_search}};
    std::optional<std::string> out;
    bool swept = false, json = false;
};

/// The result of --json: totals over all frames, and the time of each frame.
std::string json_of(const search_method& method, const frames_result& result) {
    nlohmann::ordered_json summary = {
        {"objects", result.objects}, {"frames", result.ms.size()}, {"pairs", result.pairs}, {"digest", result.digest},
        {"ms", result.ms},           {"method", method.name},      {"exact", method.exact}};
    summary["exact_for"] = nullptr;
    if (method.exact) summary["exact_for"] = "the recorded boxes";
    return summary.dump() + "\n";
}

/// The result for reading: totals over all frames, and the mean time per frame.
std::string text_of(const pairs_request& request, const search_method& method, const frames_result& result) {
    std::string text =
        fmt::format("{}: {}, {}\n{}, digest {}\n", visible(request.recording), counted(result.objects, "object"),
                    counted(result.ms.size(), "frame"), counted(result.pairs, "overlapping pair"), result.digest);
    // The mean, not the median: a Verlet list is rebuilt in few frames and reused in all others.
    if (!result.ms.empty())
        text += fmt::format("{}: {:.4g} ms per frame (mean, with frame 0)\n", method.text(), result.mean_ms());
    return text;
}

/// Finds the overlapping boxes of a recording in each frame, writes them to the file of --out, and prints totals.
void find_pairs(const pairs_request& request) {
    const search_choice choice = request.method.choice();
    std::unique_ptr<aabb::box_scene> boxes = open_boxes(request.recording);
    scene_frames scene(request.swept ? swept(std::move(boxes)) : std::move(boxes));
    search_method method = method_of(choice, traits_of(scene));
    std::optional<number_table> rows;
    if (request.out) {
        require_other_file(*request.out, request.recording);
        rows.emplace(*request.out, "frame,a,b");
    }
    const frames_result result = search_frames(scene, method, rows ? &*rows : nullptr);
    print(request.json ? json_of(method, result) : text_of(request, method, result));
}

}  // namespace

void add_pairs(const command_parser& program) {
    const command_parser command =
        program.add_command("pairs", "Run the broad phase on a recording: find every pair of overlapping boxes");
    auto& request = command.set_action(find_pairs);
    command.argument("SCENE", &request.recording, "Boxes: a recording (.aabbs), or a .csv or .npy file");
    request.method.add_to(command, "these strategies");
    command.option("--out FILE", &request.out, "File for the pairs, rows frame,a,b: CSV, or .npy or .json");
    command.flag(
        "--swept", &request.swept,
        "Search swept boxes, each the box of an object in this frame and the previous one, so that no pair that "
        "meets on a straight way between frames is lost");
    command.flag("--json", &request.json, "Print the summary as JSON");
}

}  // namespace aabblab
