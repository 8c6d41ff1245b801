module;
#include <sys/wait.h>
#include <cerrno>
#include <cstring>

module aabblab.checking;

import aabb.base;
import aabblab.files;
import aabblab.fmt;
import aabblab.processes;
import aabblab.progress;

namespace aabblab {

namespace {

constexpr std::string_view why_temporary = "--command cannot give a program a scene";

/// Runs the program on input files; it writes the pairs to a file: COMMAND INPUTS… PAIRS TIMES. As an external engine
/// it may write times, which are ignored.
/// @param may_have_frames as for `read_pair_list`
pair_list run_program(const checked_program& program, const std::vector<std::string>& inputs,
                      const std::filesystem::path& folder, bool may_have_frames = true) {
    const std::filesystem::path pairs = folder / "pairs.csv";
    std::filesystem::remove(pairs);
    // The shell divides the command into words; "$@" are the names of files.
    std::vector<std::string> arguments{"-c", program.command + " \"$@\"", "sh"};
    arguments.insert(arguments.end(), inputs.begin(), inputs.end());
    arguments.push_back(pairs.string());
    arguments.push_back((folder / "times.csv").string());
    const program_result ended =
        run_child("/bin/sh", arguments, {.input = "/dev/null", .has_keeper = true, .timeout = program.timeout});
    const auto fail = [&](const std::string& how) {
        throw aabb::input_error(fmt::format("--command: '{}' {}", program.command, how));
    };
    if (ended.start_error != 0) fail(fmt::format("cannot be started: {}", std::strerror(ended.start_error)));
    if (ended.timed_out) fail(fmt::format("was still running after {} s", program.timeout.count()));
    if (!WIFEXITED(ended.status)) fail(fmt::format("was terminated by signal {}", WTERMSIG(ended.status)));
    if (WEXITSTATUS(ended.status) != 0) fail(fmt::format("ended with status {}", WEXITSTATUS(ended.status)));
    if (!std::filesystem::exists(pairs))
        fail(fmt::format("wrote no list of pairs: it should create the file of its argument {}", inputs.size() + 1));
    return read_pair_list(pairs, may_have_frames);
}

/// Some frames of a scene of boxes, in memory.
struct stored_frames {
    std::vector<std::vector<aabb::box>> boxes;
    std::vector<std::vector<aabb::boxd>> in_double;  ///< empty if the boxes are floats
};

/// A part of stored frames as a scene: some successive frames, and some objects, numbered anew.
class stored_scene final : public aabb::box_scene {
public:
    stored_scene(const stored_frames& all, std::size_t first, std::size_t last, std::span<const std::uint32_t> objects)
        : all_(all), frame_(first), end_(last + 1), frames_(end_ - first), objects_(objects.begin(), objects.end()) {}

