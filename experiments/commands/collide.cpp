#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "number.hpp"
#include "output.hpp"

// Import, so they come last.
#include "composing.hpp"
#include "hit_geometry.hpp"

import aabb.base;
import aabb.digest;
import aabb.geometry;
import aabb.pipeline;
import aabb.policy;
import aabb.registry;
import aabb.validation;
import aabblab.pair_output;
import aabblab.play;
import aabblab.stopwatch;

namespace aabblab {

namespace {

struct collide_request {
    std::string a;
    std::optional<std::string> b;
    std::array<std::optional<std::string>, 2> poses;
    stage_options local{aabb::stage::local_detection};
    std::optional<std::string> engine, out;
    bool self = false;
    bool first = false;
    bool count = false;
    bool geometry = false;
    bool json = false;
};

struct detection_method {
    std::string name;
    bool exact;
    std::unique_ptr<aabb::local_stage> stage;
    std::optional<hit_geometry> geometry;  ///< with --geometry
};

struct detection_result {
    std::vector<std::uint32_t> triangles;  ///< of each mesh
    std::vector<aabb::index_pair> pairs;
    std::uint64_t count = 0;                           ///< of pairs, of a mesh with itself those that share no vertex
    std::optional<std::uint64_t> neighbours;           ///< of a mesh with itself: pairs that share a vertex
    std::optional<aabb::triangle_intersection> first;  ///< of the one pair that --first found, with --geometry
    std::optional<std::string> digest;  ///< of all pairs, neighbours too; none where they are counted only
    double build_ms = 0;
    double query_ms = 0;
    std::vector<aabb::part_bytes> bytes;
    std::optional<double> bytes_per_triangle;  ///< of the trees; none for an engine that does not say
};

detection_method method_of(const collide_request& request) {
    if (request.engine) {
        if (request.local.any())
            throw aabb::input_error("--engine stands in for " + request.local.names() + ", so give it alone");
        return {*request.engine, aabb::is_exact_engine(*request.engine), aabb::make_mesh_engine(*request.engine), {}};
    }
    aabb::named_strategies named;
    request.local.add_to(named);
    const aabb::composition composition(named);
    detection_method method{aabb::to_text(composition, aabb::stage::local_detection),
                            aabb::is_exact(composition, aabb::stage::local_detection),
                            aabb::compose_local_detection(composition, aabb::instrumentation::none),
                            {}};
    if (request.geometry) method.geometry.emplace(composition[aabb::strategy_kind::triangle]);
    return method;
}

/// @param text the rows of [R t]
aabb::pose parse_pose(const std::string& text) {
    const std::vector<std::string> words = split_numbers(text);
    if (words.size() != 12)
        throw aabb::input_error(
            fmt::format("a pose is 12 numbers, the rows of [R t] with commas between, not {}", words.size()));
    aabb::pose pose;
    for (std::size_t i = 0; i < 12; ++i) {
        try {
            const auto number = parse_number<double>(words[i]);
            const std::size_t row = i / 4;
            if (i % 4 == 3)
                pose.translation[static_cast<int>(row)] = number;
            else
                pose.rotation[3 * row + i % 4] = number;
        } catch (const aabb::input_error& error) {
            throw aabb::input_error(fmt::format("number {} of 12: {}", i + 1, error.what()));
        }
    }
    aabb::require_rigid(pose);
    return pose;
}

aabb::pose pose_of(const std::optional<std::string>& text, const char* option) {
    if (!text) return {};
    try {
        return parse_pose(*text);
    } catch (const aabb::input_error& error) {
        throw aabb::input_error(fmt::format("{}: {}", option, error.what()));
    }
}

/// Meshes where they are told to be, each an object: a scene of one frame.
class posed_meshes final : public aabb::mesh_scene {
public:
    /// @param poses as many as meshes, or more
    posed_meshes(std::vector<aabb::mesh> given, std::span<const aabb::pose> poses) {
        meshes = std::move(given);
        poses_.assign(poses.begin(), poses.begin() + static_cast<std::ptrdiff_t>(meshes.size()));
        for (std::uint32_t object = 0; object < meshes.size(); ++object) mesh_of.push_back(object);
    }

