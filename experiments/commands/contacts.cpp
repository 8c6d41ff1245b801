#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "command_parser.hpp"
#include "commands.hpp"
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
import aabb.selection;
import aabb.validation;
import aabblab.digits;
import aabblab.files;
import aabblab.numbers;
import aabblab.pair_output;
import aabblab.play;
import aabblab.progress;
import aabblab.stopwatch;

namespace aabblab {

namespace {

struct contacts_request {
    std::string motion;
    std::vector<std::string> meshes;
    stage_options global{aabb::stage::global_search};
    stage_options local{aabb::stage::local_detection};
    std::optional<std::string> engine, out;
    bool geometry = false;
    bool json = false;
};

struct both_stages {
    std::string name;
    bool exact;
    stages made;
    std::optional<hit_geometry> geometry;  ///< with --geometry
};

struct contacts_result {
    std::size_t objects = 0;
    std::size_t candidates = 0;
    std::size_t object_pairs = 0;  ///< in contact, summed over the frames
    std::size_t contacts = 0;
    std::string digest;
    double build_ms = 0;
    std::vector<double> milliseconds;  ///< by frame
};

both_stages stages_of(const contacts_request& request, const aabb::scene_outlook& outlook) {
    aabb::named_strategies named;
    request.global.add_to(named);
    request.local.add_to(named);
    const aabb::composition c = select_composition(named, outlook);
    const std::string global = to_text(c, aabb::stage::global_search);
    const bool exact = is_exact(c, aabb::stage::global_search);
    if (request.engine) {
        if (request.local.any())
            throw aabb::input_error("--engine stands in for " + request.local.names() + ", so give it without them");
        return {global + ", " + *request.engine,
                exact && aabb::is_exact_engine(*request.engine),
                {aabb::compose_global_search(c, aabb::instrumentation::none), aabb::make_mesh_engine(*request.engine)},
                {}};
    }
    both_stages both{global + ", " + to_text(c, aabb::stage::local_detection),
                     exact && is_exact(c, aabb::stage::local_detection),
                     {aabb::compose_global_search(c, aabb::instrumentation::none),
                      aabb::compose_local_detection(c, aabb::instrumentation::none)},
                     {}};
    if (request.geometry) both.geometry.emplace(c[aabb::strategy_kind::triangle]);
    return both;
}

std::size_t count_object_pairs(std::span<const aabb::contact> sorted) {
    std::size_t pairs = 0;
    for (std::size_t i = 0; i < sorted.size(); ++i)
        pairs += i == 0 || sorted[i].a != sorted[i - 1].a || sorted[i].b != sorted[i - 1].b;
    return pairs;
}

/// The rows of a frame.
void add_rows(number_table& table, const played_frame& frame, const scene_play& scene,
              std::optional<hit_geometry>& geometry) {
    const auto mesh_of = [&](std::uint32_t object) -> const aabb::mesh& {
        return scene.meshes()->meshes[scene.meshes()->mesh_of[object]];
    };
    const aabb::contact* before = nullptr;
    for (const aabb::contact& c : frame.contacts) {
        std::string cells;
        if (geometry) {
            if (before == nullptr || before->a != c.a || before->b != c.b)
                geometry->take(mesh_of(c.a), scene.poses()[c.a], mesh_of(c.b), scene.poses()[c.b]);
            cells = to_cells((*geometry)({c.triangle_a, c.triangle_b}));
            before = &c;
        }
        table.add({frame.number, c.a, c.b, c.triangle_a, c.triangle_b}, cells);
    }
}

contacts_result detect_all(scene_play& scene, both_stages& both, std::optional<number_table>& table) {
    contacts_result result;
    result.objects = scene.objects();
    std::optional<player> who;
    result.build_ms = milliseconds_of([&] { who.emplace(std::move(both.made), scene); });
    progress shown("frames searched", scene.frames());
    aabb::digest digest;
    play(scene, *who, [&](const played_frame& frame) {
        result.milliseconds.push_back(whole_nanoseconds(frame.ms()));
        require_each_once(frame.contacts, fmt::format("{}, frame {}", both.name, frame.number));
        for (const aabb::contact& c : frame.contacts)
            digest.add(std::array{frame.number, c.a, c.b, c.triangle_a, c.triangle_b});
        if (table) add_rows(*table, frame, scene, both.geometry);
        result.candidates += frame.pairs.size();
        result.object_pairs += count_object_pairs(frame.contacts);
        result.contacts += frame.contacts.size();
        shown.at(frame.number + 1);
    });
    result.digest = digest.text();
    return result;
}

void print_json(const both_stages& both, const contacts_result& result) {
    const nlohmann::ordered_json summary = {{"objects", result.objects},
                                            {"frames", result.milliseconds.size()},
                                            {"candidates", result.candidates},
                                            {"object_pairs", result.object_pairs},
                                            {"contacts", result.contacts},
                                            {"digest", result.digest},
                                            {"build_ms", result.build_ms},
                                            {"ms", result.milliseconds},
                                            {"method", both.name},
                                            {"exact", both.exact}};
    print(summary.dump() + "\n");
}

void print_text(const contacts_request& request, const both_stages& both, const contacts_result& result) {
    double all = 0;
    for (const double ms : result.milliseconds) all += ms;
    print(fmt::format("{}: {}, {}\n", visible(request.motion), counted(result.objects, "object"),
                      counted(result.milliseconds.size(), "frame")));
    print(fmt::format("{} of triangles in {} of objects ({} of boxes), digest {}\n",
                      counted(result.contacts, "contact"), counted(result.object_pairs, "contact"),
                      counted(result.candidates, "pair"), result.digest));
    print(fmt::format("{}{}: built in {:.3f} ms, {:.3f} ms a frame (mean of all)\n", both.name,
                      both.exact ? "" : " (inexact)", result.build_ms,
                      all / static_cast<double>(result.milliseconds.size())));
}

void find_contacts(const contacts_request& request) {
    if (request.geometry && !request.out)
        throw aabb::input_error("--geometry adds columns to the contacts, so give --out FILE");
    if (request.geometry) require_no_engine(request.engine);
    // What makes no sense is refused before anything is read.
    static_cast<void>(stages_of(request, {}));
    std::optional<number_table> table;
    if (request.out) {
        require_other_file(*request.out, {&request.motion, 1});
        require_no_mesh(*request.out, request.meshes);
        std::string columns = "frame,object_a,object_b,triangle_a,triangle_b";
        if (request.geometry) columns += "," + std::string(intersection_columns);
        table.emplace(*request.out, columns);
    }
    scene_play scene(open_motion(request.motion, read_meshes(request.meshes)), request.motion);
    both_stages both = stages_of(request, outlook_of(scene));
    const contacts_result result = detect_all(scene, both, table);
    if (table) table->commit();
    if (request.json)
        print_json(both, result);
    else
        print_text(request, both, result);
}

}  // namespace

void add_contacts(const command_parser& program, int&) {
    const command_parser command = program.add_command(
        "contacts", "Both stages on meshes that a file moves: the triangles in contact, by frame and pair of objects");
    auto request = std::make_shared<contacts_request>();
    command
        .add_option("MOTION", request->motion,
                    "Text file; a line is a frame, an object and 12 numbers, the rows of its pose [R t]")
        .required()
        .type_name("");
    command
        .add_option("MESH", request->meshes,
                    "Mesh files (OFF, OBJ, PLY, STL, glTF) or shapes; object i is mesh i, from the first again when "
                    "they run out")
        .required()
        .type_name("");
    request->global.add_to(command);
    request->local.add_to(command);
    command.add_option("--engine", request->engine, "Reference system in place of build, tree and triangle test")
        .type_name("E");
    command
        .add_option("--out", request->out,
                    "Write the contacts, rows frame,object_a,object_b,triangle_a,triangle_b, to this CSV file")
        .type_name("FILE");
    command.add_flag("--geometry", request->geometry,
                     "Add to each contact what its triangles have in common, in the world: kind, corners, error");
    command.add_flag("--json", request->json, "Print the summary as JSON");
    command.callback([request] { find_contacts(*request); });
}

}  // namespace aabblab
