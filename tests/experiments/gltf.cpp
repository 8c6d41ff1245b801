#include "mesh_bytes.hpp"

using Catch::Matchers::EndsWith;

namespace {

/// A file whose parts can be replaced.
struct parts {
    std::string asset = R"({"version":"2.0"})";
    std::string more{};  // members of the file
    std::string scene = R"({"nodes":[0]})";
    std::string nodes = R"({"mesh":0})";
    std::string primitive = R"({"attributes":{"POSITION":0},"indices":1})";
    std::string buffer = R"({"uri":"a.bin","byteLength":60})";
    std::string views = R"({"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12})";
    std::string positions = R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"})";
    std::string indices = R"({"bufferView":1,"componentType":5123,"count":6,"type":"SCALAR"})";

    [[nodiscard]] std::string text() const {
        return R"({"asset":)" + asset + more + R"(,"scenes":[)" + scene + R"(],"nodes":[)" + nodes +
               R"(],"meshes":[{"primitives":[)" + primitive + R"(]}],"buffers":[)" + buffer + R"(],"bufferViews":[)" +
               views + R"(],"accessors":[)" + positions + "," + indices + "]}";
    }
};

/// Four corners, then the indices of two triangles.
std::string binary() {
    std::string bytes;
    for (const float f : std::array<float, 12>{0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}) bytes += raw(f);
    for (const std::uint16_t i : std::array<std::uint16_t, 6>{0, 1, 2, 0, 2, 3}) bytes += raw(i);
    return bytes;
}
const triangles two_faces = {{0, 1, 2}, {0, 2, 3}};

std::string chunk(std::uint32_t type, std::string bytes, char padding) {
    while (bytes.size() % 4 != 0) bytes += padding;
    return raw(static_cast<std::uint32_t>(bytes.size())) + raw(type) + bytes;
}
std::string glb(const std::string& chunks, std::uint32_t version = 2) {
    return "glTF" + raw(version) + raw(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
}
constexpr std::uint32_t json_chunk = 0x4e4f534a;
constexpr std::uint32_t binary_chunk = 0x004e4942;

aabblab::loaded_mesh load(const std::string& bytes, const std::string& name = "a.gltf") {
    const temporary_folder folder;
    folder.write("a.bin", binary());
    folder.write("a b.bin", binary());
    return aabblab::read_mesh(folder.write(name, bytes));
}

std::string error_of(const std::string& bytes, const std::string& name = "a.gltf") {
    return refusal_in<aabb::input_error>([&] { return load(bytes, name); });
}

std::string encoded(const std::string& bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = i; k < i + 3; ++k)
            group = group << 8U | (k < bytes.size() ? static_cast<unsigned char>(bytes[k]) : 0U);
        for (unsigned shift = 24; shift > 0;) text += digits[group >> (shift -= 6) & 63U];
    }
    return text;
}

/// Builds a file: each list of numbers becomes an accessor with its own view and buffer.
class asset {
public:
    template <class Number>
    std::size_t add(int component, const std::string& type, std::size_t width, const std::vector<Number>& numbers,
                    const std::string& more = "") {
        const std::size_t view = add_view(numbers);
        return add_accessor(R"("bufferView":)" + std::to_string(view) + more, component, type, numbers.size() / width);
    }
    std::size_t add_accessor(const std::string& members, int component, const std::string& type, std::size_t count) {
        append(accessors_, "{" + members + (members.empty() ? "" : ",") + R"("componentType":)" +
                               std::to_string(component) + R"(,"count":)" + std::to_string(count) + R"(,"type":")" +
                               type + R"("})");
        return accessor_count_++;
    }
    template <class Number>
    std::size_t add_view(const std::vector<Number>& numbers) {
        std::string bytes;
        for (const Number n : numbers) bytes += raw(n);
        append(buffers_, R"({"byteLength":)" + std::to_string(bytes.size()) + R"(,"uri":"data:;base64,)" +
                             encoded(bytes) + R"("})");
        append(views_, R"({"buffer":)" + std::to_string(view_count_) + R"(,"byteLength":)" +
                           std::to_string(bytes.size()) + "}");
        return view_count_++;
    }
    /// @param members "nodes", "meshes" and so on
    [[nodiscard]] std::string text(const std::string& members) const {
        return R"({"asset":{"version":"2.0"},"buffers":[)" + buffers_ + R"(],"bufferViews":[)" + views_ +
               R"(],"accessors":[)" + accessors_ + "]," + members + "}";
    }

