#include <nlohmann/json.hpp>

#include "command_parser.hpp"
#include "composing.hpp"
#include "filtering.hpp"

import aabblab.drawing;
import aabblab.files;
import aabblab.inputs;
import aabblab.numbers;
import aabblab.pair_output;
import aabblab.trials;

namespace aabblab {

namespace {

struct contacts_request {
    std::string motion;
    std::vector<std::string> meshes;
    method_options method{{aabb::stage::global_search, aabb::stage::local_detection}};
    filter_files filter;
    std::optional<std::string> out, intervals, draw, frame;
    std::optional<double> within;
    bool touching = true, geometry = false, json = false;
};

/// The result of --json: totals over all frames, and the time of each frame.
std::string json_of(const contacts_request& request, const search_method& method, const frames_result& result) {
    nlohmann::ordered_json summary = {{"objects", result.objects},
                                      {"frames", result.ms.size()},
                                      {"candidates", result.pairs},
                                      {"object_pairs", result.object_pairs},
                                      {"contacts", result.contacts},
                                      {"kinds", by_name(result.kinds)},
                                      {"digest", result.digest},
                                      {"build_ms", result.build_ms},
                                      {"ms", result.ms},
                                      {"method", method.name},
                                      {"exact", method.exact}};
    summary["exact_for"] = nullptr;
    if (method.exact) summary["exact_for"] = exact_for_meshes;
    if (request.within) summary["within"] = *request.within;
    if (request.filter.groups) summary["groups"] = visible(*request.filter.groups);
    if (request.filter.except) summary["except"] = visible(*request.filter.except);
    return summary.dump() + "\n";
}

/// The result for reading: totals over all frames, and the mean time per frame.
std::string text_of(const contacts_request& request, const search_method& method, const frames_result& result) {
    return fmt::format("{}{}: {}, {}\n", visible(request.motion), filter_text(request.filter),
                       counted(result.objects, "object"), counted(result.ms.size(), "frame")) +
           wrapped(fmt::format("{} of triangles{} in {} of objects ({} of boxes), digest {}",
                               counted(result.contacts, request.within ? "pair" : "contact"),
                               text_of_within(request.within),
                               counted(result.object_pairs, request.within ? "pair" : "contact"),
                               counted(result.pairs, "pair"), result.digest)) +
           "\n" + to_text(result.kinds) +
           wrapped(fmt::format("{}: built in {:.3f} ms,", method.text(), result.build_ms)) +
           fmt::format("\n{:.3f} ms per frame (mean, with frame 0)\n", result.mean_ms());
}

/// Opens the file of --draw, which must not overwrite an input or the contacts.
std::optional<hit_drawing> open_drawing(const contacts_request& request) {
    if (request.frame && !request.draw)
        throw aabb::input_error("--frame is the frame that --draw shows, so give --draw FILE");
    if (!request.draw) return std::nullopt;
    require_other_file(*request.draw, request.motion);
    require_no_mesh(*request.draw, request.meshes);
    if (request.out) require_two_files("--out", *request.out, "--draw", *request.draw);
    if (request.intervals) require_two_files("--intervals", *request.intervals, "--draw", *request.draw);
    return std::optional<hit_drawing>(std::in_place, *request.draw, "--draw");
}

/// Opens a file for rows, which must not overwrite an input.
std::optional<number_table> open_rows(const contacts_request& request, const std::optional<std::string>& file,
                                      std::string_view columns) {
    if (!file) return std::nullopt;
    require_other_file(*file, request.motion);
    require_no_filter(*file, request.filter);
    require_no_mesh(*file, request.meshes);
    return std::optional<number_table>(std::in_place, *file, columns);
}

/// The frame of --frame, by default the first.
std::uint32_t frame_of(const contacts_request& request, std::size_t frames) {
    return static_cast<std::uint32_t>(
        parse_whole(request.frame.value_or("0"), 0, frames - 1,
                    fmt::format("--frame is a frame of the motion, a whole number from 0 to {}", frames - 1)));
}

/// Finds the contacts of moving meshes in each frame, writes them to the file of --out, and prints totals.
void find_contacts(const contacts_request& request) {
    if (request.geometry && !request.out)
        throw aabb::input_error("--geometry adds columns to the contacts, so give --out FILE");
    search_choice choice = request.method.choice();
    if (request.within) {
        if (request.geometry || !request.touching)
            throw aabb::input_error("--within finds triangles that need not intersect; omit --geometry and --touching");
        require_no_triangle_test(choice);
        choice.within = nearness{*request.within};
    }
    if (request.out && request.intervals) require_two_files("--out", *request.out, "--intervals", *request.intervals);
    std::string columns = "frame,object_a,object_b,triangle_a,triangle_b";
    if (request.geometry) columns += "," + std::string(intersection_columns);
    std::optional<number_table> rows = open_rows(request, request.out, columns);
    std::optional<number_table> interval_rows = open_rows(request, request.intervals, contact_intervals::columns);
    std::optional<hit_drawing> drawing = open_drawing(request);
    scene_frames scene(open_motion(request.motion, read_meshes(request.meshes)), request.motion);
    std::optional<frame_drawing> drawn;
    if (drawing) drawn.emplace(frame_of(request, scene.frames()), *drawing);
    search_method method = method_of(choice, traits_of(scene), read_filter(request.filter, scene.objects()));
    std::optional<contact_intervals> intervals;
    if (interval_rows) intervals.emplace(scene, choice.named, method.filter.get(), *interval_rows);
    const frames_result result = search_frames(
        scene, method, {rows ? &*rows : nullptr, drawn ? &*drawn : nullptr, intervals ? &*intervals : nullptr},
        {.touching = request.touching, .geometry = request.geometry});
    if (drawing) drawing->commit();
    print(request.json ? json_of(request, method, result) : text_of(request, method, result));
}

}  // namespace

void add_contacts(const command_parser& program) {
    const command_parser command = program.add_command(
        "contacts",
        "Run both phases on moving meshes: find the intersecting triangles of each frame and pair of objects");
    auto& request = command.set_action(find_contacts);
    command.argument("MOTION", &request.motion,
                     "Text file with lines of frame, object and pose: twelve numbers, the rows of [R t], or seven, tx, "
                     "ty, tz and the quaternion x, y, z, w");
    command.argument(
        "MESH", &request.meshes,
        "Mesh files (OFF, OBJ, PLY, STL, glTF) or shapes; object i has mesh i modulo the number of meshes");
    request.method.add_to(command, "build, tree and triangle test; the broad phase keeps its strategies");
    add_touching(command, &request.touching, "contacts");
    add_within(command, &request.within, "triangles");
    add_filter_options(command, &request.filter);
    command.option("--out FILE", &request.out,
                   "File for the contacts, CSV, .npy or .json: rows frame,object_a,object_b,triangle_a,triangle_b");
    command.option(
        "--intervals FILE", &request.intervals,
        "File, CSV or .json, for when objects are in contact: for each pair of objects a row per interval of frames in "
        "contact, with one of the first contacts, and the nearest frame before, with the distance; the "
        "nearest frame after the last contact has a row of its own");
    command.flag("--geometry", &request.geometry,
                 "Add to each contact the triangles' intersection, in world coordinates: columns kind, number of "
                 "vertices, error bounds on x, y, z, vertices");
    command.option("--draw FILE", &request.draw,
                   "Draw one frame to this file (.ply, .obj): triangles that intersect in red, their intersections as "
                   "black lines");
    command.option("--frame N", &request.frame, "The frame that --draw shows (default 0)");
    command.flag("--json", &request.json, "Print the summary as JSON");
}

}  // namespace aabblab
