#include <array>
#include <catch2/catch_test_macros.hpp>
#include <catch2/matchers/catch_matchers_string.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "mesh_bytes.hpp"
#include "temporary_folder.hpp"

import aabb;
import aabblab.files;

using Catch::Matchers::EndsWith;

namespace {

using triangles = std::vector<std::array<std::uint32_t, 3>>;

/// Where each part of a file can be another.
struct parts {
    std::string asset = R"({"version":"2.0"})";
    std::string more;  // members of the file
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
const triangles two = {{0, 1, 2}, {0, 2, 3}};

std::string chunk(std::uint32_t type, std::string bytes, char padding) {
    while (bytes.size() % 4 != 0) bytes += padding;
    return raw(static_cast<std::uint32_t>(bytes.size())) + raw(type) + bytes;
}
std::string glb(const std::string& chunks, std::uint32_t version = 2) {
    return "glTF" + raw(version) + raw(static_cast<std::uint32_t>(12 + chunks.size())) + chunks;
}
constexpr std::uint32_t json_chunk = 0x4e4f534a;
constexpr std::uint32_t binary_chunk = 0x004e4942;

aabblab::loaded_mesh read(const std::string& bytes, const std::string& name = "a.gltf") {
    const temporary_folder folder;
    folder.write("a.bin", binary());
    folder.write("a b.bin", binary());
    return aabblab::read_mesh(folder.write(name, bytes));
}

std::string error_of(const std::string& bytes, const std::string& name = "a.gltf") {
    try {
        static_cast<void>(read(bytes, name));
    } catch (const aabb::input_error& error) {
        return error.what();
    }
    return "no error";
}

}  // namespace

TEST_CASE("glTF: a buffer beside the file, in it, or in a .glb file") {
    CHECK(read(parts{}.text()).mesh.triangles == two);
    parts named;
    named.buffer = R"({"uri":"a%20b.bin","byteLength":60})";
    CHECK(read(named.text()).mesh.triangles == two);
    parts inside;
    inside.buffer = R"({"byteLength":60,"uri":"data:application/octet-stream;base64,)"
                    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAABAAIAAAACAAMA\"}";
    CHECK(read(inside.text()).mesh.triangles == two);
    parts held;
    held.buffer = R"({"byteLength":60})";
    const std::string other = chunk(0x12345678, "something else", 0);
    const std::string file = glb(chunk(json_chunk, held.text(), ' ') + chunk(binary_chunk, binary(), 0) + other);
    CHECK(read(file, "a.glb").mesh.triangles == two);
    CHECK(read(file, "a.glb").mesh.vertices[3] == aabb::vec3f{0, 0, 1});
}

TEST_CASE("glTF: every mode of primitives, every type of indices, with a stride or without indices") {
    const auto mode = [](int number, const std::string& indices) {
        parts p;
        p.primitive = R"({"attributes":{"POSITION":0})" + indices + R"(,"mode":)" + std::to_string(number) + "}";
        return p;
    };
    CHECK(read(mode(5, "").text()).mesh.triangles == triangles{{0, 1, 2}, {1, 3, 2}});
    CHECK(read(mode(6, "").text()).mesh.triangles == triangles{{0, 1, 2}, {0, 2, 3}});
    CHECK(read(mode(4, "").text()).mesh.triangles == triangles{{0, 1, 2}});
    for (const auto& [number, dropped] : {std::pair{0, 6}, {1, 3}, {2, 6}, {3, 5}}) {
        parts p = mode(number, R"(,"indices":1)");
        p.primitive += "," + mode(4, "").primitive;
        CHECK(read(p.text()).report.dropped == static_cast<std::size_t>(dropped));
    }
    parts strided;
    strided.views = R"({"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12,"byteStride":2})";
    strided.indices = R"({"bufferView":1,"componentType":5121,"count":3,"type":"SCALAR","byteOffset":6})";
    CHECK(read(strided.text()).mesh.triangles == triangles{{0, 2, 3}});
    parts wide;
    wide.views = R"({"buffer":0,"byteLength":48},{"buffer":0,"byteLength":12})";  // the bits of three floats of 0
    wide.indices = R"({"bufferView":1,"componentType":5125,"count":3,"type":"SCALAR"})";
    CHECK(read(wide.text()).mesh.triangles == triangles{{0, 0, 0}});
}

TEST_CASE("glTF: nodes place what is below them") {
    // A quarter turn around z, after twice the size.
    const std::string turned = R"("rotation":[0,0,0.70710678118654757,0.70710678118654757],"scale":[2,2,2])";
    parts p;
    p.nodes = R"({"mesh":0,"translation":[10,0,0],"children":[1,2]},{"mesh":0,)" + turned +
              R"(},{"mesh":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,5,1]})";
    const aabb::mesh mesh = read(p.text()).mesh;
    REQUIRE(mesh.vertices.size() == 12);
    CHECK(mesh.vertices[1] == aabb::vec3f{11, 0, 0});
    CHECK(mesh.vertices[5][1] == 2);
    CHECK(std::abs(mesh.vertices[5][0] - 10) < 1e-6F);
    CHECK(mesh.vertices[8] == aabb::vec3f{10, 0, 5});
    CHECK(mesh.triangles[2] == std::array<std::uint32_t, 3>{4, 5, 6});
}

