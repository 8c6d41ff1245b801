#include <random>

#include "configs.hpp"
#include "mesh_bytes.hpp"
#include "text_encodings.hpp"

import aabb.extreme;
import aabblab.errors;

using Catch::Matchers::ContainsSubstring;
using Catch::Matchers::EndsWith;

namespace {

/// A text format: a sample, and a function that summarises what is read from it.
struct text_format {
    std::string file;
    std::string text;
    std::function<std::string(const std::filesystem::path&)> read;
    std::size_t wrong_line;  ///< the line in which `wrong` is an error
    std::string right, wrong;

    [[nodiscard]] std::string damaged() const { return replaced(text, right, wrong); }
};

std::string text_of_mesh(const std::filesystem::path& file) {
    const aabblab::loaded_mesh loaded = aabblab::read_mesh(file);
    std::string text = loaded.report.text() + "\n";
    for (const aabb::vec3f& v : loaded.mesh.vertices)
        for (int k = 0; k < 3; ++k) text += std::to_string(v[k]) + " ";
    for (const auto& triangle : loaded.mesh.triangles)
        for (const std::uint32_t corner : triangle) text += std::to_string(corner) + " ";
    return text;
}

/// The output of a command; throws its error if it fails.
std::string output_of(const std::vector<std::string>& command) {
    const program_result result = run_program(command);
    if (result.status != 0) throw aabb::input_error(result.err);
    return result.out;
}

std::string text_of_motion(const std::filesystem::path& file) {
    const auto scene = aabblab::open_motion(file, {aabblab::make_mesh("icosphere:triangles=20").mesh});
    std::string text;
    for (std::vector<aabb::pose> poses; scene->next(poses);)
        for (const aabb::pose& p : poses) text += std::to_string(p.translation[0]) + " ";
    return text;
}

std::string text_of_poses(const std::filesystem::path& file) {
    const std::string out = file.string() + ".pairs.csv";
    (void)output_of({"collide", "icosphere:triangles=20", "square", "--poses", file, "--out", out});
    return bytes_of_file(out);
}

std::string text_of_rows(const std::filesystem::path& file) {
    std::string text;
    for (const aabblab::row& r : aabblab::read_rows(file)) text += r.key() + r.status;
    return text;
}

std::string text_of_error_rows(const std::filesystem::path& file) {
    std::string text;
    for (const auto& p : aabblab::read_error_rows(file)) text += p.pairs + " " + std::to_string(p.count) + "\n";
    return text;
}

std::string text_of_cases(const std::filesystem::path& file) {
    std::string text;
    for (const aabb::triangle_case& c : aabblab::read_triangle_cases(file)) text += c.name + " " + c.about + "\n";
    return text;
}

std::string text_of_costs(const std::filesystem::path& file) {
    const aabblab::calibrated_costs kept = aabblab::read_costs(file);
    return kept.processor + " " + kept.instructions + " " + kept.date;
}

const std::string facets =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string gltf =
    "{\"asset\":{\"version\":\"2.0\"},\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],\n"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\n"
    "\"buffers\":[{\"byteLength\":36,\"uri\":\"data:application/octet-stream;base64,"
    "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}],\n"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\n"
    "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\"}]}\n";
const std::string config = "name = \"c\"\n# about\n[[scene]]\nkind = \"brownian\"\nobjects = 20\nframes = 1\n";
const std::string cases =
    "[[case]]\nname = \"one\"\nsource = \"s\"\nabout = \"a\"\nclass = \"crossing\"\n"
    "first = [[0, 0, 0], [2, 0, 0], [0, 2, 0]]\nsecond = [[1, 1, 0], [1, 1, 3], [2, 1, 3]]\nintersect = true\n";

std::string rows() {
    const temporary_folder folder;
    (void)output_of({"run", folder.write("c.toml", config + "[measure]\nrepeats = 1\n"), "--out", folder / "out"});
    return bytes_of_file(folder / "out/results.csv");
}

std::string error_rows() {
    return aabblab::csv_of(std::span<const aabblab::error_point>()) + "fine,float,curve,exact,3,1,0,0,1.5,1,2,,,\n";
}

std::vector<text_format> formats() {
    return {
        {"a.off", tetrahedron, text_of_mesh, 4, "1 0 0", "1 x 0"},
        {"a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", text_of_mesh, 3, "v 0 1", "v 0 x"},
        {"a.stl", "solid a\n" + facets + "endsolid a\n", text_of_mesh, 5, "vertex 1 0", "vertex 1 x"},
        {"b.stl", " \n \tsolid a\n" + facets + "endsolid a\n", text_of_mesh, 6, "vertex 1 0", "vertex 1 x"},
        {"a.ply", ply, text_of_mesh, 11, "1 0 0", "1 x 0"},
        {"h.ply", ply, text_of_mesh, 3, "element vertex", "elements vertex"},
        {"a.gltf", gltf, text_of_mesh, 2, "\"meshes\":", "\"meshes\";"},
        {"a.glb", gltf, text_of_mesh, 2, "\"meshes\":", "\"meshes\";"},
        {"m.txt", "# frames\n0 0 1 0 0 0 0 1 0 0 0 0 1 0\n1 0 1 0 0 2 0 1 0 0 0 0 1 0\n", text_of_motion, 3,
         "1 0 1 0 0 2", "1 0 1 0 0 x"},
        {"p.txt", "# b\n1 0 0 0 0 1 0 0 0 0 1 0\n1,0,0,5, 0,1,0,0, 0,0,1,0\n", text_of_poses, 3, "1,0,0,5", "1,0,0,x"},
        {"c.txt", "0 0 0 1 0 0 0 1 0  .2 .2 -1 .2 .2 1 .3 .3 1\n# apart\n0 0 0 1 0 0 0 1 0  5 5 5 6 5 5 5 6 5\n",
         [](const std::filesystem::path& file) { return output_of({"classify", file}); }, 3, "5 5 5", "5 x 5"},
        {"c.toml", config,
         [](const std::filesystem::path& file) {
             return hash_of(aabblab::read_experiment(file, aabblab::experiment_size::full));
         },
         5, "objects = 20", "objects = x"},
        {"cases.toml", cases, text_of_cases, 4, "about = \"a\"", "about = a"},
        {"costs.toml", aabblab::text_of(aabblab::label_costs({})), text_of_costs, 1, "version =", "versjon ="},
        {"results.csv", rows(), text_of_rows, 2, "exact", "right"},
        {"errors.csv", error_rows(), text_of_error_rows, 2, "float", "half"},
    };
}

std::string error_of(const text_format& format, const std::filesystem::path& file) {
    try {
        return "read: " + format.read(file);
    } catch (const aabb::input_error& error) {
        std::string sentence = error.what();
        if (sentence.ends_with('\n')) sentence.pop_back();
        return sentence;
    }
}

}  // namespace

