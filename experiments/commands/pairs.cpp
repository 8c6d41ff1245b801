#include <nlohmann/json.hpp>

#include "command_parser.hpp"
#include "composing.hpp"
#include "filtering.hpp"

import aabb.distance;
import aabb.pipeline;
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
    filter_files filter;
    std::optional<std::string> out;
    std::optional<double> within;
    std::optional<aabb::box_metric> metric;
    bool swept = false, json = false;
};

bool is_by_axis(const pairs_request& request) {
    return request.metric == aabb::box_metric::axis;
}

/// The result of --json: totals over all frames, and the time of each frame.
std::string json_of(const pairs_request& request, const search_method& method, const frames_result& result) {
    nlohmann::ordered_json summary = {
        {"objects", result.objects}, {"frames", result.ms.size()}, {"pairs", result.pairs}, {"digest", result.digest},
        {"ms", result.ms},           {"method", method.name},      {"exact", method.exact}};
    summary["exact_for"] = nullptr;
    if (method.exact) summary["exact_for"] = "the recorded boxes";
    if (request.within) {
        summary["within"] = *request.within;
        summary["metric"] = is_by_axis(request) ? "axis" : "euclidean";
    }
    if (request.filter.groups) summary["groups"] = visible(*request.filter.groups);
    if (request.filter.except) summary["except"] = visible(*request.filter.except);
    return summary.dump() + "\n";
}

/// The result for reading: totals over all frames, and the mean time per frame.
std::string text_of(const pairs_request& request, const search_method& method, const frames_result& result) {
    std::string text =
        fmt::format("{}{}: {}, {}\n{}{}{}, digest {}\n", visible(request.recording), filter_text(request.filter),
                    counted(result.objects, "object"), counted(result.ms.size(), "frame"),
                    counted(result.pairs, request.within ? "pair" : "overlapping pair"), text_of_within(request.within),
                    is_by_axis(request) ? " on each axis" : "", result.digest);
    // The mean, not the median: a Verlet list is rebuilt in few frames and reused in all others.
    if (!result.ms.empty())
        text += fmt::format("{}: {:.4g} ms per frame (mean, with frame 0)\n", method.text(), result.mean_ms());
    return text;
}

/// Finds the overlapping boxes of a recording in each frame, writes them to the file of --out, and prints totals.
void find_pairs(const pairs_request& request) {
    if (request.metric && !request.within) throw aabb::input_error("--metric is the distance of --within D; give both");
    search_choice choice = request.method.choice();
    std::unique_ptr<aabb::box_scene> boxes = open_boxes(request.recording);
    if (request.swept) boxes = swept(std::move(boxes));
    if (request.within) {
        choice.within = nearness{*request.within, request.metric.value_or(aabb::box_metric::euclidean), boxes.get()};
        boxes = in_floats(std::move(boxes));
    }
    scene_frames scene(std::move(boxes));
    search_method method = method_of(choice, traits_of(scene), read_filter(request.filter, scene.objects()));
    std::optional<number_table> rows;
    if (request.out) {
        require_other_file(*request.out, request.recording);
        require_no_filter(*request.out, request.filter);
        rows.emplace(*request.out, "frame,a,b");
    }
    const frames_result result = search_frames(scene, method, {.rows = rows ? &*rows : nullptr});
    print(request.json ? json_of(request, method, result) : text_of(request, method, result));
}

}  // namespace

void add_pairs(const command_parser& program) {
    const command_parser command =
        program.add_command("pairs", "Run the broad phase on a recording: find every pair of overlapping boxes");
    auto& request = command.set_action(find_pairs);
    command.argument("SCENE", &request.recording, "Boxes: a recording (.aabbs), or a .csv or .npy file");
    request.method.add_to(command, "these strategies");
    add_filter_options(command, &request.filter);
    add_within(command, &request.within, "boxes");
    add_metric(command, &request.metric);
    command.option("--out FILE", &request.out, "File for the pairs, rows frame,a,b: CSV, or .npy or .json");
    command.flag(
        "--swept", &request.swept,
        "Search swept boxes, each the box of an object in this frame and the previous one, so that no pair that "
        "meets on a straight way between frames is lost");
    command.flag("--json", &request.json, "Print the summary as JSON");
}

}  // namespace aabblab
