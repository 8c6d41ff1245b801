#include "mesh_bytes.hpp"

namespace {

const std::vector<aabb::vec3f> corners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const triangles half_tetrahedron = {{0, 1, 2}, {0, 2, 3}};

void require_two_triangles(const aabblab::loaded_mesh& loaded, const std::string& report = {}) {
    REQUIRE(loaded.mesh.vertices == corners);
    REQUIRE(loaded.mesh.triangles == half_tetrahedron);
    REQUIRE(loaded.report.text() == report);
}

std::string ply_header(const std::string& format, const std::string& coordinate, const std::string& list) {
    return "ply\nformat " + format +
           " 1.0\ncomment a tetrahedron's half\nelement vertex 4\nproperty uchar red\nproperty " + coordinate +
           " x\nproperty " + coordinate + " y\nproperty " + coordinate +
           " z\nproperty list uchar short tags\nelement face 2\nproperty list " + list +
           "\nproperty int material\nelement camera 1\nproperty double view\nend_header\n";
}

template <class Coordinate, class Count, class Index>
std::string ply_body(bool big_endian) {
    std::string bytes;
    for (const aabb::vec3f& v : corners) {
        bytes += raw(std::uint8_t{9}, big_endian);
        for (int k = 0; k < 3; ++k) bytes += raw(static_cast<Coordinate>(v[k]), big_endian);
        bytes += raw(std::uint8_t{1}, big_endian) + raw(std::int16_t{-4}, big_endian);
    }
    for (const auto& t : half_tetrahedron) {
        bytes += raw(static_cast<Count>(3), big_endian);
        for (const std::uint32_t v : t) bytes += raw(static_cast<Index>(v), big_endian);
        bytes += raw(std::int32_t{-7}, big_endian);
    }
    return bytes + raw(0.5, big_endian);
}

}  // namespace

TEST_CASE("OFF is read in all its variants") {
    const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
    const std::string faces = "3 0 1 2\n3 0 2 3\n";
    for (const std::string& file : {
             "OFF\n4 2 0\n" + vertices + faces,
             "OFF 4 2 0\n" + vertices + faces,
             "OFF4 2 0\n" + vertices + faces,
             "OFF\n4 2\n" + vertices + faces,
             "# first\n\nOFF # second\n\n4 2 0 # third\n\n" + vertices + "\n# fourth\n" + faces + "\n\n# last",
             std::string("OFF\r\n4 2 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n0 0 1\r\n3 0 1 2\r\n3 0 2 3\r\n"),
             "OFF\n4 2 0\n" + vertices + "3 0 1 2 255 0 0\n3 0 2 3 0.5 0.5 0.5 1",
             std::string("COFF\n4 2 0\n0 0 0 9 9 9 9\n1 0 0 9 9 9 9\n0 1 0 9 9 9 9\n0 0 1 9 9 9 9\n") + faces,
             std::string("NOFF\n4 2 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n0 0 1 0 0 1\n") + faces,
             std::string("STCNOFF\n4 2 0\n0 0 0 1 1\n1 0 0 1 1\n0 1 0 1 1\n0 0 1 1 1\n") + faces,
             std::string("OFF\n4 2 0\n\t+0 0.0 0e5\n1. 0 -0e0\n0 1e0 0\n0 0 100e-2\n") + faces,
         }) {
        CAPTURE(file);
        require_two_triangles(read("a.OFF", file));
    }
}