private:
    static void append(std::string& list, const std::string& item) { list += (list.empty() ? "" : ",") + item; }

    std::string buffers_;
    std::string views_;
    std::string accessors_;
    std::size_t view_count_ = 0;
    std::size_t accessor_count_ = 0;
};

const std::vector<float> triangle = {0, 0, 0, 1, 0, 0, 0, 1, 0};
using points = std::vector<aabb::vec3f>;

/// A triangle (accessor 0) that moves by 5 along x (accessor 1) and by 3 along z at one corner (accessor 2, sparse).
std::string morphed(const std::string& node, const std::string& mesh, const std::string& targets) {
    asset file;
    file.add(5126, "VEC3", 3, triangle);
    file.add(5126, "VEC3", 3, std::vector<float>{5, 0, 0, 5, 0, 0, 5, 0, 0});
    const std::size_t indices = file.add_view(std::vector<std::uint8_t>{2});
    const std::size_t values = file.add_view(std::vector<float>{0, 0, 3});
    file.add_accessor(R"("sparse":{"count":1,"indices":{"bufferView":)" + std::to_string(indices) +
                          R"(,"componentType":5121},"values":{"bufferView":)" + std::to_string(values) + "}}",
                      5126, "VEC3", 3);
    file.add_accessor("", 5126, "VEC3", 3);
    file.add(5126, "VEC3", 3, std::vector<float>{5, 0, 0});
    return file.text(R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" + node + R"(}],"meshes":[{)" + mesh +
                     R"("primitives":[{"attributes":{"POSITION":0},"targets":[)" + targets + "]}]}]");
}
const std::string both = R"({"POSITION":1},{"POSITION":2})";

/// A triangle (0, 0), (1, 0), (0, 1) whose corners are bound to the given joints; joint 0 (node 1) is at x = 10,
/// joint 1 (node 2) is at y = 20 and rotates x into y.
struct skin {
    int joint_type = 5121;
    std::vector<std::uint8_t> joints = {0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
    std::vector<float> weights = {1, 0, 0, 0, 0, 1, 0, 0, 0.5F, 0.5F, 0, 0};
    std::string members = R"("joints":[1,2],"inverseBindMatrices":3)";
    std::string roots = "0,1";
    std::vector<float> inverse = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0,  1,   // at the origin
                                  1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, -1, 1};  // bound at z = 1
    std::string attributes = R"("POSITION":0,"JOINTS_0":1,"WEIGHTS_0":2)";

    [[nodiscard]] std::string text() const {
        asset file;
        file.add(5126, "VEC3", 3, triangle);
        file.add(joint_type, "VEC4", 4, joints);
        file.add(5126, "VEC4", 4, weights);
        file.add(5126, "MAT4", 16, inverse);
        // 1/3 and 2/3 as normalized numbers, and joints of the next set.
        file.add(5121, "VEC4", 4, std::vector<std::uint8_t>{85, 0, 0, 0, 85, 0, 0, 0, 85, 0, 0, 0},
                 R"(,"normalized":true)");
        file.add(5123, "VEC4", 4, std::vector<std::uint16_t>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
        file.add(5123, "VEC4", 4, std::vector<std::uint16_t>{43690, 0, 0, 0, 43690, 0, 0, 0, 43690, 0, 0, 0},
                 R"(,"normalized":true)");
        return file.text(R"("scenes":[{"nodes":[)" + roots +
                         R"(]}],"nodes":[{"mesh":0,"skin":0,"translation":[100,0,0]},)"
                         R"({"translation":[10,0,0],"children":[2]},)"
                         R"({"matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,-10,20,0,1]}],)"
                         R"("skins":[{)" +
                         members + R"(}],"meshes":[{"primitives":[{"attributes":{)" + attributes + "}}]}]");
    }
};

}  // namespace

