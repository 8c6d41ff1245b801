// What the programs of this folder share: they read a recording or two meshes, and write their pairs. Like programs of
// users, they know nothing of AABB Lab but the formats of its files.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace lists {

struct box {
    std::array<float, 3> min, max;
};

struct mesh {
    std::vector<std::array<double, 3>> vertices;
    std::vector<std::array<int, 3>> triangles;
};

/// All boxes, by frame and object, of an .aabbs file of floats.
inline std::vector<std::vector<box>> read_recording(const std::string& file) {
    std::ifstream in(file, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    std::array<std::int32_t, 3> sizes{};  // objects, last frame, whether in double
    if (bytes.size() < 304) throw std::runtime_error(file + " is no recording");
    std::memcpy(sizes.data(), bytes.data() + 256, sizeof sizes);
    const auto objects = static_cast<std::size_t>(sizes[0]), frames = static_cast<std::size_t>(sizes[1]) + 1;
    if (sizes[2] != 0 || bytes.size() != 304 + 32 * objects * frames)
        throw std::runtime_error(file + " is no recording of floats");
    std::vector<std::vector<box>> boxes(frames, std::vector<box>(objects));
    const char* at = bytes.data() + 304;
    for (std::vector<box>& frame : boxes)
        for (box& b : frame) {
            std::array<float, 8> floats{};  // min x, y, z, 0, max x, y, z, 0
            std::memcpy(floats.data(), at, sizeof floats);
            at += sizeof floats;
            b = {{floats[0], floats[1], floats[2]}, {floats[4], floats[5], floats[6]}};
        }
    return boxes;
}

/// A mesh of triangles, from an .off file without comments.
inline mesh read_off(const std::string& file) {
    std::ifstream in(file);
    std::string word;
    std::size_t vertices = 0, triangles = 0, edges = 0;
    if (!(in >> word >> vertices >> triangles >> edges) || word != "OFF")
        throw std::runtime_error(file + " is no OFF file");
    mesh m;
    m.vertices.resize(vertices);
    m.triangles.resize(triangles);
    for (auto& v : m.vertices) in >> v[0] >> v[1] >> v[2];
    int corners = 0;
    for (auto& t : m.triangles) in >> corners >> t[0] >> t[1] >> t[2];
    if (!in) throw std::runtime_error(file + " ends early");
    return m;
}

/// The pairs of a program, as rows frame,a,b or, of meshes, a,b.
class pair_file {
public:
    explicit pair_file(const std::string& file, const char* header) : out_(file) { out_ << header << '\n'; }

    void add(std::size_t frame, std::size_t a, std::size_t b) { out_ << frame << ',' << a << ',' << b << '\n'; }
    void add(std::int64_t a, std::int64_t b) { out_ << a << ',' << b << '\n'; }
    void close() {
        out_.close();
        if (!out_) throw std::runtime_error("the pairs cannot be written");
    }

private:
    std::ofstream out_;
};

/// A main function. Arguments are --version, or RECORDING PAIRS or A.off B.off PAIRS, and what may follow.
/// @param find_boxes receives the frames of a recording and a pair_file
/// @param find_triangles receives two meshes and a pair_file
template <class FindBoxes, class FindTriangles>
int run(int count, char** values, const std::string& version, FindBoxes find_boxes, FindTriangles find_triangles) try {
    const std::vector<std::string> arguments(values + 1, values + count);
    const bool is_recording = !arguments.empty() && arguments[0].ends_with(".aabbs");
    if (arguments.size() == 1 && arguments[0] == "--version") {
        std::puts(version.c_str());
    } else if (is_recording && arguments.size() >= 2) {
        pair_file out(arguments[1], "frame,a,b");
        find_boxes(read_recording(arguments[0]), out);
        out.close();
    } else if (!is_recording && arguments.size() >= 3) {
        pair_file out(arguments[2], "a,b");
        find_triangles(read_off(arguments[0]), read_off(arguments[1]), out);
        out.close();
    } else {
        throw std::runtime_error("expected RECORDING PAIRS or A.off B.off PAIRS");
    }
    return 0;
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s: %s\n", values[0], error.what());
    return 2;
}

}  // namespace lists
