#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

// Imports, so it comes last.
#include "scene_arguments.hpp"

import aabb.base;
import aabblab.files;
import aabblab.scenes;

namespace aabblab {

namespace {

/// A shape, or a file that ends as meshes do; other files are motions.
bool names_mesh(const std::string& name) {
    if (!is_mesh(name, {})) return false;
    const std::vector<std::string> endings = mesh_endings();
    return !std::filesystem::exists(name) || std::ranges::find(endings, mesh_ending_of(name)) != endings.end();
}

}  // namespace

bool names_scene(const std::vector<std::string>& arguments) {
    return arguments.size() > 1 || arguments.front().ends_with(".aabbs") || names_mesh(arguments.front());
}

scene_choice scene_of_arguments(const std::vector<std::string>& arguments) {
    const std::string& first = arguments.front();
    if (first.ends_with(".aabbs")) {
        if (arguments.size() > 1)
            throw aabb::input_error("a recording is a scene of its own, so give " + first + " alone");
        return {"recording", {{"file", first}}, {}, std::nullopt, {}};
    }
    if (!names_mesh(first) && arguments.size() > 1)
        return {"motion", {{"file", first}}, {arguments.begin() + 1, arguments.end()}, std::nullopt, {}};
    if (arguments.size() > 2)
        throw aabb::input_error("more than two meshes move by a motion file, which comes first; " + first +
                                " is a mesh");
    // Says what is wrong with a name that is neither a mesh nor anything else.
    for (const std::string& name : arguments) (void)make_mesh(name);
    return {"mesh_pair", {{"normalise", "no"}}, arguments, 1, {}};
}

}  // namespace aabblab