TEST_CASE("glTF: buffers are read from files, data URIs and .glb chunks") {
    CHECK(load(parts{}.text()).mesh.triangles == two_faces);
    CHECK(load(parts{.buffer = R"({"uri":"a%20b.bin","byteLength":60})"}.text()).mesh.triangles == two_faces);
    parts embedded;
    embedded.buffer = R"({"byteLength":60,"uri":"data:application/octet-stream;base64,)"
                      "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAABAAIAAAACAAMA\"}";
    CHECK(load(embedded.text()).mesh.triangles == two_faces);
    const std::string text = parts{.buffer = R"({"byteLength":60})"}.text();
    const std::string other = chunk(0x12345678, "something else", 0);
    const std::string file = glb(chunk(json_chunk, text, ' ') + chunk(binary_chunk, binary(), 0) + other);
    CHECK(load(file, "a.glb").mesh.triangles == two_faces);
    CHECK(load(file, "a.glb").mesh.vertices[3] == aabb::vec3f{0, 0, 1});
}

TEST_CASE("glTF: unused vertices may be non-finite") {
    const aabblab::loaded_mesh loaded =
        load(parts{.nodes = R"({"mesh":0,"scale":[1,1,1e308],"translation":[0,0,1e308]})",
                   .indices = R"({"bufferView":1,"componentType":5123,"count":3,"type":"SCALAR"})"}
                 .text());
    CHECK(loaded.mesh.triangles == triangles{{0, 1, 2}});
    CHECK(loaded.report.not_finite == 1);
}

TEST_CASE("glTF: every primitive mode and index type is read") {
    const auto mode = [](int number, const std::string& indices) {
        parts p;
        p.primitive = R"({"attributes":{"POSITION":0})" + indices + R"(,"mode":)" + std::to_string(number) + "}";
        return p;
    };
    CHECK(load(mode(5, "").text()).mesh.triangles == triangles{{0, 1, 2}, {1, 3, 2}});
    // The third triangle is degenerate: it stitches two parts of the strip.
    const aabblab::loaded_mesh strip = load(mode(5, R"(,"indices":1)").text());
    CHECK(strip.mesh.triangles == triangles{{0, 1, 2}, {1, 0, 2}, {0, 3, 2}});
    CHECK(strip.report.stitches == 1);
    for (const int number : {5, 6}) {
        parts too_short = mode(number, R"(,"indices":1)");
        too_short.indices = R"({"bufferView":1,"componentType":5123,"count":2,"type":"SCALAR"})";
        too_short.primitive += "," + mode(4, "").primitive;
        CHECK(load(too_short.text()).report.dropped == 2);
    }
    CHECK(load(mode(6, "").text()).mesh.triangles == triangles{{0, 1, 2}, {0, 2, 3}});
    CHECK(load(mode(4, "").text()).mesh.triangles == triangles{{0, 1, 2}});
    for (const auto& [number, dropped] : {std::pair{0, 6}, {1, 3}, {2, 6}, {3, 5}}) {
        parts p = mode(number, R"(,"indices":1)");
        p.primitive += "," + mode(4, "").primitive;
        // Of the four vertices in mode 4, the last makes no triangle.
        CHECK(load(p.text()).report.dropped == static_cast<std::size_t>(dropped) + 1);
    }
    parts strided;
    strided.views = R"({"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12,"byteStride":2})";
    strided.indices = R"({"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR","byteOffset":6})";
    CHECK(load(strided.text()).mesh.triangles == triangles{{0, 2, 3}});
    parts wide;
    wide.views = R"({"buffer":0,"byteLength":48},{"buffer":0,"byteLength":12})";  // the bits of three floats of 0
    wide.indices = R"({"bufferView":1,"componentType":5125,"count":3,"type":"SCALAR"})";
    CHECK(load(wide.text()).mesh.triangles == triangles{{0, 0, 0}});
}

TEST_CASE("glTF: nodes transform their children") {
    // Scaled by 2, then rotated by 90 degrees about z.
    const std::string rotated = R"("rotation":[0,0,0.70710678118654757,0.70710678118654757],"scale":[2,2,2])";
    parts p;
    p.nodes = R"({"mesh":0,"translation":[10,0,0],"children":[1,2]},{"mesh":0,)" + rotated +
              R"(},{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,5,1]})";
    const aabb::mesh mesh = load(p.text()).mesh;
    REQUIRE(mesh.vertices.size() == 12);
    CHECK(mesh.vertices[1] == aabb::vec3f{11, 0, 0});
    CHECK(mesh.vertices[5][1] == 2);
    CHECK(std::abs(mesh.vertices[5][0] - 10) < 1e-6F);
    CHECK(mesh.vertices[8] == aabb::vec3f{10, 0, 5});
    CHECK(mesh.triangles[2] == std::array<std::uint32_t, 3>{4, 5, 6});
}