    [[nodiscard]] std::size_t frames() const override { return 1; }
    bool next(std::vector<aabb::pose>& poses) override {
        poses = poses_;
        return !std::exchange(played_, true);
    }

private:
    std::vector<aabb::pose> poses_;
    bool played_ = false;
};

/// Answers in place of `detect`, or by it.
void query(player& who, const collide_request& request, detection_result& result) {
    if (request.self) {
        who.find_self_pairs(0, result.pairs);
    } else if (request.count) {
        result.count = who.count_contacts();
    } else if (request.first) {
        if (const auto c = who.first_contact()) result.pairs.push_back({c->triangle_a, c->triangle_b});
    } else {
        who.detect();
    }
}

/// How many corners of one triangle lie where a corner of the other does.
std::uint32_t shared_vertices(const aabb::mesh& m, aabb::index_pair pair) {
    const aabb::triangle3f s = m.triangle(pair.a);
    const aabb::triangle3f t = m.triangle(pair.b);
    std::uint32_t shared = 0;
    for (int i = 0; i < 3; ++i) shared += s[i] == t[0] || s[i] == t[1] || s[i] == t[2];
    return shared;
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

/// Every two objects are candidates, since boxes in the world say nothing of meshes that were moved together, however
/// far.
/// @param table takes the pairs; null where they are not wanted.
detection_result detect(const collide_request& request, detection_method& method, scene_play& scene,
                        number_table* table) {
    detection_result result;
    std::optional<player> who;
    result.build_ms = milliseconds_of([&] { who.emplace(stages{nullptr, std::move(method.stage)}, scene); });
    scene.next();
    who->update();
    who->search();
    try {
        result.query_ms = milliseconds_of([&] { query(*who, request, result); });
    } catch (const aabb::input_error& error) {
        throw aabb::input_error(
            fmt::format("{} against {}: {}", request.a, request.b.value_or("itself"), error.what()));
    }
    const std::vector<aabb::mesh>& meshes = scene.meshes()->meshes;
    for (const aabb::mesh& m : meshes) result.triangles.push_back(m.triangle_count());
    set_bytes(result, *who);
    if (request.count && !request.self) return result;
    for (const aabb::contact& c : who->sorted_contacts()) result.pairs.push_back({c.triangle_a, c.triangle_b});
    std::ranges::sort(result.pairs);
    require_each_once(result.pairs, method.name);
    if (method.geometry)
        method.geometry->take(meshes.front(), scene.poses().front(), meshes.back(), scene.poses().back());
    aabb::digest digest;
    for (const aabb::index_pair pair : result.pairs) {
        const std::uint32_t shared = request.self ? shared_vertices(meshes[0], pair) : 0;
        std::string cells;
        if (method.geometry) {
            const aabb::triangle_intersection common = (*method.geometry)(pair);
            if (request.first) result.first = common;
            if (table) cells = to_cells(common);
        }
        if (table) request.self ? table->add({pair.a, pair.b, shared}, cells) : table->add({pair.a, pair.b}, cells);
        result.count += shared == 0;
    }
    digest.add(0, result.pairs);
    if (request.self) result.neighbours = result.pairs.size() - result.count;
    if (!request.count) result.digest = digest.text();
    return result;
}

void print_json(const detection_method& method, const detection_result& result) {
    nlohmann::ordered_json summary = {
        {"triangles", result.triangles}, {"pairs", result.count},       {"digest", nullptr},
        {"build_ms", result.build_ms},   {"query_ms", result.query_ms}, {"bytes_per_triangle", nullptr}};
    if (result.digest) summary["digest"] = *result.digest;
    if (result.bytes_per_triangle) summary["bytes_per_triangle"] = *result.bytes_per_triangle;
    if (result.neighbours) summary["neighbours"] = *result.neighbours;
    if (result.first) {
        nlohmann::ordered_json& geometry = summary["geometry"];
        geometry["kind"] = name_of(result.first->kind);
        for (std::uint32_t i = 0; i < result.first->size; ++i)
            geometry["corners"].push_back(result.first->corners[i].at);
        geometry["error"] = result.first->error.at;
    }
    summary["method"] = method.name;
    summary["exact"] = method.exact;
    for (const aabb::part_bytes& part : result.bytes) summary["bytes"][part.part] = part.bytes;
    print(summary.dump() + "\n");
}

void print_text(const collide_request& request, const detection_method& method, const detection_result& result) {
    print(fmt::format(
        "{} ({} triangles) against {}\n", visible(request.a), result.triangles[0],
        request.self ? "itself" : fmt::format("{} ({} triangles)", visible(*request.b), result.triangles[1])));
    const std::string digest = result.digest ? ", digest " + *result.digest : "";
    if (request.first && !result.pairs.empty())
        print(fmt::format("triangles {} and {} intersect{}\n", result.pairs[0].a, result.pairs[0].b,
                          result.first ? ": " + to_text(*result.first) : ""));
    else
        print(fmt::format("{} intersecting pairs of triangles{}{}\n", result.count,
                          request.self ? " that share no vertex" : "", digest));
    if (result.neighbours) print(fmt::format("{} more among triangles that share a vertex\n", *result.neighbours));
    print(fmt::format("{}{}: built in {:.3f} ms, searched in {:.3f} ms", method.name, method.exact ? "" : " (inexact)",
                      result.build_ms, result.query_ms));
    if (result.bytes_per_triangle) print(fmt::format(", {:.1f} bytes a triangle", *result.bytes_per_triangle));
    print("\nbytes:");
    const char* before = " ";
    for (const aabb::part_bytes& part : result.bytes) {
        if (part.bytes > 0) print(fmt::format("{}{} {}", before, part.part, part.bytes));
        if (part.bytes > 0) before = ", ";
    }
    print("\n");
}

/// What does not go together.
void require_sense(const collide_request& request) {
    if (request.self) {
        if (request.b) throw aabb::input_error("--self holds one mesh against itself, so give no second one");
        if (request.poses[0] || request.poses[1])
            throw aabb::input_error("--self holds a mesh against itself, so poses change nothing; leave them away");
        if (request.first)
            throw aabb::input_error("--self finds every pair, so --first does not go with it; --count does");
    } else if (!request.b) {
        throw aabb::input_error("collide: expected B, the other mesh, or --self");
    }
    if (request.first && request.count) throw aabb::input_error("--first and --count ask for different things");
    if (request.count && request.out) throw aabb::input_error("--count keeps no pairs, so there is nothing for --out");
    if (!request.geometry) return;
    if (request.count) throw aabb::input_error("--count keeps no pairs, so --geometry does not go with it");
    if (!request.out && !request.first)
        throw aabb::input_error("--geometry adds columns to the pairs, so give --out FILE, or --first for one pair");
    require_no_engine(request.engine);
}

void collide(const collide_request& request) {
    require_sense(request);
    detection_method method = method_of(request);
    const std::array<aabb::pose, 2> poses = {pose_of(request.poses[0], "--pose-a"),
                                             pose_of(request.poses[1], "--pose-b")};
    std::vector<std::string> names{request.a};
    if (request.b) names.push_back(*request.b);
    std::optional<number_table> table;
    if (request.out) {
        require_no_mesh(*request.out, names);
        std::string columns = request.self ? "a,b,shared_vertices" : "a,b";
        if (request.geometry) columns += "," + std::string(intersection_columns);
        table.emplace(*request.out, columns);
    }
    scene_play scene(std::make_unique<posed_meshes>(read_meshes(names), poses));
    const detection_result result = detect(request, method, scene, table ? &*table : nullptr);
    if (table) table->commit();
    if (request.json)
        print_json(method, result);
    else
        print_text(request, method, result);
}

}  // namespace

void add_collide(CLI::App& program, int&) {
    auto* command =
        program.add_subcommand("collide", "Local detection of two meshes: every pair of intersecting triangles");
    auto request = std::make_shared<collide_request>();
    command->add_option("A", request->a, "Mesh file, or a shape as in torus_knot:triangles=20000")
        ->required()
        ->type_name("");
    command->add_option("B", request->b, "The other one")->type_name("");
    command
        ->add_option("--pose-a", request->poses[0],
                     "Where A is: 12 numbers with commas between, the rows of [R t] (default: as it is)")
        ->type_name("M");
    command->add_option("--pose-b", request->poses[1], "Where B is")->type_name("M");
    request->local.add_to(*command);
    command->add_option("--engine", request->engine, "Reference system in place of build, tree and triangle test")
        ->type_name("E");
    command->add_flag("--self", request->self, "Hold A against itself; pairs that share a vertex are counted apart");
    command->add_flag("--first", request->first, "Stop at the first pair found");
    command->add_flag("--count", request->count, "Only count the pairs");
    command
        ->add_option("--out", request->out,
                     "Write the pairs, rows a,b (with --self a,b,shared_vertices), to this CSV file")
        ->type_name("FILE");
    command->add_flag("--geometry", request->geometry,
                      "Add to each pair what its triangles have in common, in the world: kind, corners, error");
    command->add_flag("--json", request->json, "Print the summary as JSON");
    command->callback([request] { collide(*request); });
}

}  // namespace aabblab
