#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "command_parser.hpp"
#include "commands.hpp"
#include "output.hpp"

// Import, so they come last.
#include "composing.hpp"
#include "hit_geometry.hpp"
#include "mesh_neighbours.hpp"
#include "poses.hpp"

import aabb.base;
import aabb.digest;
import aabb.geometry;
import aabb.pipeline;
import aabb.policy;
import aabb.registry;
import aabb.selection;
import aabb.validation;
import aabblab.numbers;
import aabblab.pair_output;
import aabblab.trials;
import aabblab.stopwatch;

namespace aabblab {

namespace {

struct collide_request {
    std::string a;
    std::optional<std::string> b;
    std::array<std::optional<std::string>, 2> poses;
    stage_options local{aabb::stage::local_detection};
    std::optional<std::string> engine, out, poses_of_b;
    std::size_t repeats = 1;
    std::string self;  ///< what becomes of pairs that share a vertex: `together`, `apart`; empty without --self
    bool first = false;
    bool count = false;
    bool geometry = false;
    bool exit_code = false;
    bool json = false;
};

struct detection_method {
    std::string name;
    bool exact;
    std::unique_ptr<aabb::local_stage> stage;
    std::optional<hit_geometry> geometry;  ///< with --geometry
};

/// What --first finds.
struct found_pair {
    aabb::index_pair triangles;
    std::optional<aabb::triangle_intersection> common;  ///< with --geometry
};

/// Pairs of a mesh with itself: those that share a vertex, and those that do not.
struct self_counts {
    std::uint64_t neighbours = 0;
    std::uint64_t others = 0;
};

struct detection_result {
    std::vector<std::uint32_t> triangles;          ///< of each mesh
    std::vector<std::uint64_t> counts;             ///< by pose, of a mesh with itself those that share no vertex
    std::optional<std::uint64_t> neighbours;       ///< of a mesh with itself: pairs that share a vertex
    std::vector<std::optional<found_pair>> first;  ///< by pose, with --first
    std::optional<std::string> digest;             ///< of all pairs that are kept; none where they are counted only
    double build_ms = 0;
    std::vector<double> query_ms;  ///< by pose, and so again for each repeat
    std::vector<aabb::part_bytes> bytes;
    std::optional<double> bytes_per_triangle;  ///< of the trees; none for an engine that does not say
};

detection_method method_of(const collide_request& request, const aabb::scene_outlook& outlook) {
    if (request.engine) {
        if (request.local.any())
            throw aabb::input_error("--engine stands in for " + request.local.names() + ", so give it alone");
        return {*request.engine, aabb::is_exact_engine(*request.engine), aabb::make_mesh_engine(*request.engine), {}};
    }
    aabb::named_strategies named;
    request.local.add_to(named);
    const aabb::composition composition = select_composition(named, outlook);
    detection_method method{aabb::to_text(composition, aabb::stage::local_detection),
                            aabb::is_exact(composition, aabb::stage::local_detection),
                            aabb::compose_local_detection(composition, aabb::instrumentation::none),
                            {}};
    if (request.geometry) method.geometry.emplace(composition[aabb::strategy_kind::triangle]);
    return method;
}

/// Meshes where they are told to be, each an object; the second one, frame by frame, at each of its poses, as often as
/// that is repeated.
class posed_meshes final : public aabb::mesh_scene {
public:
    /// @param of_b at least one, also where there is no second mesh
    posed_meshes(std::vector<aabb::mesh> given, const aabb::pose& of_a, std::vector<aabb::pose> of_b,
                 std::size_t repeats)
        : of_a_(of_a), of_b_(std::move(of_b)), frames_(repeats * of_b_.size()) {
        meshes = std::move(given);
        for (std::uint32_t object = 0; object < meshes.size(); ++object) mesh_of.push_back(object);
    }

