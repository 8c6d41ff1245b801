#include "command_parser.hpp"
#include "composing.hpp"
#include "filtering.hpp"

import aabblab.checking;
import aabblab.files;
import aabblab.inputs;
import aabblab.numbers;
import aabblab.trials;

namespace aabblab {

namespace {

struct check_request {
    std::vector<std::string> inputs;  ///< the scene, and the list unless a program makes it
    std::array<std::optional<std::string>, 2> poses;
    std::optional<std::string> poses_of_b, command, smallest;
    std::optional<std::size_t> timeout;
    std::optional<double> within;
    std::optional<aabb::box_metric> metric;
    filter_files filter;
    std::string self;
    bool touching = true, swept = false, json = false;

    [[nodiscard]] bool has_poses() const { return poses[0] || poses[1] || poses_of_b; }
};

/// What a list is of.
enum class scene_form : std::uint8_t { recording, motion, meshes };

/// The names of the scene: a recording, one or two meshes, or a motion file and its meshes.
std::vector<std::string> scene_of(const check_request& request) {
    std::vector<std::string> scene = request.inputs;
    if (!request.command && !scene.empty()) scene.pop_back();
    return scene;
}

scene_form form_of(const std::vector<std::string>& scene) {
    if (scene.size() == 1 && is_file_of_boxes(scene[0])) return scene_form::recording;
    return scene.size() > 1 && !is_mesh_name(scene[0]) ? scene_form::motion : scene_form::meshes;
}

void reject_if(bool condition, const std::string& sentence) {
    if (condition) throw aabb::input_error(sentence);
}

/// Rejects options that do not belong to the scene.
void reject_strange_options(const check_request& request, const std::vector<std::string>& scene) {
    const scene_form form = form_of(scene);
    const bool is_self = !request.self.empty();
    if (is_self) (void)self_pairs_of(request.self);
    reject_if(form == scene_form::recording && (request.has_poses() || is_self),
              "poses and --self are of meshes, not of a recording");
    reject_if(form == scene_form::motion && (request.has_poses() || is_self),
              "a motion file has the poses of its meshes; omit --self and other poses");
    reject_if(form == scene_form::meshes && scene.size() == 1 && !is_self,
              scene[0] + ": expected boxes (.aabbs, .csv, .npy), two meshes, or one mesh with --self");
    reject_if(form == scene_form::meshes && scene.size() > 2,
              fmt::format("check: expected a recording, two meshes, or a motion file and its meshes{}, found {} files",
                          request.command ? "" : ", and a list", request.inputs.size()));
    reject_if(scene.size() == 2 && is_self, "--self takes one mesh, so give no second one");
    reject_if(is_self && request.has_poses(), "--self is about one mesh, whose pairs no pose changes; omit the poses");
    reject_if(request.poses[1] && request.poses_of_b, "--pose-b and --poses both set the pose of B; give one of them");
    reject_if(request.within && is_self, "--within is about two meshes; omit --self");
    reject_if(request.metric && (!request.within || form != scene_form::recording),
              "--metric is the distance of boxes that --within D asks for");
    reject_if(!request.touching && form == scene_form::recording, "--touching is about triangles, not about boxes");
    reject_if(!request.touching && request.self == "all",
              "--self=all is about triangles that touch; give --touching=no with plain --self");
    reject_if(!request.touching && request.within,
              "--within is about triangles that need not intersect; omit --touching");
    reject_if(request.swept && form != scene_form::recording, "--swept is about boxes, not about meshes");
    reject_if(request.filter.any() && form == scene_form::meshes,
              "--groups and --except are about several objects: boxes, or a motion file and its meshes");
}

/// Rejects arguments that contradict each other, before any file is read.
void reject_contradictions(const check_request& request) {
    const std::vector<std::string> scene = scene_of(request);
    reject_if(scene.empty(), "check: expected a list of pairs after the scene, or --command");
    reject_strange_options(request, scene);
    reject_if(request.command && request.has_poses(), "--command gives a program meshes only; omit the poses");
    reject_if(request.command && form_of(scene) == scene_form::motion,
              "--command gives a program boxes or two meshes, not a motion");
    reject_if(request.command && (request.within || request.swept || request.filter.any()),
              "--command checks a list of all overlaps; omit --within, --swept, --groups and --except");
    reject_if(!request.command && request.timeout, "--timeout is for the program of --command");
    reject_if(!request.command && request.smallest, "--smallest is the scene that --command reduces");
}

checked_program program_of(const check_request& request) {
    checked_program program{.command = *request.command};
    if (request.timeout) program.timeout = std::chrono::seconds(*request.timeout);
    return program;
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
        "\nSmallest scene, after {} runs: {} {} in {} frame{}. To repeat:\n  ./aabblab check {} --command '{}'{}\n",
        smallest.runs, smallest.objects, objects, smallest.frames, smallest.frames == 1 ? "" : "s", files,
        *request.command,
        std::string(request.self.empty() ? "" : " --self") + (request.touching ? "" : " --touching=no")));
}