TEST_CASE("Line breaks in OFF matter only where they end the colours of faces") {
    for (const std::string& file : {
             std::string("OFF 4 2 0 0 0 0 1 0 0 0 1 0 0 0 1 3 0 1 2 3 0 2 3"),
             std::string("OFF\n4\n2\n# none\n0\n0\n0 0\n1 0 0 0\n1 0 0 0 1 3\n0 1 2 3 0\n2\n3\n"),
             std::string("OFF\n4 2 0\n0 0 0 1 0 0 0 1 0 0 0 1\n3 0 1 2\n3 0 2 3\n"),
             std::string("OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0\n1 2\n3 0 2\n3\n"),
             std::string("OFF\n4 2 0\n0 0\n0 1 0 0\n0 1 0 0 0 1\n3 0 1 2 255 0 0\n3 0\n2 3 0.5 0.5 0.5 1\n"),
             std::string(
                 "CNOFF 4 2 0\n0 0 0 9 9 9 9 0 0 1 1 0 0 9 9 9 9 0 0 1\n0 1 0 9 9 9 9 0 0 1 0 0 1 9 9 9 9 0 0 1\n"
                 "3 0 1 2 3 0 2 3\n"),
             std::string("STOFF\n4\n2 0\n0 0 0 .5 .5 1 0 0 .5 .5 0 1 0 .5 .5 0 0 1 .5 .5\n3 0 1 2 7\n3 0 2 3 7\n"),
         }) {
        CAPTURE(file);
        require_two_triangles(read("a.off", file));
    }
    const auto error_of = [](const std::string& file) {
        const std::string error = refusal_in<aabb::input_error>([&] { return read("a.off", file); });
        return error.substr(error.rfind('/') + 1);
    };
    // The number after the first face is its colour, or the number of corners of the next face.
    CHECK(error_of("OFF 5 2 0 0 0 0 1 0 0 0 1 0 0 0 1 1 1 1\n3 0 1 2 3\n3 0 2 3\n") == "accepted");
    CHECK(error_of("OFF 9 2 0 0 0 0 2 0 0 3 1 0 3 2 0 2 3 0 1 3 0 0 1 0 9 9 9 8 8 8\n3 0 1 2 7\n7 0 1 2 3 4 5 6\n") ==
          "accepted");
    CHECK(error_of("OFF 9 2 0 0 0 0 1 0 0 0 1 0 0 0 1 1 1 1 1 1 2 1 1 3 1 1 4 1 1 5\n3 0 1 2 7\n3 0 1 2 4 5 6\n") ==
          "a.off: can be read in two ways, as numbers after the corners of a face are colours or more faces; expected "
          "each vertex and each face on a line of its own");
    // A missing number does not shift those after it.
    CHECK(error_of("OFF\n3 2 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n3 2 1 0\n") ==
          "a.off:4: expected three coordinates, found the end of the line");
    CHECK(error_of("OFF\n3 1 0\n0 0 0\n1 0\n0 1 0\n3 3 1 2 0 0 0\n") ==
          "a.off:4: expected three coordinates, found the end of the line");
    CHECK(error_of("OFF 3 1 0 0 0 0 1 0 0 0 1 x 3 0 1 2") == "a.off:1: expected three coordinates, found 'x'");
    CHECK(error_of("OFF 3 1 0\n0 0\n0 1 0\n0 0 1 0 2 0 1 2\n") == "a.off:4: expected at least three corners of a face");
    CHECK(error_of("OFF 3 1 0\n0 0\n0 1 0\n0 0 1 0 3 0 1\n") == "a.off: ends after 0 of 1 faces");
}

TEST_CASE("OBJ: obsolete face statements are read, and skipped statements are reported") {
    const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    require_two_triangles(read("a.obj", vertices + "f 1 2 3\nfo 1 3 4\n"));
    // A backslash continues a statement, after a blank or a word.
    require_two_triangles(read("a.obj", vertices + "f 1 2\\\n3\nf 1 \\\n3\\\n 4\n"));
    CHECK(read("a.obj", vertices + "v 0 0 0 \\\n1.0\nf 1 2 3\nf 1 3 4\n").report.text().empty());
    require_two_triangles(
        read("a.obj", vertices + "f 1 2 3\nf 1 3 4\ncstype bezier\ndeg 1 1\nsurf 0 1 0 1 1 2 \\\n3 4\nparm u 0 "
                                 "1\nend\nl 1 2\nl 2 3\nF 1 2 4\n"),
        "1 statement 'surf' skipped, 2 statements 'l' skipped, 1 statement 'F' skipped");
    std::string many = vertices + "f 1 2 3\nf 1 3 4\n";
    for (char name = 'a'; name < 'a' + 10; ++name) many += "x" + std::string(1, name) + " 1\n";
    CHECK(read("a.obj", many).report.text().ends_with("1 statement 'xh' skipped, 2 of other names skipped"));
}