TEST_CASE("Every text format is read in all encodings and line endings, and errors name the same line") {
    for (const text_format& format : formats()) {
        const temporary_folder folder;
        const std::string read = format.read(folder.write(format.file, format.text));
        const std::string rejection = error_of(format, folder.write(format.file, format.damaged()));
        CHECK_THAT(rejection, ContainsSubstring(format.file + ":" + std::to_string(format.wrong_line) + ":"));
        for (const auto& [encoding, bytes] : unambiguous_encodings(format.text)) {
            INFO(format.file << ", " << encoding);
            CHECK(error_of(format, folder.write(format.file, bytes)) == "read: " + read);
        }
        for (const auto& [encoding, bytes] : unambiguous_encodings(format.damaged())) {
            INFO(format.file << ", " << encoding);
            CHECK(error_of(format, folder.write(format.file, bytes)) == rejection);
        }
    }
}

TEST_CASE("Every text format rejects binary and ambiguous input with the reason") {
    for (const text_format& format : formats()) {
        INFO(format.file);
        const temporary_folder folder;
        const auto rejection_of = [&](const std::string& bytes) {
            return error_of(format, folder.write(format.file, bytes));
        };
        const std::string head = format.file + ": is ";
        CHECK_THAT(rejection_of(widened(format.text, 0, 1)),
                   EndsWith(head + "text in UTF-16 without a byte order mark; expected UTF-8"));
        CHECK_THAT(rejection_of(widened(format.text, 1, 0)),
                   EndsWith(head + "text in UTF-16 without a byte order mark; expected UTF-8"));
        CHECK_THAT(rejection_of(std::string("\xff\xfe\0\0", 4) + widened(format.text, 0, 3)),
                   EndsWith(head + "text in UTF-32; expected UTF-8"));
        const std::size_t second = format.text.find('\n') + 1;
        // Text STL is distinguished from binary by its content.
        const bool may_be_binary = format.file.ends_with(".stl");
        for (const auto& [mark, name] : {std::pair{'\0', "a NUL byte"}, {'\x1a', "Ctrl-Z"}}) {
            std::string bytes = format.text;
            bytes.insert(second, 1, mark);
            const std::string rejection = rejection_of(bytes);
            CHECK_FALSE(holds(rejection, "read: "));
            if (!may_be_binary)
                CHECK_THAT(rejection, EndsWith(head + "not text: " + name + " in line 2, with more text after it"));
        }
        // A carriage return replaces one line feed. Line ends do not matter in JSON.
        if (format.text == gltf) continue;
        std::string mixed = format.text;
        mixed[second - 1] = '\r';
        CHECK_THAT(rejection_of(mixed), !ContainsSubstring("read: "));
        mixed = with_line_ends(format.text, "\r");
        mixed[second - 1] = '\n';
        CHECK_THAT(rejection_of(mixed), !ContainsSubstring("read: "));
    }
    const temporary_folder folder;
    CHECK_THAT(
        error_of(formats()[0], folder.write("a.off", "OFF\r3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n")),
        EndsWith("a.off:2: some lines end in carriage returns alone, others in line feeds; expected one of the two"));
}

