module;
#include <algorithm>
#include <cctype>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

module aabblab.files;

import aabb.base;
import aabb.geometry;
import aabb.policy;
import :file_text;
import :loaded_mesh;
import :readers;

namespace aabblab {

namespace {

struct format {
    std::string_view ending;
    loaded_mesh (*read)(const file_text&);
};
constexpr format formats[] = {{".off", read_off}, {".obj", read_obj},   {".ply", read_ply},
                              {".stl", read_stl}, {".gltf", read_gltf}, {".glb", read_gltf}};

std::string counted(std::size_t count, std::string_view one, std::string_view many) {
    return std::to_string(count) + " " + std::string(count == 1 ? one : many);
}

}  // namespace

std::string mesh_ending_of(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return ending;
}

std::vector<std::string> mesh_endings() {
    std::vector<std::string> endings;
    for (const format& f : formats) endings.emplace_back(f.ending);
    return endings;
}

std::string mesh_report::text() const {
    std::string all;
    const auto say = [&](const std::string& sentence) { all += (all.empty() ? "" : ", ") + sentence; };
    if (polygons > concave) say(counted(polygons - concave, "polygon", "polygons") + " fanned");
    if (concave) say(counted(concave, "concave polygon", "concave polygons") + " cut by ears");
    if (zero_area) say(counted(zero_area, "triangle", "triangles") + " of zero area kept");
    if (rounded) say(counted(rounded, "coordinate", "coordinates") + " rounded to float");
    if (dropped) say(counted(dropped, "face", "faces") + " of fewer than three corners dropped");
    if (animations) say(counted(animations, "animation", "animations") + " ignored");
    if (hidden_meshes) say(counted(hidden_meshes, "mesh", "meshes") + " outside the scene left out");
    return all;
}

loaded_mesh read_mesh(const std::filesystem::path& file) {
    const std::size_t size = require_file(file);
    const std::string ending = mesh_ending_of(file);
    const auto found = std::ranges::find(formats, ending, &format::ending);
    if (found == std::end(formats))
        throw aabb::input_error(file.string() + ": " + aabb::unknown_name("mesh format", ending, mesh_endings()));
    // A mesh takes about as much again as its text.
    return found->read(read_whole(file, size, 2));
}

void write_off(const aabb::mesh& mesh, const std::filesystem::path& file) {
    output_file out(file);
    std::string text =
        "OFF\n" + std::to_string(mesh.vertices.size()) + " " + std::to_string(mesh.triangles.size()) + " 0\n";
    const auto pass_on = [&](std::size_t least) {
        if (text.size() < least) return;
        out.write(text);
        text.clear();
    };
    for (const aabb::vec3f& p : mesh.vertices) {
        for (int k = 0; k < 3; ++k) {
            text += aabb::shortest(p[k]);
            text += k < 2 ? ' ' : '\n';
        }
        pass_on(1U << 16);
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
        pass_on(1U << 16);
    }
    pass_on(0);
    out.commit();
}

}  // namespace aabblab