TEST_CASE("An unused vertex may be NaN or infinite, keeps its index and enlarges no box") {
    const std::string ply =
        "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
        "property list uchar int vertex_indices\nend_header\n";
    const std::string values = raw(not_a_number) + raw(-infinity) + raw(0.0F) + raw(2.0F) + raw(3.0F) + raw(4.0F) +
                               raw(5.0F) + raw(3.0F) + raw(4.0F) + raw(2.0F) + raw(5.0F) + raw(4.0F) +
                               raw(std::uint8_t{3}) + raw(1) + raw(2) + raw(3);
    const std::string rest = "2 3 4\n5 3 4\n2 5 4\n";
    for (const auto& [name, bytes] : {
             std::pair<std::string, std::string>{"a.off", "OFF\n4 1 0\nnan -inf 0\n" + rest + "3 1 2 3\n"},
             {"b.off", "OFF 4 1 0 -nan(ind) INFINITY 0 " + rest + "3 1 2 3\n"},
             {"a.obj", "v NaN nan NAN\nv 2 3 4\nv 5 3 4\nv 2 5 4\nf 2 3 4\n"},
             {"a.ply", "ply\nformat ascii 1.0\n" + ply + "nan 0 +inf\n" + rest + "3 1 2 3\n"},
             {"b.ply", "ply\nformat binary_little_endian 1.0\n" + ply + values},
         }) {
        INFO(name);
        const aabblab::loaded_mesh loaded = read(name, bytes);
        CHECK(loaded.mesh.triangles == triangles{{1, 2, 3}});
        CHECK(loaded.mesh.vertices == std::vector<aabb::vec3f>{{2, 3, 4}, {2, 3, 4}, {5, 3, 4}, {2, 5, 4}});
        CHECK(loaded.report.text() == "1 vertex with NaN or infinity, which no face uses, moved onto another");
    }
}

TEST_CASE("PLY: triangle strips are read with a consistent orientation") {
    const auto file = [](const std::string& elements, const std::string& values) {
        return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" +
               elements + "end_header\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n" + values;
    };
    const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
    const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
    const auto triangles_of = [&](const std::string& elements, const std::string& values) {
        return read("a.ply", file(elements, values)).mesh.triangles;
    };
    // Every other triangle is flipped, so that all face one way; a -1 begins a new strip.
    CHECK(triangles_of(strips, "4 0 1 2 3\n") == triangles{{0, 1, 2}, {2, 1, 3}});
    CHECK(triangles_of(strips, "8 0 1 2 3 -1 0 1 3\n") == triangles{{0, 1, 2}, {2, 1, 3}, {0, 1, 3}});
    CHECK(triangles_of(strips, "9 -1 0 1 -1 0 1 2 -1 -1\n") == triangles{{0, 1, 2}});
    const aabblab::loaded_mesh parts = read("a.ply", file(strips, "9 0 1 -1 0 1 2 -1 -1 3\n"));
    CHECK(parts.report.text() == "2 faces of fewer than three corners dropped");
    CHECK(triangles_of(faces + strips, "3 3 2 1\n3 0 1 2\n") == triangles{{3, 2, 1}, {0, 1, 2}});
    CHECK(triangles_of(strips + faces, "3 0 1 2\n3 3 2 1\n") == triangles{{0, 1, 2}, {3, 2, 1}});
    // Degenerate triangles that join strips without a -1 are skipped, but count for the orientation.
    const aabblab::loaded_mesh joined = read("a.ply", file(strips, "8 0 1 2 2 1 1 2 3\n"));
    CHECK(joined.mesh.triangles == triangles{{0, 1, 2}, {2, 1, 3}});
    CHECK(joined.report.text() == "4 triangles of strips skipped, which repeat a corner");
    const std::string binary =
        "ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n" +
        strips + "end_header\n";
    std::string values;
    for (const aabb::vec3f& v : corners)
        for (int k = 0; k < 3; ++k) values += raw(v[k], true);
    values += raw(8, true);
    for (const int corner : {0, 1, 2, 3, -1, 0, 1, 3}) values += raw(corner, true);
    CHECK(read("a.ply", binary + values).mesh.triangles == triangles{{0, 1, 2}, {2, 1, 3}, {0, 1, 3}});
}

