#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <memory>
#include <string>

#include "commands.hpp"
#include "output.hpp"

// Imports, so it comes last.
#include "composing.hpp"

import aabb.geometry;
import aabb.policy;
import aabb.registry;
import aabblab.files;
import aabblab.numbers;

namespace aabblab {

namespace {

struct order_request {
    std::string mesh;
    std::string build = "sah";
    std::string out;
};

void write_ordered(const order_request& request) {
    const aabb::strategy_choice build = aabb::parse_strategy(request.build);
    require_known(aabb::strategy_kind::build, build);
    require_no_mesh(request.out, {request.mesh});
    const aabb::mesh ordered = aabb::in_leaf_order(read_meshes({request.mesh}).front(), build);
    write_off(ordered, request.out);
    print(fmt::format("wrote {}: {}\n", visible(request.out), counted(ordered.triangles.size(), "triangle")));
}

}  // namespace

void add_order(CLI::App& program, int&) {
    auto* command = program.add_subcommand("order", "Write a mesh in the order of a tree's leaves, for smaller trees");
    auto request = std::make_shared<order_request>();
    command->add_option("MESH", request->mesh, "Mesh file or shape")->required()->type_name("");
    command->add_option("--build", request->build, "The build whose leaves they are (default sah)")->type_name("S");
    command->add_option("--out", request->out, "The mesh to write (OFF)")->required()->type_name("FILE");
    command->footer(
        "With --build file_order --tree implicit:vertices=fetched, a tree of such a mesh takes 1.2 bytes a triangle.\n"
        "Triangles and vertices are numbered as they stand in the file that is written.");
    command->callback([request] { write_ordered(*request); });
}

}  // namespace aabblab
