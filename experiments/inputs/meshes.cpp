module aabblab.inputs;

import aabb.base;
import aabblab.files;
import aabblab.output;

namespace aabblab {

namespace {

/// Also where neither is there yet.
bool are_same_path(const std::string& a, const std::string& b) {
    std::error_code ignored;  // a file that is not there is no other's
    return std::filesystem::equivalent(a, b, ignored) ||
           std::filesystem::weakly_canonical(a) == std::filesystem::weakly_canonical(b);
}

}  // namespace

std::vector<aabb::mesh> read_meshes(const std::vector<std::string>& names) {
    std::vector<aabb::mesh> meshes;
    for (const std::string& name : names) {
        loaded_mesh loaded = make_mesh(name);
        if (const std::string report = loaded.report.text(); !report.empty()) note(name + ": " + report);
        meshes.push_back(std::move(loaded.mesh));
    }
    return meshes;
}

void note_left_out(const std::vector<std::string>& names, const std::filesystem::path& folder) {
    const std::vector<std::string> endings = mesh_endings();
    for (const std::string& name : std::set(names.begin(), names.end()))
        if (std::ranges::find(endings, mesh_ending_of(name_without_order(name, folder))) != endings.end())
            if (const std::string left_out = make_mesh(name, folder).report.left_out(); !left_out.empty())
                note(name + ": " + left_out);
}

void require_other_file(const std::string& out, const std::string& input) {
    std::error_code ignored;  // a file that is not there is no other's
    if (std::filesystem::equivalent(out, input, ignored))
        throw aabb::input_error(out + " would write over " + input + ", which this command reads");
}

void require_no_mesh(const std::string& out, const std::vector<std::string>& meshes) {
    std::vector<std::string> names;
    for (const std::string& name : meshes) names.emplace_back(name_without_order(name));
    for (const std::string& name : names) require_other_file(out, name);
    for (const std::string& name : names) require_other_file(out, (data_folder() / name).string());
    // A file of that name here would from now on hide the one in the data folder.
    for (const std::string& name : names)
        if (std::filesystem::weakly_canonical(name) == std::filesystem::weakly_canonical(out))
            throw aabb::input_error(out + " is the name of a mesh that this command reads from the data folder");
}

void require_two_files(const std::string& a, const std::string& file, const std::string& b, const std::string& other) {
    if (are_same_path(file, other)) throw aabb::input_error(a + " and " + b + " are the same file, " + file);
}

}  // namespace aabblab
