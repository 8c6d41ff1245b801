#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "number.hpp"
#include "output.hpp"
#include "stopwatch.hpp"

import aabb;
import aabb.registry;
import aabb.validation;
import aabblab.files;
import aabblab.pair_output;
import aabblab.scenes;

namespace aabblab {

namespace {

struct collide_request {
    std::array<std::string, 2> meshes;
    std::array<std::optional<std::string>, 2> poses;
    std::optional<std::string> tree, triangle, engine, out;
    bool first = false;
    bool json = false;
};

struct detection_method {
    std::string name;
    std::unique_ptr<aabb::local_stage> stage;
};

struct detection_result {
    std::array<std::uint32_t, 2> triangles{};
    std::vector<aabb::index_pair> pairs;
    std::string digest;
    double build_ms = 0;
    double query_ms = 0;
    std::optional<double> bytes_per_triangle;  ///< none for an engine that does not say
};

detection_method method_of(const collide_request& request) {
    if (request.engine) {
        if (request.tree || request.triangle)
            throw aabb::input_error("--engine stands in for --tree and --triangle, so give it alone");
        return {*request.engine, aabb::make_mesh_engine(*request.engine)};
    }
    aabb::local_composition composition;
    if (request.tree) composition.tree = aabb::parse_strategy(*request.tree);
    if (request.triangle) composition.triangle = aabb::parse_strategy(*request.triangle);
    return {aabb::to_text(composition), aabb::compose(composition, aabb::instrumentation::none)};
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

aabb::mesh read(const std::string& name) {
    loaded_mesh loaded = make_mesh(name);
    if (const std::string report = loaded.report.text(); !report.empty()) note(name + ": " + report);
    return std::move(loaded.mesh);
}

detection_result detect(const detection_method& method, const std::array<aabb::mesh, 2>& meshes,
                        const std::array<aabb::pose, 2>& poses, bool first) {
    detection_result result;
    std::array<std::uint32_t, 2> models{};
    result.triangles = {meshes[0].triangle_count(), meshes[1].triangle_count()};
    result.build_ms = milliseconds_of([&] {
        for (std::size_t i = 0; i < 2; ++i) models[i] = method.stage->add_model(meshes[i]);
    });
    result.query_ms = milliseconds_of([&] {
        if (!first) return method.stage->all_pairs(models[0], poses[0], models[1], poses[1], result.pairs);
        if (const auto pair = method.stage->first_pair(models[0], poses[0], models[1], poses[1]))
            result.pairs.push_back(*pair);
    });
    sort_each_once(result.pairs, method.name);
    aabb::digest digest;
    digest.add(0, result.pairs);
    result.digest = digest.text();
    for (const aabb::part_bytes& part : method.stage->bytes())
        if (part.part == "tree")
            result.bytes_per_triangle =
                static_cast<double>(part.bytes) / (double{0} + result.triangles[0] + result.triangles[1]);
    return result;
}

void print_json(const detection_result& result) {
    nlohmann::ordered_json summary = {{"triangles", result.triangles}, {"pairs", result.pairs.size()},
                                      {"digest", result.digest},       {"build_ms", result.build_ms},
                                      {"query_ms", result.query_ms},   {"bytes_per_triangle", nullptr}};
    if (result.bytes_per_triangle) summary["bytes_per_triangle"] = *result.bytes_per_triangle;
    print(summary.dump() + "\n");
}

void print_text(const collide_request& request, const detection_method& method, const detection_result& result) {
    print(fmt::format("{} ({} triangles) against {} ({} triangles)\n", request.meshes[0], result.triangles[0],
                      request.meshes[1], result.triangles[1]));
    if (request.first && !result.pairs.empty())
        print(fmt::format("triangles {} and {} intersect\n", result.pairs[0].a, result.pairs[0].b));
    else
        print(fmt::format("{} intersecting pairs of triangles, digest {}\n", result.pairs.size(), result.digest));
    print(fmt::format("{}: built in {:.3f} ms, searched in {:.3f} ms", method.name, result.build_ms, result.query_ms));
    if (result.bytes_per_triangle) print(fmt::format(", {:.1f} bytes a triangle", *result.bytes_per_triangle));
    print("\n");
}

void collide(const collide_request& request) {
    const detection_method method = method_of(request);
    const std::array<aabb::pose, 2> poses = {pose_of(request.poses[0], "--pose-a"),
                                             pose_of(request.poses[1], "--pose-b")};
    const std::array<aabb::mesh, 2> meshes = {read(request.meshes[0]), read(request.meshes[1])};
    std::optional<pair_table> table;
    if (request.out) {
        require_other_file(*request.out, request.meshes);
        table.emplace(*request.out, pair_table::columns::a_b);
    }
    const detection_result result = detect(method, meshes, poses, request.first);
    if (table) {
        table->add(0, result.pairs);
        table->commit();
    }
    if (request.json)
        print_json(result);
    else
        print_text(request, method, result);
}

}  // namespace

void add_collide(CLI::App& program, int&) {
    auto* command =
        program.add_subcommand("collide", "Local detection of two meshes: every pair of intersecting triangles");
    auto request = std::make_shared<collide_request>();
    command->add_option("A", request->meshes[0], "Mesh file, or a shape as in torus_knot:triangles=20000")
        ->required()
        ->type_name("");
    command->add_option("B", request->meshes[1], "The other one")->required()->type_name("");
    command
        ->add_option("--pose-a", request->poses[0],
                     "Where A is: 12 numbers with commas between, the rows of [R t] (default: as it is)")
        ->type_name("M");
    command->add_option("--pose-b", request->poses[1], "Where B is")->type_name("M");
    command->add_option("--tree", request->tree, "Tree (default canonical)")->type_name("T");
    command->add_option("--triangle", request->triangle, "Triangle test (default exact)")->type_name("R");
    command->add_option("--engine", request->engine, "Reference system in place of tree and triangle test")
        ->type_name("E");
    command->add_flag("--first", request->first, "Stop at the first pair found");
    command->add_option("--out", request->out, "Write the pairs, rows a,b, to this CSV file")->type_name("FILE");
    command->add_flag("--json", request->json, "Print the summary as JSON");
    command->callback([request] { collide(*request); });
}

}  // namespace aabblab
