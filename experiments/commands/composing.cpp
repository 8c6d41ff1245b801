#include <CLI/CLI.hpp>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "output.hpp"

// Imports, so it comes last.
#include "composing.hpp"

import aabb;
import aabb.registry;
import aabblab.files;
import aabblab.scenes;

namespace aabblab {

void global_options::add_to(CLI::App& command) {
    command.add_option("--sort", sort, "Sort (default std)")->type_name("S");
    command.add_option("--partition", partition, "Partition (default none)")->type_name("P");
    command.add_option("--sweep", sweep, "Sweep, as in one_axis:axis=x (default one_axis)")->type_name("W");
    command
        .add_option("--split-large,--split_large", split_large,
                    "Split boxes longer than this many mean extents first (default off)")
        ->type_name("SIZE");
}

aabb::global_composition global_options::composition() const {
    aabb::global_composition made;
    if (sort) made.sort = aabb::parse_strategy(*sort);
    if (partition) made.partition = aabb::parse_strategy(*partition);
    if (sweep) made.sweep = aabb::parse_strategy(*sweep);
    if (split_large) made.split_large = aabb::parse_split_large(*split_large);
    return made;
}

void local_options::add_to(CLI::App& command) {
    command.add_option("--tree", tree, "Tree (default canonical)")->type_name("T");
    command.add_option("--triangle", triangle, "Triangle test (default exact)")->type_name("R");
}

aabb::local_composition local_options::composition() const {
    aabb::local_composition made;
    if (tree) made.tree = aabb::parse_strategy(*tree);
    if (triangle) made.triangle = aabb::parse_strategy(*triangle);
    return made;
}

void require_no_mesh(const std::string& out, const std::vector<std::string>& meshes) {
    std::vector<std::string> files = meshes;
    for (const std::string& name : meshes) files.push_back((data_folder() / name).string());
    require_other_file(out, files);
    // A file of that name here would from now on hide the one in the data folder.
    for (const std::string& name : meshes)
        if (std::filesystem::weakly_canonical(name) == std::filesystem::weakly_canonical(out))
            throw aabb::input_error(out + " is the name of a mesh that this command reads from the data folder");
}

std::vector<aabb::mesh> read_meshes(const std::vector<std::string>& names) {
    std::vector<aabb::mesh> meshes;
    for (const std::string& name : names) {
        loaded_mesh loaded = make_mesh(name);
        if (const std::string report = loaded.report.text(); !report.empty()) note(name + ": " + report);
        meshes.push_back(std::move(loaded.mesh));
    }
    return meshes;
}

}  // namespace aabblab