    [[nodiscard]] std::size_t objects() const override { return objects_.size(); }
    [[nodiscard]] std::size_t frames() const override { return frames_; }
    bool next(std::vector<aabb::box>& boxes) override {
        if (frame_ == end_) return false;
        boxes.clear();
        in_double_.clear();
        for (const std::uint32_t object : objects_) {
            boxes.push_back(all_.boxes[frame_][object]);
            if (!all_.in_double.empty()) in_double_.push_back(all_.in_double[frame_][object]);
        }
        ++frame_;
        return true;
    }
    [[nodiscard]] std::span<const aabb::boxd> in_double() const override { return in_double_; }

private:
    const stored_frames& all_;
    std::size_t frame_, end_, frames_;
    std::vector<std::uint32_t> objects_;
    std::vector<aabb::boxd> in_double_;
};

/// Finds a smaller set of items that is still wrong (Zeller and Hildebrandt, "Simplifying and isolating
/// failure-inducing input", 2002, section 3: ddmin, by complements). First tries the items that the first wrong pair
/// suggests.
/// @param is_wrong whether a set of items, in ascending order, is wrong
std::vector<std::uint32_t> smallest_set(std::vector<std::uint32_t> items, std::vector<std::uint32_t> suggested,
                                        const std::function<bool(std::span<const std::uint32_t>)>& is_wrong) {
    std::ranges::sort(suggested);
    if (suggested.size() < items.size() && is_wrong(suggested)) items = std::move(suggested);
    progress shown("objects or triangles are left", items.size());
    for (std::size_t parts = 2; items.size() > 1;) {
        bool is_smaller = false;
        for (std::size_t part = 0; part < parts && !is_smaller; ++part) {
            const auto begin = static_cast<std::ptrdiff_t>(items.size() * part / parts);
            const auto end = static_cast<std::ptrdiff_t>(items.size() * (part + 1) / parts);
            std::vector<std::uint32_t> rest(items.begin(), items.begin() + begin);
            rest.insert(rest.end(), items.begin() + end, items.end());
            if (!is_wrong(rest)) continue;
            items = std::move(rest);
            is_smaller = true;
        }
        if (is_smaller)
            parts = std::max<std::size_t>(parts - 1, 2);
        else if (parts >= items.size())
            break;
        else
            parts = std::min(2 * parts, items.size());
        parts = std::min(parts, items.size());
        shown.update(items.size());
    }
    return items;
}

/// Whether the program writes a wrong list; one that fails proves nothing.
bool is_wrong_list(const std::function<check_result()>& check) {
    try {
        return !check().is_right();
    } catch (const aabb::input_error&) {
        return false;
    }
}

/// The triangles of a mesh with these indices, and their vertices.
aabb::mesh part_of(const aabb::mesh& whole, std::span<const std::uint32_t> triangles) {
    aabb::mesh part;
    std::map<std::uint32_t, std::uint32_t> vertices;
    std::vector<aabb::vec3d> positions;
    for (const std::uint32_t t : triangles) {
        auto& corners = part.triangles.emplace_back(whole.triangles[t]);
        for (std::uint32_t& v : corners) {
            const auto [place, is_new] = vertices.emplace(v, static_cast<std::uint32_t>(positions.size()));
            if (is_new) positions.push_back(whole.given_vertex(v));
            v = place->second;
        }
    }
    set_vertices(part, std::move(positions));
    return part;
}

}  // namespace

pair_list list_of(const checked_program& program, const std::filesystem::path& recording) {
    const folder_guard folder(make_temporary_folder(why_temporary));
    return run_program(program, {recording.string()}, folder.folder());
}

pair_list list_of(const checked_program& program, const std::vector<aabb::mesh>& meshes) {
    const folder_guard folder(make_temporary_folder(why_temporary));
    std::vector<std::string> files;
    for (const aabb::mesh& m : meshes) {
        files.push_back((folder.folder() / (files.empty() ? "a.off" : "b.off")).string());
        write_off(m, files.back());
    }
    return run_program(program, files, folder.folder(), /*may_have_frames=*/meshes.size() == 2);
}

std::size_t count_different_rows(pair_list first, pair_list second) {
    std::ranges::sort(first.rows);
    std::ranges::sort(second.rows);
    std::vector<listed_pair> different;
    std::ranges::set_difference(first.rows, second.rows, std::back_inserter(different));
    std::ranges::set_difference(second.rows, first.rows, std::back_inserter(different));
    return different.size();
}

smallest_scene reduce_boxes(const checked_program& program, std::unique_ptr<aabb::box_scene> scene,
                            const wrong_pair& first, const std::filesystem::path& file) {
    stored_frames all;
    std::vector<aabb::box> boxes;
    while (all.boxes.size() <= first.frame && scene->next(boxes)) {
        all.boxes.push_back(boxes);
        if (const std::span<const aabb::boxd> doubles = scene->in_double(); !doubles.empty())
            all.in_double.emplace_back(doubles.begin(), doubles.end());
    }
    std::vector<std::uint32_t> objects(boxes.size());
    std::iota(objects.begin(), objects.end(), 0U);
    smallest_scene smallest;
    std::size_t first_frame = 0;
    const folder_guard folder(make_temporary_folder(why_temporary));
    const auto write = [&](std::size_t from, std::span<const std::uint32_t> of, const std::filesystem::path& to) {
        stored_scene part(all, from, first.frame, of);
        write_boxes(part, to, /*progress=*/{});
    };
    const std::filesystem::path recording = folder.folder() / ("scene" + file.extension().string());
    const auto is_wrong = [&](std::size_t from, std::span<const std::uint32_t> of) {
        ++smallest.runs;
        return is_wrong_list([&] {
            write(from, of, recording);
            scene_frames part(std::make_unique<stored_scene>(all, from, first.frame, of));
            return check_boxes(part, run_program(program, {recording.string()}, folder.folder()));
        });
    };
    if (!is_wrong(0, objects))
        throw aabb::input_error(fmt::format(
            "--command: the list is right, or the program fails, without the frames after {}; the scene is not reduced",
            first.frame));
    // As few frames before the wrong one as the program needs.
    for (std::size_t before = 0; before < first.frame; before = 2 * before + 1)
        if (is_wrong(first.frame - before, objects)) {
            first_frame = first.frame - before;
            break;
        }
    objects = smallest_set(std::move(objects), {first.pair.a, first.pair.b},
                           [&](std::span<const std::uint32_t> of) { return is_wrong(first_frame, of); });
    write(first_frame, objects, file);
    smallest.objects = objects.size();
    smallest.frames = first.frame - first_frame + 1;
    return smallest;
}

smallest_scene reduce_meshes(const checked_program& program, const mesh_check& meshes, const wrong_pair& first,
                             const std::vector<std::filesystem::path>& files) {
    // The triangles of both meshes are numbered in one row.
    const std::uint32_t of_a = meshes.meshes.front().triangle_count();
    const bool has_two = meshes.meshes.size() == 2;
    std::vector<std::uint32_t> triangles(of_a + (has_two ? meshes.meshes.back().triangle_count() : 0));
    std::iota(triangles.begin(), triangles.end(), 0U);
    const auto parts_of = [&](std::span<const std::uint32_t> of) {
        const auto begin_b = std::ranges::lower_bound(of, of_a);
        std::vector<aabb::mesh> parts{part_of(meshes.meshes.front(), std::span(of.begin(), begin_b))};
        if (!has_two) return parts;
        std::vector<std::uint32_t> of_b(begin_b, of.end());
        for (std::uint32_t& t : of_b) t -= of_a;
        parts.push_back(part_of(meshes.meshes.back(), of_b));
        return parts;
    };
    smallest_scene smallest{.objects = 0, .frames = 1, .runs = 0};
    triangles = smallest_set(std::move(triangles), {first.pair.a, first.pair.b + (has_two ? of_a : 0)},
                             [&](std::span<const std::uint32_t> of) {
                                 const auto begin_b = std::ranges::lower_bound(of, of_a);
                                 if (begin_b == of.begin() || (has_two && begin_b == of.end())) return false;
                                 ++smallest.runs;
                                 return is_wrong_list([&] {
                                     mesh_check part = meshes;
                                     part.meshes = parts_of(of);
                                     return check_triangles(part, list_of(program, part.meshes));
                                 });
                             });
    const std::vector<aabb::mesh> parts = parts_of(triangles);
    for (std::size_t i = 0; i < parts.size(); ++i) write_off(parts[i], files[i]);
    smallest.objects = triangles.size();
    return smallest;
}

}  // namespace aabblab