TEST_CASE("STL: equal vertices of a large file are merged") {
    constexpr int count = 3000;
    std::string binary = stl_header(2 * count);
    for (int copy = 0; copy < 2; ++copy)
        for (int t = 0; t < count; ++t) {
            const auto x = static_cast<float>(t);
            binary += stl_triangle({x, 0, 0, x, 1, 0, 0, x, 1});
        }
    const aabb::mesh mesh = read("a.stl", binary).mesh;
    REQUIRE(mesh.triangle_count() == 2 * count);
    CHECK(mesh.vertices.size() == 3 * count);
    for (std::uint32_t t = 0; t < count; ++t) {
        CHECK(mesh.triangles[t] == mesh.triangles[t + count]);
        CHECK(mesh.triangle(t)[2] == aabb::vec3f{0, static_cast<float>(t), 1});
    }
}

TEST_CASE("OBJ: corners are read in every form, and irrelevant statements are ignored") {
    const std::string vertices = "v 0 0 0\nv 1 0 0 1.0\nv 0 1 0\nv 0 0 1 0.2 0.3 0.4\n";
    for (const std::string& file : {
             vertices + "f 1 2 3\nf 1 3 4\n",
             "mtllib x.mtl\no thing\n" + vertices +
                 "vt 0 0\nvn 0 0 1\ns off\nusemtl m\nf 1/1/1 2/1/1 3/1/1\nf 1//1 3//1 4//1",
             vertices + "f -4 -3 -2 # half\nf 1/1 -2/1 -1/-1\n",
             vertices + "f 1 2 \\\n 3\nf 1 \\\n\\\n3 4\n",
             "f 1 2 3\n" + vertices + "f 1 3 4\n",
         }) {
        CAPTURE(file);
        require_two_triangles(read("a.obj", file));
    }
}

TEST_CASE("PLY: text and binary files are read with any scalar types, properties and elements") {
    const std::string camera = "1 element 'camera' skipped";
    require_two_triangles(
        read("a.ply", ply_header("ascii", "float", "uchar int vertex_indices") +
                          "9 0 0 0 1 5\n9 1 0 0 0\n9 0 1 0 2 1 2\n9 0 0 1 0\n3 0 1 2 -7\n3 0 2 3 -7\n0.5\n"),
        camera);
    require_two_triangles(read("a.ply", ply_header("binary_little_endian", "float32", "uint8 int32 vertex_index") +
                                            ply_body<float, std::uint8_t, std::int32_t>(false)),
                          camera);
    require_two_triangles(read("a.ply", ply_header("binary_big_endian", "double", "int uint8 vertex_indices") +
                                            ply_body<double, std::int32_t, std::uint8_t>(true)),
                          camera);
    require_two_triangles(read("a.ply", ply_header("binary_little_endian", "short", "ushort uint vertex_indices") +
                                            ply_body<std::int16_t, std::uint16_t, std::uint32_t>(false) + "\r\n"),
                          camera);
}