/// Runs the program a second time if its list is wrong.
/// @returns whether it writes the same list again; if not, the result says so
template <class Run>
bool repeats_itself(const Run& run, pair_list list, check_result& result) {
    if (result.is_right()) return true;
    const std::size_t different = count_different_rows(std::move(list), run());
    if (different > 0)
        result.patterns.push_back(
            fmt::format("The program is not deterministic: in a second run on the same scene, {} other. The scene is "
                        "not reduced.",
                        different == 1 ? "1 row was" : grouped(different) + " rows were"));
    return different == 0;
}

int check_program_on_boxes(const check_request& request, const std::string& scene) {
    const std::string ending = std::filesystem::path(scene).extension().string();
    const std::string smallest = request.smallest.value_or("smallest" + ending);
    reject_if(std::filesystem::path(smallest).extension() != ending,
              "--smallest " + smallest + ": expected the ending of the scene, " + ending);
    scene_frames frames(open_boxes(scene));  // rejected before a program runs
    const checked_program program = program_of(request);
    const auto run = [&] { return list_of(program, scene); };
    const pair_list list = run();
    check_result result = check_boxes(frames, list);
    const bool is_deterministic = repeats_itself(run, list, result);
    const int status = print_result(request, result, {.scene = scene, .list = *request.command});
    if (result.first.empty() || !is_deterministic) return status;
    if (std::error_code ignored; std::filesystem::equivalent(smallest, scene, ignored))
        note("the scene is " + smallest + " itself, so it is not reduced");
    else
        print_smallest(request, reduce_boxes(program, open_boxes(scene), result.first.front(), smallest), "objects",
                       smallest);
    return status;
}

int check_recording(const check_request& request, const std::string& scene) {
    if (request.command) return check_program_on_boxes(request, scene);
    std::unique_ptr<aabb::box_scene> boxes = open_boxes(scene);
    if (request.swept) boxes = swept(std::move(boxes));
    std::optional<nearness> within;
    if (request.within) {
        within = nearness{*request.within, request.metric.value_or(aabb::box_metric::euclidean), boxes.get()};
        boxes = in_floats(std::move(boxes));
    }
    scene_frames frames(std::move(boxes));
    frames.filter_by(read_filter(request.filter, frames.objects()));
    const check_result result = check_boxes(frames, read_pair_list(request.inputs.back()), within);
    return print_result(request, result, {.scene = scene, .list = request.inputs.back()});
}

int check_motion(const check_request& request, const std::vector<std::string>& scene) {
    scene_frames frames(open_motion(scene[0], read_meshes({scene.begin() + 1, scene.end()})), scene[0]);
    frames.filter_by(read_filter(request.filter, frames.objects()));
    std::optional<nearness> within;
    if (request.within) within = nearness{*request.within};
    const check_result result =
        check_contacts(frames, read_contact_list(request.inputs.back()), within, request.touching);
    return print_result(request, result, {.scene = scene[0], .list = request.inputs.back()});
}

/// Reduces the meshes on which the program is wrong.
void reduce(const check_request& request, const std::vector<std::string>& scene, const mesh_check& meshes,
            const wrong_pair& first) {
    const std::string prefix = request.smallest.value_or("smallest");
    std::vector<std::filesystem::path> files{prefix + "_a.off"};
    if (scene.size() == 2) files.emplace_back(prefix + "_b.off");
    std::string names;
    for (const std::filesystem::path& file : files) {
        std::error_code ignored;
        for (const std::string& mesh : scene)
            if (std::filesystem::equivalent(file, mesh, ignored)) return;  // the smallest already
        names += (names.empty() ? "" : " ") + file.string();
    }
    print_smallest(request, reduce_meshes(program_of(request), meshes, first, files), "triangles", names);
}