TEST_CASE("glTF: invalid files are rejected with the place of the error") {
    struct wrong {
        std::string parts::* part;
        std::string with;
        std::string error;
    };
    const std::string last = R"(,"type":"SCALAR"})";
    const wrong cases[] = {
        {&parts::asset, R"({"version":"1.0"})", "is glTF of version '1.0'; only version 2 is read"},
        {&parts::more, R"(,"extensionsRequired":["KHR_draco_mesh_compression"])",
         "the file requires the extension 'KHR_draco_mesh_compression', which is not supported"},
        {&parts::more, R"(,"scene":1)", "the file shows scene 1, but it has 1"},
        {&parts::scene, R"({"nodes":[7]})", "nodes[7] is used, but does not exist"},
        {&parts::scene, R"({"nodes":[-1]})", "scenes[0].nodes must be a list of whole numbers"},
        {&parts::scene, "5", "scenes[0] must be an object"},
        {&parts::scene, R"({"nodes":[0,0]})", "nodes[0] occurs more than once in the scene"},
        {&parts::nodes, R"({"mesh":0,"children":[0]})", "nodes[0] occurs more than once in the scene"},
        {&parts::nodes, R"({"mesh":1})", "meshes[1] is used, but does not exist"},
        {&parts::nodes, R"({"mesh":0.5})", "nodes[0].mesh must be a whole number"},
        {&parts::nodes, R"({"mesh":0,"matrix":[1]})", "nodes[0].matrix must be a list of 16 numbers"},
        {&parts::nodes, R"({"mesh":0,"matrix":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]})",
         "nodes[0] has a matrix whose last row is not 0 0 0 1"},
        {&parts::nodes, R"({"mesh":0,"rotation":[1,1,1,1]})",
         "nodes[0] has a rotation that is not a quaternion of length 1"},
        {&parts::nodes, R"({"mesh":0,"scale":[1e308,1,1],"translation":[1e308,0,0]})",
         "vertex 1 has a coordinate that is not finite, and a face uses it"},
        {&parts::nodes, "{}", "the mesh has no triangles (1 mesh outside the scene left out)"},
        {&parts::primitive, R"({"attributes":{"NORMAL":0}})", "meshes[0] has a primitive without positions"},
        {&parts::primitive, R"({"attributes":{"POSITION":0},"mode":7})",
         "meshes[0] has a primitive of mode 7; modes are 0 to 6"},
        {&parts::primitive, R"({"attributes":{"POSITION":2}})", "accessors[2] is used, but does not exist"},
        {&parts::primitive, R"({"attributes":{"POSITION":1}})",
         "accessors[1] must be of floats and VEC3, as it has positions"},
        {&parts::primitive, R"({"attributes":{"POSITION":0},"indices":0})",
         "accessors[0] must be of whole numbers and SCALAR, as it has indices"},
        {&parts::buffer, R"({"uri":"a.bin","byteLength":61})", "buffers[0]: announces 61 bytes, but has 60"},
        {&parts::buffer, R"({"uri":"a.bin"})", "buffers[0].byteLength is missing"},
        {&parts::buffer, R"({"uri":5,"byteLength":60})", "buffers[0].uri must be a string"},
        {&parts::buffer, R"({"byteLength":60})", "buffers[0]: has neither a uri nor the binary chunk of a .glb file"},
        {&parts::buffer, R"({"uri":"https://example.org/a.bin","byteLength":60})",
         "buffers[0]: is at 'https://example.org/a.bin', but only files and data: URIs are read"},
        {&parts::buffer, R"({"uri":"data:,x","byteLength":1})", "buffers[0]: is a data: URI without ;base64,"},
        {&parts::buffer, R"({"uri":"data:;base64,AA*A","byteLength":1})",
         "buffers[0]: is a data: URI that is not base64"},
        {&parts::buffer, R"({"uri":"data:;base64,AAAAA","byteLength":1})",
         "buffers[0]: is a data: URI that is not base64"},
        {&parts::views, R"({"buffer":1,"byteLength":48})", "buffers[1] is used, but does not exist"},
        {&parts::views, R"({"buffer":0,"byteLength":61})", "bufferViews[0] reaches beyond the end of buffers[0]"},
        {&parts::views, R"({"buffer":0,"byteOffset":18446744073709551615,"byteLength":48})",
         "bufferViews[0] reaches beyond the end of buffers[0]"},
        {&parts::views, R"({"buffer":0,"byteLength":48,"byteStride":8})",
         "bufferViews[0] has a byteStride below the 12 bytes of one"},
        {&parts::views, R"({"buffer":0,"byteLength":48})", "bufferViews[1] is used, but does not exist"},
        {&parts::positions, R"({"componentType":5126,"count":4,"type":"VEC3"})",
         "accessors[0] has no bufferView, so its numbers are not in the file"},
        {&parts::positions, R"({"bufferView":0,"componentType":5126,"count":5,"type":"VEC3"})",
         "accessors[0] reaches beyond the end of bufferViews[0]"},
        {&parts::positions, R"({"bufferView":0,"componentType":5126,"count":18446744073709551615,"type":"VEC3"})",
         "accessors[0] reaches beyond the end of bufferViews[0]"},
        {&parts::positions,
         R"({"bufferView":0,"byteOffset":18446744073709551615,"componentType":5126,"count":1,)"
         R"("type":"VEC3"})",
         "accessors[0] reaches beyond the end of bufferViews[0]"},
        {&parts::positions, R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","sparse":{}})",
         "accessors[0].sparse.indices is missing"},
        {&parts::positions, R"({"bufferView":0,"componentType":5126,"count":4,"type":"VEC3","normalized":1})",
         "accessors[0].normalized must be true or false"},
        {&parts::nodes, R"({"mesh":0,"weights":[1]})", "meshes[0] has a primitive of 0 morph targets, but 1 weight"},
        {&parts::nodes, R"({"mesh":0,"weights":["x"]})", "nodes[0].weights must be a list of numbers"},
        {&parts::nodes, R"({"mesh":0,"extensions":{"EXT_mesh_gpu_instancing":{}}})",
         "nodes[0] has the extension 'EXT_mesh_gpu_instancing', which is not supported"},
        {&parts::nodes, R"({"mesh":0,"skin":0})", "skins[0] is used, but does not exist"},
        {&parts::positions, R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})",
         "meshes[0] has a face that uses vertex 3, but there are 3 vertices, counted from 0"},
        {&parts::indices, R"({"bufferView":1,"componentType":5122,"count":6)" + last,
         "accessors[1] must be of whole numbers and SCALAR, as it has indices"},
        {&parts::indices, R"({"bufferView":1,"componentType":5123,"count":7)" + last,
         "accessors[1] reaches beyond the end of bufferViews[1]"},
    };
    for (const wrong& invalid : cases) {
        parts p;
        p.*invalid.part = invalid.with;
        CHECK_THAT(error_of(p.text()), EndsWith("/a.gltf: " + invalid.error));
    }
    CHECK_THAT(error_of(parts{.buffer = R"({"uri":"absent.bin","byteLength":60})"}.text()),
               EndsWith("/absent.bin: no such file"));
    CHECK_THAT(error_of(R"({"asset":{"version":"2.0"}})"), EndsWith("/a.gltf: the file has no scene"));
    CHECK_THAT(error_of("{\n\n\"asset\":}"), EndsWith("/a.gltf:3: is not a glTF file: its JSON is malformed"));
}

