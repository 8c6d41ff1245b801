#include "mesh_bytes.hpp"

using Catch::Matchers::EndsWith;

namespace {

std::string error_of(const std::filesystem::path& file) {
    return refusal_in<aabb::input_error>([&] { return aabblab::read_mesh(file); });
}

struct malformed {
    std::string file;
    std::string bytes;
    std::string error;  // the message after the file name
};

const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
const std::string ply =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int "
    "vertex_indices\nend_header\n";
const std::string ply_text = "ply\nformat ascii 1.0\n" + ply;
const std::string ply_strips = [] {
    std::string text = ply_text;
    return text.replace(text.find("element face"), 12, "element tristrips");
}();
const std::string ply_binary = "ply\nformat binary_little_endian 1.0\n" + ply;

std::string ply_points(float last = 0) {
    std::string bytes;
    for (int i = 0; i < 8; ++i) bytes += raw(static_cast<float>(i));
    return bytes + raw(last);
}

}  // namespace

TEST_CASE_METHOD(in_folder, "malformed text meshes are rejected with the line number") {
    for (const auto& [file, bytes, error] : {
             malformed{"a.off", "", ": is empty"},
             {"a.off", "\n# nothing\n", ": ends before the keyword OFF"},
             {"a.off", "\nPLY\n", ":2: expected the keyword OFF, found 'PLY'"},
             {"a.off", "XOFF\n", ":1: expected the keyword OFF, found 'XOFF'"},
             {"a.off", "4OFF\n3 1 0\n", ":1: only OFF in three dimensions is read"},
             {"a.off", "OFF BINARY\n", ":1: expected the number of vertices, found 'BINARY'"},
             {"a.off", "OFF\n", ": ends before the numbers of vertices and faces"},
             {"a.off", "OFF\n3\n", ": ends before the numbers of vertices and faces"},
             {"a.off", "OFF\n3\n1\n", ": ends before the number of edges"},
             {"a.off", "OFF\n-3 1 0\n", ":2: expected the number of vertices, found '-3'"},
             {"a.off", "OFF\n99999999999999999999 1 0\n",
              ":2: expected the number of vertices, found '99999999999999999999'"},
             {"a.off", "OFF\n4000000000 1 0\n" + vertices, ": ends after 3 of 4000000000 vertices"},
             {"a.off", "OFF\n3 4000000000 0\n" + vertices + "3 0 1 2\n", ": ends after 1 of 4000000000 faces"},
             {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 abc\n", ":4: expected three coordinates, found 'abc'"},
             {"a.off", "OFF\n3 1 0\n0 0 0\n1 0\n", ":4: expected three coordinates, found the end of the line"},
             {"a.off", "OFF\n3 1 0\n0 0 0x10\n", ":3: expected three coordinates, found '0x10'"},
             {"a.off", "OFF\n3 1 0\n0 0 1,5\n", ":3: expected three coordinates, found '1,5'"},
             {"a.off", "OFF\n3 1 0\n0 0 +-1\n", ":3: expected three coordinates, found '+-1'"},
             {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n",
              ":4: vertex 1 has a coordinate that is not finite, and a face uses it"},
             {"a.off", "OFF\n3 1 0\n0 0 0\n1 0 1.#QNAN\n", ":4: expected three coordinates, found '1.#QNAN'"},
             {"a.off", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0\n1 3\n",
              ":5: a face uses vertex 3, but there are 3 vertices, counted from 0"},
             {"a.off", "OFF\n3 1 0\n0 -INF 0\n1 0 0\n0 1 0\n3 0 1 2\n",
              ":3: vertex 0 has a coordinate that is not finite, and a face uses it"},
             {"a.off", "OFF\n3 1 0\n0 -1e999 0\n", ":3: the coordinate '-1e999' is too large for a double"},
             {"a.off", "OFF\n3 1 0\n" + vertices + "3 0 1 3\n",
              ":6: a face uses vertex 3, but there are 3 vertices, counted from 0"},
             {"a.off", "OFF\n3 1 0\n" + vertices + "3 0 1 -1\n", ":6: expected a face of 3 corners, found '-1'"},
             {"a.off", "OFF\n3 1 0\n" + vertices + "4000000000 0 1 2\n",
              ":6: expected a face of 4000000000 corners, found the end of the line"},
             {"a.off", "OFF\n3 1 0\n" + vertices + "2 0 1\n",
              ": the mesh has no triangles (1 face of fewer than three corners dropped)"},
             {"a.off", "OFF\n0 0 0\n", ": the mesh has no triangles"},
             {"a.off", "OFF\n3 1 0\n" + vertices + "3 0 1 2\n3 2 1 0\n",
              ":7: expected the end of the file after 3 vertices and 1 face, found '3'"},
             {"a.obj", "v 0 0\n", ":1: expected three coordinates, found the end of the line"},
             {"a.obj", "v 0 0 0 1 0.5 x\n", ":1: expected the weight or the colour of a vertex, found 'x'"},
             {"a.obj", "v 0 0 0\nf 1/1/1/1 1 1\n", ":2: expected the number of a vertex, found '1/1/1/1'"},
             {"a.obj", "v 0 0 -1.#INF\n", ":1: expected three coordinates, found '-1.#INF'"},
             {"a.obj", "v 0 0 0\nv 0 0 inf\nf 1 2 1\n",
              ":2: vertex 2 has a coordinate that is not finite, and a face uses it"},
             {"a.obj", "v 0 0 0\nf 1 1 0\n", ":2: a face uses vertex 0, but vertices are counted from 1"},
             {"a.obj", "v 0 0 0\nf 1 1 2\nv 1 1 1\nf 1 2 3\nf 1 2 2\n",
              ":4: a face uses vertex 3, but there are 2 vertices, counted from 1"},
             {"a.obj", "v 0 0 0\nf 1 1 -2\n", ":2: a face uses vertex -2, with 1 vertex before it"},
             {"a.obj", "v 0 0 0\nf 1 1 9999999999\n", ":2: a face uses vertex 9999999999, with 1 vertex before it"},
             {"a.obj", "v 0 0 0\nf 1 x/1 1\n", ":2: expected the number of a vertex, found 'x/1'"},
             {"a.obj", "v 0 0 0\nf 1 1 \\\n", ": ends after a backslash"},
             {"a.obj", "v 0 0 0\np 1\nl 1 1\nl 1 1\n",
              ": the mesh has no triangles (1 statement 'p' skipped, 2 statements 'l' skipped)"},
             {"a.ply", "plx\n", ":1: expected the word ply, found 'plx'"},
             {"a.ply", "ply\nformat ascii 1.0\n", ": ends inside the header"},
             {"a.ply", "ply\nend_header\n", ":2: the header has no format"},
             {"a.ply", "ply\nformat binary 1.0\n",
              ":2: expected ascii, binary_little_endian or binary_big_endian, found 'binary'"},
             {"a.ply", "ply\nproperty float x\n", ":2: a property precedes the first element"},
             {"a.ply", "ply\nelement vertex 1\nproperty real x\n", ":3: expected the type of a property, found 'real'"},
             {"a.ply", "ply\nelement vertex many\n", ":2: expected the number of elements, found 'many'"},
             {"a.ply", "ply\nelement vertex 1\nproperty float x\nproperty float y\nelement face 1\n",
              ":5: the element vertex must have one property z"},
             {"a.ply", "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int corners\nend_header\n",
              ":5: the element face must have one list property vertex_indices"},
             {"a.ply", "ply\nelement face 1\nproperty list float int vertex_indices\n",
              ":3: the length of a list must have a whole type"},
             {"a.ply", "ply\nelement face 1\nproperty list uchar float vertex_indices\n",
              ":3: the corners of a face must have a whole type"},
             {"a.ply", "ply\nformat binary_little_endian 1.0\nelement dust 99999999999\nend_header\n",
              ":4: the element 'dust' has no properties"},
             {"a.ply", ply_text + "0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n",
              ":11: vertex 1 has a coordinate that is not finite, and a face uses it"},
             {"a.ply", ply_strips + vertices + "3 0 1 -2\n", ":13: a strip has corner -2; only -1 ends a part of one"},
             {"a.ply", ply_strips + vertices + "3 0 1 4294967295\n",
              ":13: a face uses vertex 4294967295, but there are 3 vertices, counted from 0"},
             {"a.ply", ply_strips + vertices + "6 99 0 -1 0 1 2\n",
              ":13: a face uses vertex 99, but there are 3 vertices, counted from 0"},
             {"a.ply", ply_text + "0 0 0 5\n1 0 0\n0 1 0\n3 0 1 2\n",
              ":10: expected the end of the line after the last property, found '5'"},
             {"a.ply", ply_text + vertices + "3 0 1 2 0\n",
              ":13: expected the end of the line after the last property, found '0'"},
             {"a.ply", ply_text + "0 0 0\n1 0 0\n", ": ends after 2 of 3 elements 'vertex'"},
             {"a.ply", ply_text + "0 0 0\n1 0 0\n0 1\n", ":12: expected three coordinates, found the end of the line"},
             {"a.ply", ply_text + vertices + "3 0 1 3\n",
              ":13: a face uses vertex 3, but there are 3 vertices, counted from 0"},
             {"a.ply", ply_text + vertices + "3 0 1\n", ":13: expected a whole number, found the end of the line"},
             {"a.ply", ply_text + vertices + "3 0 1 2\n3 0 1 2\n",
              ":14: expected the end of the file after the last element, found '3'"},
             {"a.ply",
              "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float "
              "z\nend_header\n0 0 0\n",
              ": the mesh has no triangles"},
             {"a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n", ": ends inside a facet"},
             {"a.stl", "solid\n", ": ends without endsolid"},
             {"a.stl", "solid\nendsolid\n", ": the mesh has no triangles"},
             {"a.stl", "solid\nvertex 0 0 0\n", ":2: expected facet or endsolid, found 'vertex'"},
             {"a.stl", "solid\nfacet\nvertex 0 0 0\nvertex 0 0 0\nendfacet\n", ":5: a facet has 2 vertices, not three"},
             {"a.stl", "solid\nfacet\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\n",
              ":6: a facet has more than three vertices"},
             {"a.stl", "solid\nfacet\nvertex 0 0 0 7\n", ":3: expected the end of the line, found '7'"},
             {"a.stl", "solid\nfacet normal 0 0 1 outer loop\n", ":2: expected the end of the line, found 'outer'"},
             {"a.stl", "solid\nfacet\nouter loop vertex 0 0 0\n", ":3: expected the end of the line, found 'vertex'"},
             {"a.stl", "solid\nfacet\nvertex 0 0 nan\n", ":3: the vertex has a coordinate that is not finite"},
         }) {
        CAPTURE(bytes);
        CHECK_THAT(error_of(folder.write(file, bytes)), EndsWith("/" + file + error));
    }
}

TEST_CASE_METHOD(in_folder, "malformed binary meshes are rejected") {
    const std::string face = raw(std::uint8_t{3}) + raw(0) + raw(1);
    const std::string triangle = stl_triangle({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const std::string not_stl =
        ": is not an STL file: it is neither text that begins with solid nor holds the 84 bytes of a binary header";
    const std::string huge_count =
        "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty double x\nproperty float y\n"
        "property float z\nend_header\n";
    for (const auto& [file, bytes, error] : {
             malformed{"a.ply", huge_count, ": ends in element 0 of 4000000000 elements 'vertex'"},
             {"a.ply", ply_binary + ply_points().substr(1), ": ends in element 2 of 3 elements 'vertex'"},
             {"a.ply", ply_binary + ply_points(not_a_number) + face + raw(2),
              ": vertex 2 has a coordinate that is not finite, and a face uses it"},
             {"a.ply", ply_binary + ply_points() + face + raw(3),
              ": face 0: a face uses vertex 3, but there are 3 vertices, counted from 0"},
             {"a.ply", ply_binary + ply_points() + face + raw(-1), ": face 0 has a negative length or corner"},
             {"a.ply", ply_binary + ply_points() + face, ": ends in element 0 of 1 elements 'face'"},
             {"a.ply", ply_binary + ply_points() + face + raw(2) + raw(1),
              ": continues for 4 bytes after the last element that its header announces"},
             {"a.stl", "cube", not_stl},
             {"a.stl", (stl_header(2, "solid but binary") + triangle).substr(0, 100),
              ": its header announces 2 triangles, which take 184 bytes, but the file has 100"},
             {"a.stl", stl_header(2, "solid but binary").substr(0, 82), not_stl},
             {"a.stl", stl_header(4000000000),
              ": its header announces 4000000000 triangles, which take 200000000084 bytes, but the file has 84"},
             {"a.stl", stl_header(0), ": the mesh has no triangles"},
             {"a.stl", stl_header(1) + stl_triangle({0, 0, 0, 1, 0, 0, 0, infinity, 0}),
              ": triangle 0 has a coordinate that is not finite"},
         }) {
        CAPTURE(error);
        CHECK_THAT(error_of(folder.write(file, bytes)), EndsWith("/" + file + error));
    }
}

TEST_CASE_METHOD(in_folder, "an error message quotes at most 40 bytes of a word, in whole characters") {
    const std::string word = "x" + repeated("\xc3\xa9", 30);
    CHECK_THAT(error_of(folder.write("a.off", word)), EndsWith("found '" + word.substr(0, 39) + "…'"));
}

TEST_CASE_METHOD(in_folder, "files that are not meshes are rejected") {
    CHECK_THAT(error_of(folder / "absent.off"), EndsWith("/absent.off: no such file"));
    CHECK_THAT(error_of(folder.path()), EndsWith(": is a folder, not a file"));
    CHECK_THAT(error_of("/dev/null"), EndsWith("/dev/null: is not a regular file"));
    CHECK_THAT(error_of(folder.write("a.stp", "x")),
               EndsWith("/a.stp: unknown mesh format '.stp'; did you mean '.stl'?"));
    CHECK_THAT(error_of(folder.write("mesh", "x")),
               EndsWith("/mesh: unknown mesh format ''; expected one of .off, .obj, .ply, .stl, .gltf, .glb"));
    // A sparse file has the size, but takes no disk space or memory.
    std::filesystem::resize_file(folder.write("huge.off", "OFF"), std::uintmax_t{1} << 43);
    CHECK_THAT(error_of(folder / "huge.off"), Catch::Matchers::ContainsSubstring("16384.0 GiB of memory"));
}

TEST_CASE("a mesh that exceeds the memory is rejected with both sizes in enough digits to differ") {
    const auto memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
    REQUIRE_NOTHROW(aabblab::require_memory("x", memory));
    const std::string available = std::to_string(static_cast<std::uint64_t>(memory));
    const std::string one_more = std::to_string(static_cast<std::uint64_t>(memory) + 1);
    REQUIRE_THROWS_WITH(aabblab::require_memory("x", memory + 1),
                        "x would take " + one_more + " bytes of memory, but this machine has " + available + " bytes");
}
