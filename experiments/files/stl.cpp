module;
#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <unordered_map>

module aabblab.files;

import aabb.base;
import aabb.geometry;
import :file_text;
import :mesh_builder;
import :readers;
import :text_scanner;

namespace aabblab {

namespace {

/// STL repeats a vertex for every triangle around it: vertices of the same bits become one, numbered in the order of
/// their first appearance. Triangles keep the order of the file.
class vertex_merger {
public:
    explicit vertex_merger(mesh_builder& mesh) : mesh_(mesh) {}

    [[nodiscard]] std::uint32_t index_of(const aabb::vec3f& p) {
        const auto bits = std::bit_cast<std::array<std::uint32_t, 3>>(p);
        const auto [found, is_new] = numbers_.try_emplace(bits, static_cast<std::uint32_t>(mesh_.vertices()));
        if (is_new) mesh_.add_vertex(p);
        return found->second;
    }

private:
    struct mixed {
        std::size_t operator()(const std::array<std::uint32_t, 3>& bits) const noexcept {
            std::uint64_t hash = 0;
            for (const std::uint32_t b : bits) {
                hash = (hash ^ b) * 0x9e3779b97f4a7c15U;
                hash ^= hash >> 32;
            }
            return hash;
        }
    };
    mesh_builder& mesh_;
    std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, mixed> numbers_;
};

constexpr std::size_t header_bytes = 84;
constexpr std::size_t triangle_bytes = 50;

std::uint32_t announced_triangles(std::string_view bytes) {
    std::uint32_t count = 0;
    std::memcpy(&count, bytes.data() + 80, sizeof count);
    return count;
}

loaded_mesh read_binary(const file_text& file) {
    mesh_builder mesh(file.name);
    vertex_merger merger(mesh);
    const std::uint32_t count = announced_triangles(file.text);
    for (std::uint32_t t = 0; t < count; ++t) {
        // A normal, three vertices, two bytes of attributes.
        std::array<aabb::vec3f, 3> points{};
        std::memcpy(points.data(), file.text.data() + header_bytes + triangle_bytes * t + 12, sizeof points);
        std::array<std::uint32_t, 3> corners{};
        for (std::size_t i = 0; i < 3; ++i) {
            if (!aabb::is_finite(points[i]))
                throw aabb::input_error(file.name + ": triangle " + std::to_string(t) +
                                        " has a coordinate that is not finite");
            corners[i] = merger.index_of(points[i]);
        }
        mesh.add_face(corners, t);
    }
    return mesh.finish(0, file.name + ": triangle ", 0);
}

/// Writers disagree about the case of keywords.
bool is_keyword(std::string_view word, std::string_view keyword) {
    return std::ranges::equal(word, keyword, [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a + 32 : a) == b; });
}

loaded_mesh read_text(const file_text& file) {
    text_scanner in(file, '\0');
    mesh_builder mesh(file.name);
    vertex_merger merger(mesh);
    std::array<std::uint32_t, 3> corners{};
    std::size_t count = 0;
    bool in_solid = false;
    bool in_facet = false;
    while (in.next_line()) {
        const std::string_view word = in.word();
        if (is_keyword(word, "vertex") && in_facet) {
            const aabb::vec3f p = in.point();
            if (count == 3) in.fail("a facet has more than three vertices");
            corners[count++] = merger.index_of(p);
        } else if (is_keyword(word, "facet") && in_solid && !in_facet) {
            in_facet = true;
            count = 0;
        } else if (is_keyword(word, "endfacet") && in_facet) {
            if (count < 3) in.fail("a facet has " + std::to_string(count) + " vertices, not three");
            mesh.add_face(corners, in.line());
            in_facet = false;
        } else if (is_keyword(word, "solid") && !in_solid) {
            in_solid = true;
        } else if (is_keyword(word, "endsolid") && in_solid && !in_facet) {
            in_solid = false;
        } else if (!(is_keyword(word, "outer") || is_keyword(word, "endloop")) || !in_facet) {
            in.expected(in_facet ? "a vertex or endfacet" : in_solid ? "facet or endsolid" : "solid", word);
        }
    }
    if (in_solid) in.ends(in_facet ? "inside a facet" : "without endsolid");
    return mesh.finish(in.rounded(), file.name + ":", 0);
}

}  // namespace

// Binary files may begin with "solid" too, so the size decides first, then whether there is anything but text: one that
// is cut off has no size to go by.
loaded_mesh read_stl(const file_text& file) {
    const std::size_t size = file.text.size();
    const bool has_count = size >= header_bytes;
    if (has_count && size == header_bytes + triangle_bytes * announced_triangles(file.text)) return read_binary(file);
    const auto is_text = [](unsigned char c) { return c >= ' ' || (c >= '\t' && c <= '\r'); };
    if (is_keyword(std::string_view(file.text).substr(0, 5), "solid") && std::ranges::all_of(file.text, is_text))
        return read_text(file);
    if (!has_count)
        throw aabb::input_error(file.name +
                                ": is no STL file: it is neither text that begins with solid nor holds the 84 bytes of "
                                "a binary header");
    const std::uint64_t count = announced_triangles(file.text);
    throw aabb::input_error(file.name + ": its header announces " + std::to_string(count) + " triangles, which take " +
                            std::to_string(header_bytes + triangle_bytes * count) + " bytes, but the file has " +
                            std::to_string(size));
}

}  // namespace aabblab