    [[nodiscard]] std::size_t frames() const override { return frames_; }
    bool next(std::vector<aabb::pose>& poses) override {
        if (frame_ == frames_) return false;
        poses = {of_a_, of_b_[frame_++ % of_b_.size()]};
        poses.resize(meshes.size());
        return true;
    }

private:
    aabb::pose of_a_;
    std::vector<aabb::pose> of_b_;
    std::size_t frames_;
    std::size_t frame_ = 0;
};

/// Of a mesh with itself, pairs that share a vertex may be by far the most: around one of n triangles there are n²/2.
/// They are kept only where they are wanted and an inexact method may have missed some; an exact one has found them
/// all, so that they follow from the mesh.
bool keeps_neighbours(const collide_request& request, const detection_method& method) {
    return request.self == "together" && !method.exact && !request.count;
}

void query_self(player& who, const collide_request& request, const detection_method& method, const aabb::mesh& m,
                std::vector<aabb::index_pair>& pairs, self_counts& counts) {
    const bool neighbours_kept = keeps_neighbours(request, method);
    who.each_self_pair(0, [&](aabb::index_pair pair) {
        const bool neighbours = share_vertex(m, pair);
        ++(neighbours ? counts.neighbours : counts.others);
        if (neighbours ? neighbours_kept : !request.count) pairs.push_back(pair);
    });
}

/// Answers in place of `detect`, or by it.
/// @returns how many pairs there are, where those are not kept
std::uint64_t query(player& who, const collide_request& request, std::vector<aabb::index_pair>& pairs) {
    if (request.count) {
        return who.count_contacts();
    } else if (request.first) {
        if (const auto c = who.first_contact()) pairs.push_back({c->triangle_a, c->triangle_b});
    } else {
        who.detect();
    }
    return 0;
}

void set_bytes(detection_result& result, const player& who) {
    result.bytes = who.local_bytes();
    std::optional<std::size_t> trees;
    for (const aabb::part_bytes& part : result.bytes)
        if (part.part == "nodes" || part.part == "indices") trees = trees.value_or(0) + part.bytes;
    std::size_t triangles = 0;
    for (const std::uint32_t of_mesh : result.triangles) triangles += of_mesh;
    if (trees) result.bytes_per_triangle = static_cast<double>(*trees) / static_cast<double>(triangles);
}

/// Brings the pairs of one pose into their order, and says which they are.
/// @param pairs those that were kept
/// @param table takes the pairs; null where they are not wanted
void take_pairs(const collide_request& request, detection_method& method, const scene_play& scene, std::uint32_t frame,
                const self_counts& of_self, std::vector<aabb::index_pair>& pairs, detection_result& result,
                aabb::digest& digest, number_table* table) {
    sort_rows(pairs);
    require_each_once(pairs, method.name);
    const aabb::mesh& a = scene.meshes()->meshes.front();
    if (method.geometry)
        method.geometry->take(a, scene.poses().front(), scene.meshes()->meshes.back(), scene.poses().back());
    if (request.first) result.first.emplace_back();
    const auto take_one = [&](aabb::index_pair pair) {
        std::optional<aabb::triangle_intersection> common;
        if (method.geometry) common = (*method.geometry)(pair);
        if (request.first) result.first.back() = found_pair{pair, common};
        if (!table) return;
        const std::string cells = common ? to_cells(*common) : "";
        if (request.self == "together")
            table->add({pair.a, pair.b, shared_vertices(a, pair)}, cells);
        else if (request.poses_of_b)
            table->add({frame, pair.a, pair.b}, cells);
        else
            table->add({pair.a, pair.b}, cells);
    };
    const auto take = [&](std::span<const aabb::index_pair> sorted) {
        digest.add(frame, sorted);
        if (table || method.geometry || request.first) std::ranges::for_each(sorted, take_one);
    };
    if (!keeps_neighbours(request, method) && request.self == "together") {
        const std::uint64_t neighbours = for_each_with_neighbours(a, pairs, take);
        if (neighbours != of_self.neighbours)
            throw defect(fmt::format("{} finds {} pairs of triangles that share a vertex, and there are {}",
                                     method.name, of_self.neighbours, neighbours));
    } else {
        take(pairs);
    }
}

/// Every two objects are candidates, since boxes in the world say nothing of meshes that were moved together, however
/// far. What is found again in a repeat is not told again.
/// @param lines those of the file of poses, by pose
/// @param table takes the pairs; null where they are not wanted.
detection_result detect(const collide_request& request, detection_method& method, scene_play& scene,
                        std::span<const std::size_t> lines, number_table* table) {
    detection_result result;
    std::optional<player> who;
    result.build_ms = milliseconds_of([&] { who.emplace(stages{nullptr, std::move(method.stage)}, scene); });
    for (const aabb::mesh& m : scene.meshes()->meshes) result.triangles.push_back(m.triangle_count());
    const aabb::mesh& a = scene.meshes()->meshes.front();
    const std::size_t poses = scene.frames() / request.repeats;
    aabb::digest digest;
    for (std::uint32_t frame = 0; scene.next(); ++frame) {
        const auto pose = request.poses_of_b ? std::optional(frame) : std::nullopt;
        std::vector<aabb::index_pair> pairs;
        self_counts of_self;
        std::uint64_t count = 0;
        try {
            who->update();
            who->search();
            result.query_ms.push_back(milliseconds_of([&] {
                if (request.self.empty())
                    count = query(*who, request, pairs);
                else
                    query_self(*who, request, method, a, pairs, of_self);
            }));
        } catch (const aabb::input_error& error) {
            throw aabb::input_error(fmt::format(
                "{}{} against {}: {}", pose ? fmt::format("{}:{}: ", *request.poses_of_b, lines[frame % poses]) : "",
                request.a, request.b.value_or("itself"), error.what()));
        }
        if (frame >= poses) continue;
        if (!request.count) {
            for (const aabb::contact& c : who->sorted_contacts()) pairs.push_back({c.triangle_a, c.triangle_b});
            count = pairs.size();
            take_pairs(request, method, scene, frame, of_self, pairs, result, digest, table);
        }
        if (!request.self.empty()) {
            count = of_self.others;
            result.neighbours = of_self.neighbours;
        }
        result.counts.push_back(count);
    }
    set_bytes(result, *who);
    if (!request.count) result.digest = digest.text();
    return result;
}

nlohmann::ordered_json geometry_of(const aabb::triangle_intersection& common) {
    nlohmann::ordered_json geometry{{"kind", name_of(common.kind)}};
    for (std::uint32_t i = 0; i < common.size; ++i) geometry["corners"].push_back(common.corners[i].at);
    geometry["error"] = common.error.at;
    return geometry;
}

void print_json(const collide_request& request, const detection_method& method, const detection_result& result) {
    nlohmann::ordered_json summary = {
        {"triangles", result.triangles}, {"pairs", result.counts},      {"digest", nullptr},
        {"build_ms", result.build_ms},   {"query_ms", result.query_ms}, {"bytes_per_triangle", nullptr}};
    if (!request.poses_of_b) summary["pairs"] = result.counts.front();
    if (!request.poses_of_b && request.repeats == 1) summary["query_ms"] = result.query_ms.front();
    if (result.digest) summary["digest"] = *result.digest;
    if (result.bytes_per_triangle) summary["bytes_per_triangle"] = *result.bytes_per_triangle;
    if (result.neighbours) summary["neighbours"] = *result.neighbours;
    if (request.first) {
        for (const std::optional<found_pair>& found : result.first)
            summary["first"].push_back(found ? nlohmann::ordered_json::array({found->triangles.a, found->triangles.b})
                                             : nullptr);
        if (!request.poses_of_b) summary["first"] = nlohmann::ordered_json(summary["first"].front());
    }
    if (request.geometry && request.first) {
        for (const std::optional<found_pair>& found : result.first)
            summary["geometry"].push_back(found ? geometry_of(*found->common) : nlohmann::ordered_json());
        if (!request.poses_of_b) summary["geometry"] = nlohmann::ordered_json(summary["geometry"].front());
    }
    summary["method"] = method.name;
    summary["exact"] = method.exact;
    for (const aabb::part_bytes& part : result.bytes) summary["bytes"][part.part] = part.bytes;
    print(summary.dump() + "\n");
}

/// "triangles 3 and 5 intersect: segment 2 …"
std::string text_of(const found_pair& found) {
    return fmt::format("triangles {} and {} intersect{}", found.triangles.a, found.triangles.b,
                       found.common ? ": " + to_text(*found.common) : "");
}

void print_text(const collide_request& request, const detection_method& method, const detection_result& result) {
    const auto named = [&](const std::string& mesh, std::size_t i) {
        return visible(mesh) + " (" + counted(result.triangles[i], "triangle") + ")";
    };
    print(named(request.a, 0) + " against " + (request.self.empty() ? named(*request.b, 1) : "itself") + "\n");
    const std::string digest = result.digest ? ", digest " + *result.digest : "";
    if (request.first && !request.poses_of_b && result.first[0]) {
        print(text_of(*result.first[0]) + "\n");
    } else {
        if (request.first && request.poses_of_b)
            for (std::size_t pose = 0; pose < result.first.size(); ++pose)
                if (result.first[pose]) print(fmt::format("pose {}: {}\n", pose, text_of(*result.first[pose])));
        print(fmt::format(
            "{}{} of triangles{}{}\n", request.poses_of_b ? counted(result.counts.size(), "pose") + " of it: " : "",
            counted(std::accumulate(result.counts.begin(), result.counts.end(), std::uint64_t{0}), "intersecting pair"),
            !request.self.empty() ? " that share no vertex" : "", digest));
    }
    if (result.neighbours)
        print(fmt::format("{} more among triangles that share a vertex\n", grouped(*result.neighbours)));
    std::vector<double> ms = result.query_ms;
    std::ranges::nth_element(ms, ms.begin() + static_cast<std::ptrdiff_t>(ms.size() / 2));
    print(fmt::format("{}{}: built in {:.3f} ms, searched in {:.3f} ms{}", method.name,
                      method.exact ? "" : " (inexact)", result.build_ms, ms[ms.size() / 2],
                      ms.size() == 1 ? "" : fmt::format(" (median of {})", ms.size())));
    if (result.bytes_per_triangle) print(fmt::format(", {:.1f} bytes a triangle", *result.bytes_per_triangle));
    print("\nbytes:");
    const char* before = " ";
    for (const aabb::part_bytes& part : result.bytes) {
        if (part.bytes > 0) print(fmt::format("{}{} {}", before, part.part, grouped(part.bytes)));
        if (part.bytes > 0) before = ", ";
    }
    print("\n");
}

std::size_t repeats_of(const std::string& text) {
    constexpr std::size_t most = 1'000'000;
    std::size_t repeats = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), repeats);
    if (error != std::errc{} || end != text.data() + text.size() || repeats < 1 || repeats > most)
        throw aabb::input_error("--repeat is how often to search: a whole number from 1 to 1,000,000, not '" + text +
                                "'");
    return repeats;
}