TEST_CASE("glTF: morph targets use the weights of the node, or else of the mesh") {
    const auto at = [](const std::string& node, const std::string& mesh, const std::string& targets = both) {
        return load(morphed(node, mesh, targets)).mesh.vertices;
    };
    const points rest = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    CHECK(at("", "") == rest);
    CHECK(at("", R"("weights":[0,0],)") == rest);
    CHECK(at("", R"("weights":[0.5,0],)") == points{{2.5F, 0, 0}, {3.5F, 0, 0}, {2.5F, 1, 0}});
    CHECK(at("", R"("weights":[1,-2],)") == points{{5, 0, 0}, {6, 0, 0}, {5, 1, -6}});
    CHECK(at(R"(,"weights":[0,1])", R"("weights":[1,0],)") == points{{0, 0, 0}, {1, 0, 0}, {0, 1, 3}});
    CHECK(at(R"(,"translation":[0,0,7],"weights":[0,1])", "") == points{{0, 0, 7}, {1, 0, 7}, {0, 1, 10}});
    // One target moves only normals, the other has implicit zeros.
    CHECK(at("", R"("weights":[1,1],)", R"({"NORMAL":1},{"POSITION":3})") == rest);

    CHECK_THAT(error_of(morphed("", R"("weights":[1],)", both)),
               EndsWith("/a.gltf: meshes[0] has a primitive of 2 morph targets, but 1 weight"));
    CHECK_THAT(error_of(morphed("", R"("weights":[1],)", R"({"POSITION":4})")),
               EndsWith("/a.gltf: meshes[0] has a morph target for a number of vertices other than its own: 1, not 3"));
    CHECK_THAT(error_of(morphed("", R"("weights":[1],)", R"({"POSITION":9})")),
               EndsWith("/a.gltf: accessors[9] is used, but does not exist"));
}