TEST_CASE_METHOD(in_folder, "UTF-16 becomes UTF-8, with unpaired surrogates replaced") {
    // "# é€𝄞\n", then an unpaired high surrogate.
    const std::string comment("#\0 \0\xe9\0\xac\x20\x34\xd8\x1e\xdd\n\0#\0\x34\xd8\n\0", 20);
    CHECK(aabblab::text_of_file(folder.write("a.txt", "\xff\xfe" + comment)) ==
          "# \xc3\xa9\xe2\x82\xac\xf0\x9d\x84\x9e\n#\xef\xbf\xbd\n");
    CHECK_NOTHROW(aabblab::read_mesh(folder.write("a.off", "\xff\xfe" + comment + widened(tetrahedron, 0, 1))));
}

TEST_CASE_METHOD(in_folder, "Binary PLY is read with any line endings of its header and with a byte order mark") {
    const std::string header =
        "ply\nformat binary_little_endian 1.0\ncomment end_header\nelement vertex 3\nproperty uchar tag\nproperty "
        "float x\n"
        "property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    for (const char tag : {'\n', '\r', '\0', '\x1a'}) {
        std::string values;
        for (const float x : {0.0F, 1.0F, 2.0F}) values += tag + raw(x) + raw(x * x) + raw(1.0F);
        values += raw(std::uint8_t{3}) + raw(0) + raw(1) + raw(2);
        for (const std::string& end : {"\n", "\r\n", "\r"}) {
            INFO(static_cast<int>(tag) << " after a header with line endings of " << end.size() << " bytes");
            const auto loaded = aabblab::read_mesh(folder.write("a.ply", with_line_ends(header, end) + values));
            CHECK(loaded.mesh.vertices == std::vector<aabb::vec3f>{{0, 0, 1}, {1, 1, 1}, {2, 4, 1}});
            CHECK(loaded.mesh.triangles.size() == 1);
        }
        CHECK_NOTHROW(aabblab::read_mesh(folder.write("a.ply", "\xef\xbb\xbf" + header + values)));
    }
}

TEST_CASE("An endless line is rejected") {
    CHECK(run_refused({"classify", "/dev/zero"}).err ==
          "aabblab: /dev/zero:1: the line is longer than 16777216 bytes; expected text of short lines\n");
}

TEST_CASE_METHOD(in_folder, "Randomly corrupted files are read or rejected in a sentence") {
    std::mt19937 draw(1);
    const auto below = [&](std::size_t end) { return draw() % end; };
    for (const text_format& format : formats()) {
        if (format.file == "p.txt" || format.file == "c.txt") continue;  // run in child processes, which takes long
        for (int trial = 0; trial < 1000; ++trial) {
            const auto encodings = unambiguous_encodings(format.text);
            std::string bytes = below(2) == 0 ? format.text : encodings[below(encodings.size())].bytes;
            for (std::size_t change = 0; change <= below(3); ++change) {
                const std::size_t at = below(bytes.size());
                switch (below(4)) {
                    case 0: bytes[at] = static_cast<char>(draw()); break;
                    case 1: bytes.erase(at, 1 + below(4)); break;
                    case 2: bytes.insert(at, 1, "\0\r\n\x1a\xff -9#\\"[below(10)]); break;
                    default: bytes.resize(at); break;
                }
                if (bytes.empty()) break;
            }
            INFO(format.file << ": " << bytes);
            CHECK(error_of(format, folder.write(format.file, bytes)).find('\0') == std::string::npos);
        }
    }
}