/// What does not go together.
void require_sense(const collide_request& request) {
    if (!request.self.empty()) {
        const std::vector<std::string> choices{"together", "apart"};
        if (std::ranges::find(choices, request.self) == choices.end())
            throw aabb::input_error(aabb::unknown_name("value of --self", request.self, choices));
        if (request.b)
            throw aabb::input_error(
                "--self holds one mesh against itself, so give no second one; to leave neighbours out, --self=apart");
        if (request.poses[0] || request.poses[1] || request.poses_of_b)
            throw aabb::input_error("--self holds a mesh against itself, so poses change nothing; leave them away");
        if (request.first)
            throw aabb::input_error("--self finds every pair, so --first does not go with it; --count does");
    } else if (!request.b) {
        throw aabb::input_error("collide: expected B, the other mesh, or --self");
    }
    if (request.poses[1] && request.poses_of_b)
        throw aabb::input_error("--pose-b and --poses both say where B is; give one of them");
    if (request.first && request.count) throw aabb::input_error("--first and --count ask for different things");
    if (request.count && request.out) throw aabb::input_error("--count keeps no pairs, so there is nothing for --out");
    if (!request.geometry) return;
    if (request.count) throw aabb::input_error("--count keeps no pairs, so --geometry does not go with it");
    if (!request.out && !request.first)
        throw aabb::input_error("--geometry adds columns to the pairs, so give --out FILE, or --first for one pair");
    require_no_engine(request.engine);
}

