#include "command_parser.hpp"
#include "composing.hpp"

import aabblab.files;
import aabblab.inputs;
import aabblab.numbers;
import aabblab.pair_output;

namespace aabblab {

namespace {

struct order_request {
    std::string mesh;
    std::string build = "sah";
    std::string out;
    std::optional<std::string> numbers;
};

/// Writes the mesh with triangles in leaf order, which needs no indices; with --numbers also the original ones.
void write_ordered(const order_request& request) {
    const aabb::strategy_choice build = aabb::parse_strategy(request.build);
    require_known(aabb::strategy_kind::build, build);
    const std::string ending = mesh_ending_of(request.out);
    if (ending != ".off")
        throw aabb::input_error(fmt::format("order writes OFF, so --out must end in .off, not '{}'", ending));
    require_no_mesh(request.out, {request.mesh});
    std::optional<number_table> numbers;
    if (request.numbers) {
        require_no_mesh(*request.numbers, {request.mesh});
        require_two_files("--out", request.out, "--numbers", *request.numbers);
        numbers.emplace(*request.numbers, "triangle,was");
    }
    const aabb::ordered_mesh reordered = in_leaf_order(read_meshes({request.mesh}).front(), build);
    write_off(reordered.ordered, request.out);
    print(fmt::format("wrote {}: {}\n", visible(request.out), counted(reordered.triangles.size(), "triangle")));
    if (!numbers) return;
    for (std::uint32_t t = 0; t < reordered.triangles.size(); ++t) numbers->add({t, reordered.triangles[t]});
    numbers->commit();
    print(fmt::format("wrote {}: the original index of each triangle\n", visible(*request.numbers)));
}

}  // namespace

void add_order(const command_parser& program) {
    const command_parser command = program.add_command(
        "order", "Sort the triangles of a mesh by the leaves of a tree, which then needs no triangle indices");
    auto& request = command.set_action(write_ordered);
    command.argument("MESH", &request.mesh, "Mesh file (OFF, OBJ, PLY, STL, glTF) or shape");
    command.option("--build S", &request.build,
                   "Build of the tree: one of " + listed_names(aabb::strategy_kind::build) + " (default sah)");
    command.option("--out FILE", &request.out, "Mesh file to write (.off)").required();
    command.option("--numbers FILE", &request.numbers, "CSV file for the original indices: rows triangle,was");
    command.footer(
        "For such a mesh, the build file_order with the tree implicit:vertices=fetched (read from the mesh, not "
        "copied) stores only boxes, the smallest around eight triangles, in 1.2 bytes per triangle. collide, contacts "
        "and configs also accept FILE:order=BUILD and SHAPE:triangles=N,order=BUILD, which need no file. Sorting twice "
        "gives another order, as a build depends on the order of its input.");
}

}  // namespace aabblab
