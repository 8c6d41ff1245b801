module;
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

module aabblab.files;

import :file_text;
import :mesh_builder;
import :readers;
import :text_scanner;

namespace aabblab {

namespace {

/// "OFF", after any of ST, C, N: colours, normals and texture coordinates follow the position and are skipped.
void read_keyword(text_scanner& in) {
    if (!in.next_line()) in.ends("before the keyword OFF");
    const std::string_view keyword = in.word();
    const std::size_t at = keyword.find("OFF");
    if (at == std::string_view::npos) in.expected("the keyword OFF", keyword);
    std::string_view before = keyword.substr(0, at);
    for (const std::string_view mark : {"ST", "C", "N"})
        if (before.starts_with(mark)) before.remove_prefix(mark.size());
    if (before == "4" || before == "n" || before == "4n") in.fail("only OFF in three dimensions is read");
    if (!before.empty()) in.expected("the keyword OFF", keyword);
    // Some writers put the first count right behind the keyword.
    in.back_to(keyword.substr(at + 3));
}

}  // namespace

loaded_mesh read_off(const file_text& file) {
    text_scanner in(file, '#');
    read_keyword(in);
    if (!in.more() && !in.next_line()) in.ends("before the numbers of vertices and faces");
    const auto vertices = in.whole<std::uint64_t>("the number of vertices");
    const auto faces = in.whole<std::uint64_t>("the number of faces");

    mesh_builder mesh(file.name);
    for (std::uint64_t v = 0; v < vertices; ++v) {
        if (!in.next_line()) in.ends("after " + std::to_string(v) + " of " + std::to_string(vertices) + " vertices");
        mesh.add_vertex(in.point());
    }
    std::vector<std::uint32_t> corners;
    for (std::uint64_t f = 0; f < faces; ++f) {
        if (!in.next_line()) in.ends("after " + std::to_string(f) + " of " + std::to_string(faces) + " faces");
        const auto count = in.whole<std::uint32_t>("the number of corners of a face");
        corners.clear();
        for (std::uint32_t i = 0; i < count; ++i)
            corners.push_back(in.whole<std::uint32_t>("a face of " + std::to_string(count) + " corners"));
        mesh.add_face(corners, in.line());
    }
    if (in.next_line())
        in.fail("expected the end of the file after " + std::to_string(vertices) + " vertices and " +
                std::to_string(faces) + " faces, found " + in_quotes(in.word()));
    return mesh.finish(in.rounded(), file.name + ":", 0);
}

}  // namespace aabblab
