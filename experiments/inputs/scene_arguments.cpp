module aabblab.inputs;

import aabb.base;
import aabblab.files;

namespace aabblab {

namespace {

/// A shape, or a file that ends as meshes do; other files are motions.
bool names_mesh(const std::string& name) {
    if (!is_mesh(name, {})) return false;
    const std::vector<std::string> endings = mesh_endings();
    return !std::filesystem::exists(name) || std::ranges::find(endings, mesh_ending_of(name)) != endings.end();
}

}  // namespace

bool names_config(const std::string& argument) {
    return argument.ends_with(".toml");
}

scene_choice scene_of_arguments(const std::vector<std::string>& arguments) {
    const std::string& first = arguments.front();
    if (names_config(first))
        throw aabb::input_error(first +
                                " is a config, one of which explain and run take alone; expected a recording, "
                                "meshes, or a motion file and its meshes");
    if (first.ends_with(".aabbs")) {
        if (arguments.size() > 1)
            throw aabb::input_error("a recording is a scene of its own, so give " + first + " alone");
        return {"recording", {{"file", first}}, {}, std::nullopt, {}};
    }
    if (!names_mesh(first) && arguments.size() > 1) {
        const std::vector<std::string> meshes(arguments.begin() + 1, arguments.end());
        note_left_out(meshes);
        return {"motion", {{"file", first}}, meshes, std::nullopt, {}};
    }
    if (std::error_code ignored; !names_mesh(first) && std::filesystem::is_regular_file(first, ignored))
        throw aabb::input_error(first +
                                " is neither a recording (.aabbs) nor a mesh; if it is a motion file, its "
                                "meshes come after it");
    if (arguments.size() > 2)
        throw aabb::input_error("more than two meshes move by a motion file, which comes first; " + first +
                                " is a mesh");
    note_left_out(arguments);
    return {"mesh_pair", {{"normalise", "no"}}, arguments, 1, {}};
}

}  // namespace aabblab
