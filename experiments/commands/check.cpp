#include "command_parser.hpp"
#include "composing.hpp"

import aabblab.checking;
import aabblab.files;
import aabblab.inputs;
import aabblab.stopwatch;
import aabblab.trials;

namespace aabblab {

namespace {

struct check_request {
    std::vector<std::string> inputs;  ///< the scene, and the list unless a program makes it
    std::array<std::optional<std::string>, 2> poses;
    std::optional<std::string> poses_of_b, command, smallest;
    std::optional<std::size_t> timeout;
    std::string self;
    bool json = false;

    [[nodiscard]] bool has_poses() const { return poses[0] || poses[1] || poses_of_b; }
};

/// The names of the scene: a recording, or one or two meshes.
std::vector<std::string> scene_of(const check_request& request) {
    std::vector<std::string> scene = request.inputs;
    if (!request.command) scene.pop_back();
    return scene;
}

bool is_recording(const std::vector<std::string>& scene) {
    return scene.size() == 1 && is_file_of_boxes(scene[0]);
}

/// Rejects arguments that contradict each other, before any file is read.
void reject_contradictions(const check_request& request) {
    const auto reject_if = [](bool condition, const std::string& sentence) {
        if (condition) throw aabb::input_error(sentence);
    };
    if (!request.self.empty()) (void)self_pairs_of(request.self);
    const std::size_t scenes = request.inputs.size() - (request.command ? 0 : 1);
    reject_if(scenes == 0, "check: expected a list of pairs after the scene, or --command");
    reject_if(scenes > 2, fmt::format("check: expected a recording or two meshes{}, found {} files",
                                      request.command ? "" : " and a list", request.inputs.size()));
    const std::vector<std::string> scene = scene_of(request);
    const bool boxes = is_recording(scene);
    reject_if(boxes && (request.has_poses() || !request.self.empty()),
              "poses and --self are of meshes, not of a recording");
    reject_if(!boxes && scenes == 1 && request.self.empty(),
              scene[0] + ": expected boxes (.aabbs, .csv, .npy), two meshes, or one mesh with --self");
    reject_if(scenes == 2 && !request.self.empty(), "--self takes one mesh, so give no second one");
    reject_if(!request.self.empty() && request.has_poses(),
              "--self is about one mesh, whose pairs no pose changes; omit the poses");
    reject_if(request.poses[1] && request.poses_of_b, "--pose-b and --poses both set the pose of B; give one of them");
    reject_if(request.command && request.has_poses(), "--command gives a program meshes only; omit the poses");
    reject_if(!request.command && request.timeout, "--timeout is for the program of --command");
    reject_if(!request.command && request.smallest, "--smallest is the scene that --command reduces");
}

checked_program program_of(const check_request& request) {
    checked_program program{.command = *request.command};
    if (request.timeout) program.timeout = std::chrono::seconds(*request.timeout);
    return program;
}

/// The list of the file, or of the program.
/// @param run runs the program on the scene
pair_list list_from(const check_request& request, const std::function<pair_list(const checked_program&)>& run) {
    return request.command ? run(program_of(request)) : read_pair_list(request.inputs.back());
}

/// Prints the report.
/// @returns the exit status
int print_result(const check_request& request, const check_result& result, const checked_list& of) {
    print(request.json ? json_of(result, of) : text_of(result, of));
    return result.is_right() ? 0 : 1;
}

/// Tells where the smallest scene is, and how to check it.
void print_smallest(const check_request& request, const smallest_scene& smallest, const std::string& objects,
                    const std::string& files) {
    if (request.json) return;
    print(fmt::format(
        "\nSmallest scene, after {} runs: {} {} in {} frame{}. To repeat:\n  aabblab check {} --command '{}'{}\n",
        smallest.runs, smallest.objects, objects, smallest.frames, smallest.frames == 1 ? "" : "s", files,
        *request.command, request.self.empty() ? "" : " --self"));
}

int check_recording(const check_request& request, const std::string& scene) {
    const std::string ending = std::filesystem::path(scene).extension().string();
    const std::string smallest = request.smallest.value_or("smallest" + ending);
    if (std::filesystem::path(smallest).extension() != ending)
        throw aabb::input_error("--smallest " + smallest + ": expected the ending of the scene, " + ending);
    scene_frames frames(open_boxes(scene));  // rejected before a program runs
    pair_list list = list_from(request, [&](const checked_program& program) { return list_of(program, scene); });
    const check_result result = check_boxes(frames, std::move(list));
    const int status =
        print_result(request, result, {.scene = scene, .list = request.command.value_or(request.inputs.back())});
    if (!request.command || result.first.empty()) return status;
    if (std::error_code ignored; std::filesystem::equivalent(smallest, scene, ignored))
        note("the scene is " + smallest + " itself, so it is not reduced");
    else
        print_smallest(request, reduce_boxes(program_of(request), open_boxes(scene), result.first.front(), smallest),
                       "objects", smallest);
    return status;
}

int check_meshes(const check_request& request, const std::vector<std::string>& scene) {
    mesh_check meshes{.meshes = {}, .pose_a = pose_of(request.poses[0], "--pose-a")};
    meshes.poses_b = {{pose_of(request.poses[1], "--pose-b")}, /*file=*/{}, /*lines=*/{}};
    if (request.poses_of_b) meshes.poses_b = read_poses(*request.poses_of_b);
    if (!request.self.empty()) meshes.self = self_pairs_of(request.self);
    meshes.between = scene.front() + " against " + (scene.size() == 2 ? scene.back() : "itself");
    meshes.meshes = read_meshes(scene);
    pair_list list =
        list_from(request, [&](const checked_program& program) { return list_of(program, meshes.meshes); });
    const check_result result = check_triangles(meshes, std::move(list));
    const int status = print_result(request, result,
                                    {.scene = meshes.between,
                                     .list = request.command.value_or(request.inputs.back()),
                                     .objects = "triangle",
                                     .frames = "pose"});
    if (!request.command || result.first.empty()) return status;
    const std::string prefix = request.smallest.value_or("smallest");
    std::vector<std::filesystem::path> files{prefix + "_a.off"};
    if (scene.size() == 2) files.emplace_back(prefix + "_b.off");
    std::string names;
    for (const std::filesystem::path& file : files) {
        std::error_code ignored;
        for (const std::string& mesh : scene)
            if (std::filesystem::equivalent(file, mesh, ignored)) return status;  // the smallest already
        names += (names.empty() ? "" : " ") + file.string();
    }
    print_smallest(request, reduce_meshes(program_of(request), meshes, result.first.front(), files), "triangles",
                   names);
    return status;
}

/// Checks a list of pairs, or that of a program, and reports what is wrong with it.
/// @returns the exit status: 1 if the list is wrong
int check(const check_request& request) {
    reject_contradictions(request);
    const std::vector<std::string> scene = scene_of(request);
    return is_recording(scene) ? check_recording(request, scene[0]) : check_meshes(request, scene);
}

}  // namespace

void add_check(const command_parser& program) {
    const command_parser command = program.add_command(
        "check",
        "Check a list of pairs, such as your engine's: which are missing or wrong, and what they have in common");
    auto& request = command.set_action(check);
    command.argument(
        "FILES", &request.inputs,
        "Boxes (.aabbs, .csv, .npy) or two meshes, A and B, or one mesh with --self; then the list, unless "
        "--command makes it: CSV, or integers with blanks between, frame,a,b or a,b, with or without a "
        "header, or an array in an .npy file");
    command.flag("--self [=all]", &request.self,
                 "Check pairs of one mesh with itself; the values are those of collide");
    command.option("--pose-a M", &request.poses[0], "Pose of A: twelve numbers, the rows of [R t]");
    command.option("--pose-b M", &request.poses[1], "Pose of B");
    command.option("--poses FILE", &request.poses_of_b, "Poses of B, one per line; the list has rows pose,a,b");
    command.option(
        "--command PROGRAM", &request.command,
        "Run this program, with the arguments SCENE PAIRS TIMES or A B PAIRS TIMES, and check the list that it "
        "writes to PAIRS; if it is wrong, reduce the scene to the smallest one in which it is. TIMES may be "
        "left out");
    command.option("--timeout SECONDS", &request.timeout, "Time limit for each run of the program (default 600)");
    command.option("--smallest FILE", &request.smallest,
                   "Where the smallest scene is written (default smallest, with the ending of SCENE); of meshes the "
                   "beginning of the names FILE_a.off and FILE_b.off");
    command.flag("--json", &request.json, "Print the report as JSON");
    command.footer("Exit status: 0 if the list is right, 1 if it is wrong, 2 if it cannot be read.");
}

}  // namespace aabblab