/// @returns the exit status
int collide(const collide_request& request) {
    require_sense(request);
    // What makes no sense is refused before anything is read.
    static_cast<void>(method_of(request, {}));
    const aabb::pose of_a = pose_of(request.poses[0], "--pose-a");
    poses_of_file of_b{{pose_of(request.poses[1], "--pose-b")}, {}};
    if (request.poses_of_b) of_b = read_poses(*request.poses_of_b);
    std::vector<std::string> names{request.a};
    if (request.b) names.push_back(*request.b);
    std::optional<number_table> table;
    if (request.out) {
        require_no_mesh(*request.out, names);
        if (request.poses_of_b) require_other_file(*request.out, {&*request.poses_of_b, 1});
        std::string columns = request.self == "together" ? "a,b,shared_vertices"
                              : request.poses_of_b       ? "pose,a,b"
                                                         : "a,b";
        if (request.geometry) columns += "," + std::string(intersection_columns);
        table.emplace(*request.out, columns);
    }
    scene_play scene(std::make_unique<posed_meshes>(read_meshes(names), of_a, std::move(of_b.poses), request.repeats));
    aabb::scene_outlook outlook = outlook_of(scene);
    outlook.frames = 1;  // each query is timed for itself: none leaves anything to the next
    detection_method method = method_of(request, outlook);
    const detection_result result = detect(request, method, scene, of_b.lines, table ? &*table : nullptr);
    if (table) table->commit();
    if (request.json)
        print_json(request, method, result);
    else
        print_text(request, method, result);
    const bool intersect = std::ranges::any_of(result.counts, [](std::uint64_t count) { return count > 0; });
    return request.exit_code && intersect ? 1 : 0;
}

}  // namespace

