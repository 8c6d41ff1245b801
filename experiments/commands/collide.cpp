#include <nlohmann/json.hpp>

#include "command_parser.hpp"
#include "composing.hpp"
#include "distances.hpp"

import aabb.containment;
import aabb.geometry;
import aabb.touching;
import aabblab.configs;
import aabblab.drawing;
import aabblab.inputs;
import aabblab.numbers;
import aabblab.pair_output;

namespace aabblab {

namespace {

struct collide_request {
    std::string a;
    std::optional<std::string> b;
    std::array<std::optional<std::string>, 2> poses;
    method_options method{{aabb::stage::local_detection}};
    std::optional<std::string> out, draw, poses_of_b;
    std::size_t repeats = 1;
    std::optional<double> within;
    std::string self;  ///< a value of --self; empty without it
    bool touching = true, first = false, count = false, geometry = false, exit_code = false, json = false;
    bool distance = false, relation = false;

    [[nodiscard]] std::vector<std::string> meshes() const { return b ? std::vector{a, *b} : std::vector{a}; }
    /// The query: all pairs, the first or their number, of A and B or of A with itself, at one pose or many.
    [[nodiscard]] mesh_query query() const {
        const query_kind ask = count ? query_kind::count : first ? query_kind::first : query_kind::pairs;
        return {.ask = ask,
                .self = self.empty() ? std::nullopt : std::optional(self_pairs_of(self)),
                .hits = {.touching = touching, .geometry = geometry},
                .relations = relation,
                .by_pose = poses_of_b.has_value(),
                .repeats = repeats,
                .between = a + " against " + b.value_or("itself")};
    }
};

nlohmann::ordered_json geometry_of(const intersecting_pair& pair) {
    const aabb::triangle_intersection& common = *pair.common;
    nlohmann::ordered_json geometry{{"kind", name_of(common.kind)}};
    for (std::uint32_t i = 0; i < common.size; ++i) geometry["corners"].push_back(common.corners[i].at);
    geometry["error"] = common.error.at;
    return geometry;
}

/// Adds how the meshes lie at each pose without intersecting triangles, and the surfaces that this depends on.
void add_relations(nlohmann::ordered_json& summary, const collide_request& request, const mesh_result& result) {
    nlohmann::ordered_json relations, inside, meeting;
    for (const std::optional<mesh_relation>& lie : result.relations) {
        relations.push_back(lie && lie->solids ? nlohmann::ordered_json(name_of(*lie->solids)) : nullptr);
        nlohmann::ordered_json pairs = nlohmann::ordered_json::array();
        if (lie) {
            for (const auto [a, b] : lie->a_inside_b) pairs.push_back({a, b, "a_inside_b"});
            for (const auto [a, b] : lie->b_inside_a) pairs.push_back({a, b, "b_inside_a"});
        }
        inside.push_back(lie ? pairs : nullptr);
        nlohmann::ordered_json rows = nlohmann::ordered_json::array();
        if (lie)
            for (const aabb::component_contact& contact : lie->contacts)
                rows.push_back({contact.a, contact.b, name_of(contact.relation)});
        meeting.push_back(rows);
    }
    summary["relation"] = relations.empty() || request.poses_of_b ? relations : relations.front();
    summary["inside"] = inside.empty() || request.poses_of_b ? inside : inside.front();
    if (request.relation) summary["meeting"] = meeting.empty() || request.poses_of_b ? meeting : meeting.front();
    for (const surface_summary& surface : result.surfaces)
        summary["surfaces"].push_back(
            {{"components", surface.components},
             {"open", surface.open},
             {"open_edges", surface.open_edges},
             {"unoriented", surface.unoriented},
             {"inward", surface.inward},
             {"self_intersecting",
              surface.self_intersecting ? nlohmann::ordered_json(*surface.self_intersecting) : nullptr}});
    summary["relation_ms"] = result.relation_ms;
}

/// Prints one JSON object. With --poses, results are arrays by pose; values not asked for are null or absent.
void print_json(const collide_request& request, const mesh_result& result) {
    // `several` values stay an array even without --poses, such as the times of repeats.
    const auto by_pose = [&](nlohmann::ordered_json values, bool several = false) {
        return request.poses_of_b || several ? values : nlohmann::ordered_json(values.front());
    };
    nlohmann::ordered_json summary = {{"triangles", result.triangles},
                                      {"pairs", by_pose(result.counts)},
                                      {"kinds", nullptr},
                                      {"digest", nullptr},
                                      {"build_ms", result.build_ms},
                                      {"query_ms", by_pose(result.query_ms, request.repeats > 1)},
                                      {"bytes_per_triangle", nullptr}};
    nlohmann::ordered_json kinds;
    for (const kind_counts& counts : result.kinds) kinds.push_back(by_name(counts));
    if (!kinds.empty()) summary["kinds"] = by_pose(kinds);
    if (result.digest) summary["digest"] = *result.digest;
    if (result.bytes_per_triangle) summary["bytes_per_triangle"] = *result.bytes_per_triangle;
    if (result.neighbours) summary["neighbours"] = *result.neighbours;
    if (result.degenerate) summary["degenerate"] = *result.degenerate;
    nlohmann::ordered_json first, geometry;
    for (const std::optional<intersecting_pair>& pair : result.first) {
        first.push_back(pair ? nlohmann::ordered_json{pair->triangles.a, pair->triangles.b} : nullptr);
        geometry.push_back(pair && pair->common ? geometry_of(*pair) : nullptr);
    }
    if (request.first) summary["first"] = by_pose(first);
    if (request.first && request.geometry) summary["geometry"] = by_pose(geometry);
    if (request.self.empty()) add_relations(summary, request, result);
    summary["method"] = result.method.name;
    summary["exact"] = result.method.exact;
    summary["exact_for"] = nullptr;
    if (result.method.exact) summary["exact_for"] = request.self.empty() ? exact_for_meshes : "vertices in double";
    if (request.within) summary["within"] = *request.within;
    for (const aabb::part_bytes& part : result.bytes) summary["bytes"][part.part] = part.bytes;
    print(summary.dump() + "\n");
}

/// Describes a pair: "triangles 3 and 5 intersect: segment 2 …", "triangles 3 and 5 are within 0.5".
std::string text_of(const collide_request& request, const intersecting_pair& pair) {
    if (request.within)
        return fmt::format("triangles {} and {} are{}\n", pair.triangles.a, pair.triangles.b,
                           text_of_within(request.within));
    return fmt::format("triangles {} and {} intersect{}\n", pair.triangles.a, pair.triangles.b,
                       pair.common ? ": " + to_text(*pair.common) : "");
}

/// Prints the number of pairs and the digest in one line, then the numbers by kind of intersection. Plain --first
/// prints only the pair; with --poses too, a line per pose at which the meshes intersect precedes the others.
void print_results(const collide_request& request, const mesh_result& result) {
    if (request.first && !request.poses_of_b && result.first[0]) return print(text_of(request, *result.first[0]));
    if (request.poses_of_b)
        for (std::size_t pose = 0; pose < result.first.size(); ++pose)
            if (result.first[pose]) print(fmt::format("pose {}: {}", pose, text_of(request, *result.first[pose])));
    print(fmt::format(
        "{}{} of triangles{}{}{}\n", request.poses_of_b ? counted(result.counts.size(), "pose") + " of it: " : "",
        counted(std::accumulate(result.counts.begin(), result.counts.end(), std::uint64_t{0}),
                request.within ? "pair" : "intersecting pair"),
        text_of_within(request.within),
        request.self.empty() || request.query().self == self_pairs::intersecting ? "" : " that share no vertex",
        result.digest ? ", digest " + *result.digest : ""));
    kind_counts kinds{};
    for (const kind_counts& counts : result.kinds)
        for (std::size_t k = 0; k < kinds.size(); ++k) kinds[k] += counts[k];
    print(to_text(kinds));
    for (const std::string& sentence : sentences_about_relations(result)) print_paragraph(sentence);
    if (result.neighbours) print(fmt::format("{} more pairs that share a vertex\n", grouped(*result.neighbours)));
    if (result.degenerate.value_or(0) > 0) print(counted(*result.degenerate, "triangle") + " without area\n");
}

void print_text(const collide_request& request, const mesh_result& result) {
    const auto description_of = [&](const std::string& mesh, std::size_t i) {
        return visible(mesh) + " (" + counted(result.triangles[i], "triangle") + ")";
    };
    print(description_of(request.a, 0) + " against " + (request.b ? description_of(*request.b, 1) : "itself") + "\n");
    print_results(request, result);
    std::vector<double> ms = result.query_ms;
    std::ranges::nth_element(ms, ms.begin() + static_cast<std::ptrdiff_t>(ms.size() / 2));
    print(fmt::format("{}: built in {:.3f} ms, searched in {:.3f} ms{}\n", result.method.text(), result.build_ms,
                      ms[ms.size() / 2], ms.size() == 1 ? "" : fmt::format(" (median of {})", ms.size())));
    if (result.bytes_per_triangle) print(fmt::format("tree: {:.1f} bytes per triangle\n", *result.bytes_per_triangle));
    std::string bytes;
    for (const aabb::part_bytes& part : result.bytes)
        if (part.bytes > 0) bytes += fmt::format("{} {} {}", bytes.empty() ? "" : ",", part.part, grouped(part.bytes));
    print_paragraph("bytes:" + bytes);
}

/// Rejects options that exclude each other or would have no effect, before any file is read. `request.self` is empty
/// without --self, "true" for --self alone, and else the value in --self=all or --self=no-adjacent.
void reject_contradictions(const collide_request& request) {
    const auto reject_if = [](bool condition, const char* sentence) {
        if (condition) throw aabb::input_error(sentence);
    };
    if (request.self.empty()) {
        reject_if(!request.b, "collide: expected B, the other mesh, or --self");
    } else {
        (void)self_pairs_of(request.self);
        reject_if(request.b.has_value(), "--self takes one mesh, so give no second one");
        reject_if(request.poses[0] || request.poses[1] || request.poses_of_b,
                  "--self finds self-intersections, which no pose changes; omit the poses");
        reject_if(request.first && request.self != "true", "--first works with plain --self only");
        reject_if(!request.touching && request.self == "all",
                  "--self=all is about triangles that touch; give --touching=no with plain --self");
    }
    reject_if(request.within && (!request.self.empty() || request.geometry || request.relation || !request.touching),
              "--within finds triangles of two meshes that need not intersect; omit --self, --geometry, --relation and "
              "--touching");
    reject_if(request.distance && (!request.self.empty() || request.within || request.first || request.count ||
                                   request.geometry || request.relation || request.out || request.draw ||
                                   request.exit_code || !request.touching || request.repeats > 1),
              "--distance measures two meshes; beside it, give only poses, --build, --tree and --json");
    reject_if(request.poses[1] && request.poses_of_b, "--pose-b and --poses both set the pose of B; give one of them");
    reject_if(request.first && request.count, "--first and --count exclude each other");
    reject_if(request.count && request.out, "--count stores no pairs, so --out has nothing to write");
    reject_if(request.geometry && request.count, "--count stores no pairs, so --geometry cannot be combined with it");
    reject_if(request.relation && !request.self.empty(), "--relation is about two meshes, so omit --self");
    reject_if(request.relation && (request.first || request.count),
              "--relation needs all pairs, so omit --first and --count");
    reject_if(request.count && request.draw, "--count stores no pairs, so --draw has nothing to show");
    reject_if(request.poses_of_b && request.draw, "--draw shows one pose of B; give --pose-b instead of --poses");
    reject_if(request.geometry && !request.out && !request.first,
              "--geometry adds columns to the pairs, so give --out FILE, or --first for one pair");
}

/// Opens the CSV file of --out for the pairs, with this request's columns; it must not overwrite a mesh or pose file.
std::optional<number_table> open_rows(const collide_request& request) {
    if (!request.out) return std::nullopt;
    require_no_mesh(*request.out, request.meshes());
    if (request.poses_of_b) require_other_file(*request.out, *request.poses_of_b);
    std::string columns = request.query().self.value_or(self_pairs::no_adjacent) != self_pairs::no_adjacent
                              ? "a,b,shared_vertices"
                          : request.poses_of_b ? "pose,a,b"
                                               : "a,b";
    if (request.geometry) columns += "," + std::string(intersection_columns);
    return std::optional<number_table>(std::in_place, *request.out, columns);
}

/// Opens the file of --draw, which must not overwrite a mesh or the pairs.
std::optional<hit_drawing> open_drawing(const collide_request& request) {
    if (!request.draw) return std::nullopt;
    require_no_mesh(*request.draw, request.meshes());
    if (request.out) require_two_files("--out", *request.out, "--draw", *request.draw);
    return std::optional<hit_drawing>(std::in_place, *request.draw, "--draw");
}

/// Finds the intersecting triangles of two meshes, or of one with itself, and prints them. Bad options, poses and
/// outputs are rejected first, since reading and searching large meshes takes long.
/// @returns the exit status: 1 with --exit-code if any triangles intersect
int collide(const collide_request& request) {
    reject_contradictions(request);
    search_choice choice = request.method.choice();
    if (request.within || request.distance) require_no_triangle_test(choice);
    if (request.within) choice.within = nearness{*request.within};
    const aabb::pose pose_a = pose_of(request.poses[0], "--pose-a");
    given_poses poses_b{{pose_of(request.poses[1], "--pose-b")}, /*file=*/{}, /*lines=*/{}};
    if (request.poses_of_b) poses_b = read_poses(*request.poses_of_b);
    if (request.distance) {
        print_distances(request.meshes(), measure_distances(choice, read_meshes(request.meshes()), pose_a, poses_b),
                        request.poses_of_b.has_value(), request.json);
        return 0;
    }
    std::optional<number_table> rows = open_rows(request);
    std::optional<hit_drawing> drawing = open_drawing(request);
    const mesh_result result =
        search_meshes(request.query(), choice, read_meshes(request.meshes()), pose_a, std::move(poses_b),
                      rows ? &*rows : nullptr, drawing ? &*drawing : nullptr);
    if (rows) rows->commit();
    if (drawing) drawing->commit();
    if (request.json)
        print_json(request, result);
    else
        print_text(request, result);
    const bool intersect = std::ranges::any_of(result.counts, [](std::uint64_t count) { return count > 0; });
    return request.exit_code && intersect ? 1 : 0;
}

}  // namespace

void add_collide(const command_parser& program) {
    const command_parser command =
        program.add_command("collide", "Run the narrow phase on two meshes: find every pair of intersecting triangles");
    auto& request = command.set_action(collide);
    command.argument("A", &request.a,
                     "Mesh file (OFF, OBJ, PLY, STL, glTF), or a shape as in torus_knot:triangles=20000; :order=sah "
                     "after a file, or ,order=sah after the parameters of a shape, sorts and renumbers its triangles "
                     "by the leaves of a tree; pairs have the new numbers");
    command.optional_argument("B", &request.b, "The other mesh");
    command.option("--pose-a M", &request.poses[0],
                   "Pose of A: 12 numbers, the rows of [R t], separated by commas (default: the identity)");
    command.option("--pose-b M", &request.poses[1], "Pose of B");
    command.option("--poses FILE", &request.poses_of_b,
                   "Search with B at each pose of this file, one per line, as for --pose-b; trees are built once");
    request.method.add_to(command, "build, tree and triangle test");
    command.flag(
        "--self [=all|no-adjacent]", &request.self,
        "Find self-intersections of A: pairs of triangles that meet outside their shared corners (of equal "
        "coordinates) and edge; all: every pair with a common point, adjacent triangles included; no-adjacent: only "
        "pairs without a shared corner");
    add_touching(command, &request.touching, "pairs");
    add_within(command, &request.within, "triangles");
    command.flag("--distance", &request.distance,
                 "Measure the distance of A and B instead, with a bound on its error, and where it is attained");
    command.flag("--first", &request.first, "Stop at the first pair found");
    command.flag("--count", &request.count, "Count the pairs without storing them");
    const auto take_repeats = [&request](const std::string& text) {
        request.repeats =
            parse_whole(text, 1, 1'000'000, "--repeat is the number of searches: a whole number from 1 to 1,000,000");
    };
    command.option("--repeat N", take_repeats, "Search N times at each pose; --json lists the time of every search");
    command.option(
        "--out FILE", &request.out,
        "File for the pairs, CSV, .npy or .json: rows a,b; with --self a,b,shared_vertices; --self=no-adjacent a,b; "
        "--poses pose,a,b");
    command.flag("--geometry", &request.geometry,
                 "Add to each pair the triangles' intersection, in world coordinates: columns kind, number of "
                 "vertices, error bounds on x, y, z, vertices");
    command.flag(
        "--relation", &request.relation,
        "Say also of components that share points how they lie: they touch, one of them from inside or not, or "
        "cross; of others this is said anyway");
    command.option("--draw FILE", &request.draw,
                   "Draw the meshes at their poses to this file (.ply, .obj): triangles that intersect in red, their "
                   "intersections as black lines");
    command.flag("--exit-code", &request.exit_code,
                 "Exit with status 1 (as diff) if triangles intersect, or with --within if any are within D; with "
                 "--self=all, only if two without a shared corner intersect");
    command.flag("--json", &request.json, "Print the summary as JSON");
}

}  // namespace aabblab