TEST_CASE("glTF: what cannot be right is refused with its place") {
    struct wrong {
        std::string parts::* part;
        std::string with;
        std::string error;
    };
    const std::string last = R"(,"type":"SCALAR"})";
    const wrong all[] = {
        {&parts::asset, R"({"version":"1.0"})", "is glTF of version '1.0'; only version 2 is read"},
        {&parts::more, R"(,"extensionsRequired":["KHR_draco_mesh_compression"])",
         "the file requires the extension 'KHR_draco_mesh_compression', which is not supported"},
        {&parts::more, R"(,"scene":1)", "the file shows scene 1, but it has 1"},
        {&parts::scene, R"({"nodes":[7]})", "nodes[7] is used, but is not there"},
        {&parts::scene, R"({"nodes":[-1]})", "scenes[0].nodes must be a list of whole numbers"},
        {&parts::scene, "5", "scenes[0] must be an object"},
        {&parts::scene, R"({"nodes":[0,0]})", "nodes[0] stands in more than one place of the scene"},
        {&parts::nodes, R"({"mesh":0,"children":[0]})", "nodes[0] stands in more than one place of the scene"},
        {&parts::nodes, R"({"mesh":1})", "meshes[1] is used, but is not there"},
        {&parts::nodes, R"({"mesh":0.5})", "nodes[0].mesh must be a whole number"},
        {&parts::nodes, R"({"mesh":0,"matrix":[1]})", "nodes[0].matrix must be a list of 16 numbers"},
        {&parts::nodes, R"({"mesh":0,"matrix":[1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1]})",
         "nodes[0] has a matrix whose last row is not 0 0 0 1"},
        {&parts::nodes, R"({"mesh":0,"rotation":[1,1,1,1]})",
         "nodes[0] has a rotation that is not a quaternion of length 1"},
        {&parts::nodes, R"({"mesh":0,"scale":[1e300,1,1]})", "vertex 1 has a coordinate that is not finite"},
        {&parts::nodes, "{}", "the mesh has no triangles"},
        {&parts::primitive, R"({"attributes":{"NORMAL":0}})", "meshes[0] has a primitive without positions"},
        {&parts::primitive, R"({"attributes":{"POSITION":0},"mode":7})",
         "meshes[0] has a primitive of mode 7; modes are 0 to 6"},
        {&parts::primitive, R"({"attributes":{"POSITION":2}})", "accessors[2] is used, but is not there"},
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
        {&parts::views, R"({"buffer":1,"byteLength":48})", "buffers[1] is used, but is not there"},
        {&parts::views, R"({"buffer":0,"byteLength":61})", "bufferViews[0] reaches beyond the end of buffers[0]"},
        {&parts::views, R"({"buffer":0,"byteOffset":18446744073709551615,"byteLength":48})",
         "bufferViews[0] reaches beyond the end of buffers[0]"},
        {&parts::views, R"({"buffer":0,"byteLength":48,"byteStride":8})",
         "bufferViews[0] has a byteStride below the 12 bytes of one"},
        {&parts::views, R"({"buffer":0,"byteLength":48})", "bufferViews[1] is used, but is not there"},
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
         "accessors[0] is sparse, which is not supported"},
        {&parts::positions, R"({"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"})",
         "meshes[0] has a face that uses vertex 3, but there are 3 vertices, counted from 0"},
        {&parts::indices, R"({"bufferView":1,"componentType":5122,"count":6)" + last,
         "accessors[1] must be of whole numbers and SCALAR, as it has indices"},
        {&parts::indices, R"({"bufferView":1,"componentType":5123,"count":7)" + last,
         "accessors[1] reaches beyond the end of bufferViews[1]"},
    };
    for (const wrong& one : all) {
        parts p;
        p.*one.part = one.with;
        CHECK_THAT(error_of(p.text()), EndsWith("/a.gltf: " + one.error));
    }
    parts absent;
    absent.buffer = R"({"uri":"absent.bin","byteLength":60})";
    CHECK_THAT(error_of(absent.text()), EndsWith("/absent.bin: no such file"));
    CHECK_THAT(error_of(R"({"asset":{"version":"2.0"}})"), EndsWith("/a.gltf: the file has no scene"));
    CHECK_THAT(error_of("{\n\n\"asset\":}"), EndsWith("/a.gltf:3: is no glTF file: its JSON is malformed"));
    CHECK_THAT(error_of("[1e999]"), EndsWith("/a.gltf: is no glTF file: a number in it does not fit a double"));
    CHECK_THAT(error_of("[]"), EndsWith("/a.gltf: the file must be an object"));
}

TEST_CASE("glTF: a .glb file whose lengths lie is refused") {
    const std::string json = chunk(json_chunk, parts{}.text(), ' ');
    const std::string old = "glTF" + raw(1U) + raw(106U) + raw(86U) + raw(0U) + "{}" + std::string(84, ' ');
    // A general library guesses the format from words anywhere in this, and reads beyond its end.
    const std::string guess = "g\x1cgeometrynode'" + raw(std::uint8_t{0}) + "\x01" + raw(std::uint8_t{0}) + "n,";
    for (const auto& [bytes, error] : {
             std::pair{old, std::string(": is glTF of version 1; only version 2 is read")},
             {guess, ":1: is no glTF file: its JSON is malformed"},
             {std::string("glTF"), ": is no glTF file: it ends in the header of 12 bytes"},
             {glb(json) + "x", ": is no glTF file: its header announces"},
             {glb(""), ": is no glTF file: it ends in the head of the chunk at byte 12"},
             {glb(raw(0xffffffffU) + raw(json_chunk) + "{}"),
              ": is no glTF file: the chunk at byte 12 announces 4294967295 bytes, but the file has 2 of them"},
             {glb(json + raw(8U)), ": is no glTF file: it ends in the head of the chunk at byte"},
             {glb(chunk(binary_chunk, binary(), 0)), ": is no glTF file: its first chunk is not JSON"},
             {glb(chunk(json_chunk, "{]", ' ')), ": is no glTF file: its JSON is malformed at byte 2"},
         })
        CHECK_THAT(error_of(bytes, "a.glb"), Catch::Matchers::ContainsSubstring("/a.glb" + error));
}