TEST_CASE("glTF: sparse accessors replace elements of their view") {
    const auto read_sparse = [](std::uint16_t index) {
        asset file;
        const std::size_t dense = file.add_view(triangle);
        const std::size_t indices = file.add_view(std::vector<std::uint16_t>{0, index});
        const std::size_t values = file.add_view(std::vector<float>{7, 7, 7, 8, 8, 8});
        file.add_accessor(R"("bufferView":)" + std::to_string(dense) +
                              R"(,"sparse":{"count":2,"indices":{"bufferView":)" + std::to_string(indices) +
                              R"(,"componentType":5123},"values":{"bufferView":)" + std::to_string(values) + "}}",
                          5126, "VEC3", 3);
        return file.text(R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
                         R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])");
    };
    CHECK(load(read_sparse(2)).mesh.vertices == points{{7, 7, 7}, {1, 0, 0}, {8, 8, 8}});
    CHECK_THAT(error_of(read_sparse(3)), EndsWith("accessors[0] replaces element 3, but has 3, counted from 0"));
}

TEST_CASE("glTF: joints transform a skinned mesh") {
    const auto at = [](const skin& s) {
        const aabb::mesh m = load(s.text()).mesh;
        points rounded;
        for (std::size_t v = 0; v < m.vertices.size(); ++v) {
            const aabb::vec3d p = m.given_vertex(v);
            rounded.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
        }
        return rounded;
    };
    // The first corner follows joint 0, the second, at z = -1 of joint 1, is rotated, the third is halfway.
    CHECK(at({}) == points{{10, 0, 0}, {0, 21, -1}, {4.5F, 10.5F, -0.5F}});
    // Without matrices the joints are bound at the origin.
    CHECK(at({.members = R"("joints":[1,2])"}) == points{{10, 0, 0}, {0, 21, 0}, {4.5F, 10.5F, 0}});
    // Weights of two sets, in normalized numbers of other types: a third and two thirds.
    CHECK(at({.members = R"("joints":[1,2])",
              .attributes = R"("POSITION":0,"JOINTS_0":1,"WEIGHTS_0":4,"JOINTS_1":5,"WEIGHTS_1":6)"})[0] ==
          aabb::vec3f{10.0F / 3, 40.0F / 3, 0});
    // Rounded weights do not shrink the mesh.
    CHECK(at({.weights = {0.995F, 0, 0, 0, 0, 1, 0, 0, 0.5F, 0.5F, 0, 0}})[0] == aabb::vec3f{10, 0, 0});

    const std::vector<std::pair<skin, std::string>> wrong = {
        {{.weights = {0.5F, 0, 0, 0, 0, 1, 0, 0, 0.5F, 0.5F, 0, 0}},
         "meshes[0] has a vertex whose joint weights sum to 0.5, not 1"},
        {{.joints = {7, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}},
         "meshes[0] has a vertex that refers to joint 7, counted from 0, but its skin has 2 joints"},
        {{.joint_type = 5120}, "accessors[1] must be of whole numbers and VEC4, as it has joints"},
        {{.joints = {0, 0, 0, 0}}, "meshes[0] has 3 positions, but joints of 1 and weights of 3 vertices"},
        {{.members = R"("joints":[1,9])"}, "nodes[9] is used, but does not exist"},
        {{.members = R"("joints":[1,2,0],"inverseBindMatrices":3)"},
         "skins[0] has 3 joints, but 2 inverse bind matrices"},
        {{.members = R"("joints":[1,2],"inverseBindMatrices":0)"},
         "accessors[0] must be of floats and MAT4, as it has inverse bind matrices"},
        {{.roots = "0"}, "nodes[1] is a joint of skins[0], but not in the scene"},
        {{.inverse = std::vector<float>(32, 1)}, "skins[0] has an inverse bind matrix whose last row is not 0 0 0 1"},
        {{.attributes = R"("POSITION":0)"},
         "meshes[0] has a skin and a primitive of 0 lists of joints and 0 of weights"},
        {{.attributes = R"("POSITION":0,"JOINTS_0":1,"WEIGHTS_0":1)"},
         "accessors[1] must be of floats or normalized numbers and VEC4, as it has weights of joints"},
    };
    for (const auto& [with, error] : wrong) CHECK_THAT(error_of(with.text()), EndsWith("/a.gltf: " + error));
}