TEST_CASE("PLY: faces may come before vertices") {
    CHECK(read("a.ply",
               "ply\nformat ascii 1.0\nelement face 1\nproperty list uchar int vertex_indices\nelement vertex 3\n"
               "property float x\nproperty float y\nproperty float z\nend_header\n3 0 1 2\n0 0 0\n1 0 0\n0 1 0\n")
              .mesh.triangles == triangles{{0, 1, 2}});
}

TEST_CASE("STL: equal vertices of text and binary files are merged in file order") {
    const std::string text =
        "solid half\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
        " FACET NORMAL nan 0 0\n OUTER LOOP\n VERTEX 0 0 0\n VERTEX 0 1 0\n VERTEX 0 0 1\n ENDLOOP\n ENDFACET\n"
        "endsolid half\n";
    require_two_triangles(read("a.stl", text));
    const std::string body = stl_triangle({0, 0, 0, 1, 0, 0, 0, 1, 0}) + stl_triangle({0, 0, 0, 0, 1, 0, 0, 0, 1});
    require_two_triangles(read("a.stl", stl_header(2) + body));
    require_two_triangles(read("a.stl", stl_header(2, "solid but binary") + body));
    // -0 equals 0 but has other bits.
    REQUIRE(read("a.stl", stl_header(1) + stl_triangle({0, 0, 0, -0.0F, 0, 0, 1, 1, 1})).mesh.vertices.size() == 3);
}

TEST_CASE("triangles of polygons keep the file order, and every change to a mesh is counted") {
    const aabblab::loaded_mesh loaded = read("a.off",
                                             "OFF\n6 5 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0.1 0 0\n16777217 0 0\n"
                                             "4 0 1 2 3\n5 0 1 2 3 4\n3 0 1 5\n2 0 1\n3 2 2 1\n");
    REQUIRE(loaded.mesh.triangles ==
            triangles{{0, 1, 2}, {0, 2, 3}, {4, 0, 1}, {3, 4, 1}, {1, 2, 3}, {0, 1, 5}, {2, 2, 1}});
    REQUIRE(loaded.report.text() ==
            "1 polygon fan-triangulated, 1 concave polygon ear-clipped, 3 triangles of zero area kept, 1 face of "
            "fewer than three corners dropped");
}

TEST_CASE("triangles of zero area are detected exactly") {
    const auto zero_area = [](const std::string& vertices) {
        return read("a.off", "OFF\n3 1 0\n" + vertices + "3 0 1 2\n").report.zero_area;
    };
    REQUIRE(zero_area("0 0 0\n1 1 1\n3 3 3\n") == 1);
    REQUIRE(zero_area("1e38 0 0\n1e38 1e-38 0\n1e38 3e38 0\n") == 1);
    REQUIRE(zero_area("16777216 16777216 0\n0 0 0\n1e-45 1e-45 0\n") == 1);
    REQUIRE(zero_area("16777216 16777216 0\n0 0 0\n1e-45 0 0\n") == 0);
    // The sums cancel except for the last bit but one.
    REQUIRE(zero_area("0 0 0\n16777215 16777214 0\n16777214 16777213 0\n") == 0);
    REQUIRE(zero_area("3e38 3e38 0\n-3e38 -3e38 0\n1e-45 0 0\n") == 0);
    REQUIRE(zero_area("3e38 -3e38 3e38\n-3e38 3e38 -3e38\n0 -0 0\n") == 1);
}

TEST_CASE("doubles and integers of a binary file are kept") {
    const std::string header =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty double x\nproperty int y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string body = raw(0.1) + raw(16777217) + raw(0.1F) + raw(0.5) + raw(2) + raw(0.0F) + raw(0.0) + raw(0) +
                             raw(0.0F) + raw(std::uint8_t{3}) + raw(0) + raw(1) + raw(2);
    const aabblab::loaded_mesh loaded = read("a.ply", header + body);
    REQUIRE(loaded.mesh.given_vertex(0) == aabb::vec3d{0.1, 16777217, double{0.1F}});
}
