module aabblab.files;

import :mesh_builder;

namespace aabblab {

namespace {

struct format {
    std::string_view ending;
    loaded_mesh (*read)(const file_text&);
    bool (*is_text)(std::string_view bytes);
};
constexpr auto always = [](std::string_view) { return true; };
/// Detects JSON by its first character or a byte order mark; the reader rejects any other file that is not binary.
constexpr auto is_gltf_text = [](std::string_view bytes) {
    const std::size_t begin = std::min(bytes.find_first_not_of(" \t\r\n"), bytes.size());
    return text_encoding_of(bytes) != text_encoding::utf8 || bytes.starts_with("\xef\xbb\xbf") ||
           bytes.substr(begin).starts_with('{');
};
constexpr format formats[] = {{".off", read_off, always},         {".obj", read_obj, always},
                              {".ply", read_ply, is_text_ply},    {".stl", read_stl, is_text_stl},
                              {".gltf", read_gltf, is_gltf_text}, {".glb", read_gltf, is_gltf_text}};

/// Appends to a comma-separated list.
void add(std::string& text, const std::string& sentence) {
    text += (text.empty() ? "" : ", ") + sentence;
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

/// The part of the report about what was left out, which a message also quotes when no triangles are left.
std::string mesh_report::left_out() const {
    std::string line;
    if (dropped) add(line, counted(dropped, "face") + " of fewer than three corners dropped");
    if (stitches) add(line, counted(stitches, "triangle") + " of strips skipped, which repeat a corner");
    if (not_finite)
        add(line, counted(not_finite, "vertex", "vertices") +
                      " with NaN or infinity, which no face uses, moved onto another");
    if (animations) add(line, counted(animations, "animation") + " ignored");
    if (hidden_meshes) add(line, counted(hidden_meshes, "mesh", "meshes") + " outside the scene left out");
    for (const auto& [what, name, n] : skipped) add(line, counted(n, what) + " " + in_quotes(name) + " skipped");
    if (skipped_others) add(line, std::to_string(skipped_others) + " of other names skipped");
    return line;
}

/// What reading changed or left out, in one line for the user; empty for most files.
std::string mesh_report::text() const {
    std::string line;
    if (polygons > concave) add(line, counted(polygons - concave, "polygon") + " fan-triangulated");
    if (concave) add(line, counted(concave, "concave polygon") + " ear-clipped");
    if (zero_area) add(line, counted(zero_area, "triangle") + " of zero area kept");
    if (const std::string others = left_out(); !others.empty()) add(line, others);
    return line;
}

/// Reads a mesh in the format of the file's extension. Its bytes show whether it is text, which is decoded first.
loaded_mesh read_mesh(const std::filesystem::path& file) {
    const std::size_t size = require_file(file);
    const std::string ending = mesh_ending_of(file);
    const auto reader = std::ranges::find(formats, ending, &format::ending);
    if (reader == std::end(formats)) reject(file, aabb::unknown_name("mesh format", ending, mesh_endings()));
    if (ending == ".stl")
        if (std::optional<loaded_mesh> binary = read_binary_stl(file, size)) return *std::move(binary);
    // The limit on memory is for the text and the mesh, which takes about as much again.
    file_text content = read_file(file, size, /*memory_factor=*/2);
    if (reader->is_text(content.text)) content = as_text(std::move(content));
    return reader->read(content);
}

/// Writes a mesh in the format OFF: the numbers of vertices, triangles and edges (0: not counted), then the coordinates
/// of each vertex, then each triangle as "3 a b c". Writes in blocks, so that the text is never in memory as a whole.
void write_off(const aabb::mesh& mesh, const std::filesystem::path& file) {
    output_file out(file);
    std::string text =
        "OFF\n" + std::to_string(mesh.vertices.size()) + " " + std::to_string(mesh.triangles.size()) + " 0\n";
    const auto write_full_block = [&] {
        if (text.size() < 1U << 16) return;
        out.write(text);
        text.clear();
    };
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
        const aabb::vec3d p = mesh.given_vertex(v);
        text += aabb::shortest(p[0]) + ' ' + aabb::shortest(p[1]) + ' ' + aabb::shortest(p[2]) + '\n';
        write_full_block();
    }
    for (const auto& [a, b, c] : mesh.triangles) {
        text += "3 " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
        write_full_block();
    }
    out.write(text);
    out.commit();
}

}  // namespace aabblab