int check_meshes(const check_request& request, const std::vector<std::string>& scene) {
    mesh_check meshes{.meshes = {}, .pose_a = pose_of(request.poses[0], "--pose-a")};
    meshes.poses_b = {{pose_of(request.poses[1], "--pose-b")}, /*file=*/{}, /*lines=*/{}};
    if (request.poses_of_b) meshes.poses_b = read_poses(*request.poses_of_b);
    if (!request.self.empty()) meshes.self = self_pairs_of(request.self);
    if (request.within) meshes.within = nearness{*request.within};
    meshes.touching = request.touching;
    meshes.between = scene.front() + " against " + (scene.size() == 2 ? scene.back() : "itself");
    meshes.meshes = read_meshes(scene);
    const checked_list of{.scene = meshes.between,
                          .list = request.command.value_or(request.inputs.back()),
                          .objects = "triangle",
                          .frames = "pose"};
    if (!request.command)
        return print_result(
            request, check_triangles(meshes, read_pair_list(request.inputs.back(), /*may_have_frames=*/!meshes.self)),
            of);
    const auto run = [&] { return list_of(program_of(request), meshes.meshes); };
    const pair_list list = run();
    check_result result = check_triangles(meshes, list);
    const bool is_deterministic = repeats_itself(run, list, result);
    const int status = print_result(request, result, of);
    if (!result.first.empty() && is_deterministic) reduce(request, scene, meshes, result.first.front());
    return status;
}

/// Checks a list of pairs, or that of a program, and reports what is wrong with it.
/// @returns the exit status: 1 if the list is wrong
int check(const check_request& request) {
    reject_contradictions(request);
    const std::vector<std::string> scene = scene_of(request);
    switch (form_of(scene)) {
        case scene_form::recording: return check_recording(request, scene[0]);
        case scene_form::motion: return check_motion(request, scene);
        case scene_form::meshes: break;
    }
    return check_meshes(request, scene);
}

}  // namespace

void add_check(const command_parser& program) {
    const command_parser command = program.add_command(
        "check",
        "Check a list of pairs, such as your engine's: which are missing or wrong, and what they have in common");
    auto& request = command.set_action(check);
    command.argument(
        "FILES", &request.inputs,
        "Boxes (.aabbs, .csv, .npy), two meshes, A and B, one mesh with --self, or a motion file and its meshes; then "
        "the list, unless --command makes it: CSV, or integers with blanks between, frame,a,b or a,b, of motions "
        "frame,object_a,object_b,triangle_a,triangle_b, with or without a header; .npy; or .json");
    command.flag("--self [=all]", &request.self,
                 "Check pairs of one mesh with itself; the values are those of collide");
    command.option("--pose-a M", &request.poses[0], "Pose of A: twelve numbers, the rows of [R t]");
    command.option("--pose-b M", &request.poses[1], "Pose of B");
    command.option("--poses FILE", &request.poses_of_b, "Poses of B, one per line; the list has rows pose,a,b");
    add_touching(command, &request.touching, "pairs of triangles");
    add_within(command, &request.within, "boxes or triangles");
    add_metric(command, &request.metric);
    command.flag("--swept", &request.swept, "Check pairs of swept boxes, as pairs --swept finds them");
    add_filter_options(command, &request.filter);
    command.option("--command PROGRAM", &request.command,
                   "Run this program, with the arguments SCENE PAIRS TIMES, A B PAIRS TIMES or, with --self, A PAIRS "
                   "TIMES, and check the list that it "
                   "writes to PAIRS; if it is wrong, reduce the scene to the smallest one in which it is. TIMES may be "
                   "left out");
    const auto take_timeout = [&request](const std::string& text) {
        request.timeout =
            parse_whole(text, 1, 1'000'000, "--timeout is a number of seconds: a whole number from 1 to 1,000,000");
    };
    command.option("--timeout SECONDS", take_timeout, "Time limit for each run of the program (default 600)");
    command.option("--smallest FILE", &request.smallest,
                   "Where the smallest scene is written (default smallest, with the ending of SCENE); of meshes the "
                   "beginning of the names FILE_a.off and FILE_b.off");
    command.flag("--json", &request.json, "Print the report as JSON");
    command.footer("Exit status: 0 if the list is right, 1 if it is wrong, 2 if it cannot be read.");
}

}  // namespace aabblab