TEST_CASE("glTF: quantized positions are read if the file declares them") {
    const auto quantized = [](const std::string& extensions, int component, const std::string& more) {
        asset file;
        file.add(component, "VEC3", 3, std::vector<std::int8_t>{-128, 0, 0, 127, 0, 0, 0, 127, 0}, more);
        return file.text(extensions + R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
                                      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])");
    };
    const std::string used = R"("extensionsUsed":["KHR_mesh_quantization"],)";
    const std::string required = used + R"("extensionsRequired":["KHR_mesh_quantization"],)";
    CHECK(load(quantized(required, 5120, "")).mesh.vertices == points{{-128, 0, 0}, {127, 0, 0}, {0, 127, 0}});
    CHECK(load(quantized(used, 5120, R"(,"normalized":true)")).mesh.vertices ==
          points{{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    CHECK(load(quantized(used, 5121, R"(,"normalized":true)")).mesh.vertices[0] == aabb::vec3f{128.0F / 255, 0, 0});
    CHECK_THAT(error_of(quantized("", 5120, "")),
               EndsWith("/a.gltf: accessors[0] must be of floats and VEC3, as it has positions"));
}

TEST_CASE("glTF: omitted parts are counted") {
    parts p;
    p.more = R"(,"scene":0,"animations":[{},{}])";
    p.primitive = R"({"attributes":{"POSITION":0},"indices":1},{"attributes":{"POSITION":0}},)"
                  R"({"attributes":{"POSITION":0},"mode":1}]},{"primitives":[)";
    CHECK(load(p.text()).report.text() ==
          "3 faces of fewer than three corners dropped, 2 animations ignored, 1 mesh outside the scene left out");
}

TEST_CASE("glTF: a .glb file with wrong lengths is rejected") {
    const std::string json = chunk(json_chunk, parts{}.text(), ' ');
    const std::string version_1 = "glTF" + raw(1U) + raw(106U) + raw(86U) + raw(0U) + "{}" + std::string(84, ' ');
    // A general library guesses the format from words in this, and reads past its end.
    const std::string guess = "g\x1cgeometrynode'" + raw(std::uint8_t{0}) + "\x01" + raw(std::uint8_t{0}) + "n,";
    for (const auto& [bytes, error] : {
             std::pair{version_1, std::string(": is glTF of version 1; only version 2 is read")},
             {guess, ":1: is not a glTF file: its JSON is malformed"},
             {std::string("glTF"), ": is not a glTF file: it ends in the header of 12 bytes"},
             {glb(json) + "x", ": is not a glTF file: its header announces"},
             {glb(""), ": is not a glTF file: it ends in the header of the chunk at byte 12"},
             {glb(raw(0xffffffffU) + raw(json_chunk) + "{}"),
              ": is not a glTF file: the chunk at byte 12 announces 4294967295 bytes, but the file has 2 of them"},
             {glb(json + raw(8U)), ": is not a glTF file: it ends in the header of the chunk at byte"},
             {glb(chunk(binary_chunk, binary(), 0)), ": is not a glTF file: its first chunk is not JSON"},
             {glb(chunk(json_chunk, "{]", ' ')), ": is not a glTF file: its JSON is malformed at byte 2"},
         })
        CHECK_THAT(error_of(bytes, "a.glb"), Catch::Matchers::ContainsSubstring("/a.glb" + error));
}