void add_collide(const command_parser& program, int& status) {
    const command_parser command =
        program.add_command("collide", "Local detection of two meshes: every pair of intersecting triangles");
    auto request = std::make_shared<collide_request>();
    command
        .add_option("A", request->a,
                    "Mesh file (OFF, OBJ, PLY, STL, glTF), or a shape as in torus_knot:triangles=20000; with "
                    ":order=sah behind a file, or "
                    ",order=sah behind a shape's parameters, its triangles "
                    "stand in the order of a tree's leaves")
        .required()
        .type_name("");
    command.add_option("B", request->b, "The other one").type_name("");
    command
        .add_option("--pose-a", request->poses[0],
                    "Where A is: 12 numbers, the rows of [R t], with commas between (default: as it is)")
        .type_name("M");
    command.add_option("--pose-b", request->poses[1], "Where B is").type_name("M");
    command
        .add_option("--poses", request->poses_of_b,
                    "Search with B at each pose of this file, one a line, as --pose-b takes it; trees are built once")
        .type_name("FILE");
    request->local.add_to(command);
    command.add_option("--engine", request->engine, "Reference system in place of build, tree and triangle test")
        .type_name("E");
    command
        .add_flag("--self", request->self,
                  "Hold A against itself; pairs that share a vertex are counted apart, with --self=apart also left "
                  "out of the pairs")
        .option_text("[=apart]");
    command.add_flag("--first", request->first, "Stop at the first pair found");
    command.add_flag("--count", request->count, "Only count the pairs");
    command
        .add_option(
            "--repeat", [request](const std::string& text) { request->repeats = repeats_of(text); },
            "Search so often, at all poses in turn; each time is told (--json)")
        .type_name("N");
    command
        .add_option("--out", request->out,
                    "Write the pairs, rows a,b (with --self a,b,shared_vertices, with --self=apart a,b, with --poses "
                    "pose,a,b), to this CSV file")
        .type_name("FILE");
    command.add_flag("--geometry", request->geometry,
                     "Add to each pair what its triangles have in common, in the world: kind, corners, error");
    command.add_flag("--exit-code", request->exit_code,
                     "End with status 1 where anything intersects, as diff does; with --self, triangles that share no "
                     "vertex");
    command.add_flag("--json", request->json, "Print the summary as JSON");
    command.callback([request, &status] {
        // What the parser makes of a flag without a value.
        if (request->self == "true") request->self = "together";
        status = collide(*request);
    });
}

}  // namespace aabblab
