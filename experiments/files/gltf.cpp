module;
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

module aabblab.files;

import aabb.base;
import aabb.geometry;
import :file_text;
import :gltf_asset;
import :mesh_builder;
import :readers;

namespace aabblab {

namespace {

/// How the corners of a primitive make faces, by the number of its mode.
enum class gltf_mode : std::uint8_t { points, lines, line_loop, line_strip, triangles, triangle_strip, triangle_fan };

gltf_matrix product(const gltf_matrix& parent, const gltf_matrix& child) {
    gltf_matrix all{};
    for (std::size_t column = 0; column < 4; ++column)
        for (std::size_t row = 0; row < 3; ++row) {
            for (std::size_t k = 0; k < 3; ++k) all[column][row] += parent[k][row] * child[column][k];
            if (column == 3) all[column][row] += parent[3][row];
        }
    return all;
}

aabb::vec3f moved(const gltf_matrix& m, const aabb::vec3f& p) {
    aabb::vec3f result{};
    for (int row = 0; row < 3; ++row) {
        const auto r = static_cast<std::size_t>(row);
        result[row] = static_cast<float>(m[0][r] * p[0] + m[1][r] * p[1] + m[2][r] * p[2] + m[3][r]);
    }
    return result;
}

class gltf_reader {
public:
    gltf_reader(const file_text& file, gltf_asset asset) : file_(file), asset_(std::move(asset)), mesh_(file.name) {}

    [[nodiscard]] loaded_mesh read() {
        struct placed_node {
            std::size_t node;
            gltf_matrix parent;
        };
        std::vector<placed_node> waiting;
        const auto add = [&](const std::vector<std::size_t>& nodes, const gltf_matrix& parent) {
            for (std::size_t i = nodes.size(); i-- > 0;) waiting.push_back({nodes[i], parent});
        };
        std::vector<std::uint8_t> seen(asset_.nodes.size(), 0);
        add(asset_.roots, {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {}}});
        // In the order of the file, a node before its children.
        while (!waiting.empty()) {
            const placed_node at = waiting.back();
            waiting.pop_back();
            if (at.node >= asset_.nodes.size()) fail_missing("nodes", at.node);
            if (std::exchange(seen[at.node], 1) != 0)
                fail(gltf_place("nodes", at.node) + " stands in more than one place of the scene");
            const gltf_node& node = asset_.nodes[at.node];
            const gltf_matrix place = product(at.parent, node.place);
            if (node.mesh) add_mesh(*node.mesh, place);
            add(node.children, place);
        }
        return mesh_.finish(0, file_.name + ": face ", 0);
    }

private:
    [[noreturn]] void fail(const std::string& sentence) const { throw aabb::input_error(file_.name + ": " + sentence); }
    [[noreturn]] void fail_missing(std::string_view list, std::size_t index) const {
        fail(gltf_place(list, index) + " is used, but is not there");
    }

    /// An accessor whose elements are known to lie in a buffer.
    struct elements {
        const char* first;
        std::size_t stride;
        std::size_t count;
    };
    [[nodiscard]] elements elements_of(std::size_t index, const gltf_accessor& accessor, std::size_t bytes) const {
        const std::string name = gltf_place("accessors", index);
        if (accessor.sparse) fail(name + " is sparse, which is not supported");
        if (!accessor.view) fail(name + " has no bufferView, so its numbers are not in the file");
        if (*accessor.view >= asset_.views.size()) fail_missing("bufferViews", *accessor.view);
        const gltf_view& view = asset_.views[*accessor.view];
        const std::string view_name = gltf_place("bufferViews", *accessor.view);
        if (view.buffer >= asset_.buffers.size()) fail_missing("buffers", view.buffer);
        const std::string& held = asset_.buffers[view.buffer].bytes;
        if (view.offset > held.size() || view.length > held.size() - view.offset)
            fail(view_name + " reaches beyond the end of " + gltf_place("buffers", view.buffer));
        const std::size_t stride = view.stride.value_or(bytes);
        if (stride < bytes) fail(view_name + " has a byteStride below the " + std::to_string(bytes) + " bytes of one");
        if (accessor.count > 0 && (accessor.offset > view.length || view.length - accessor.offset < bytes ||
                                   (view.length - accessor.offset - bytes) / stride < accessor.count - 1))
            fail(name + " reaches beyond the end of " + view_name);
        return {accessor.count > 0 ? held.data() + view.offset + accessor.offset : nullptr, stride, accessor.count};
    }
    [[nodiscard]] const gltf_accessor& accessor(std::size_t index) const {
        if (index >= asset_.accessors.size()) fail_missing("accessors", index);
        return asset_.accessors[index];
    }

    /// @returns how many there were
    std::size_t add_vertices(std::size_t index, const gltf_matrix& place) {
        const gltf_accessor& positions = accessor(index);
        if (positions.type != "VEC3" || positions.component != gltf_float)
            fail(gltf_place("accessors", index) + " must be of floats and VEC3, as it has positions");
        const elements all = elements_of(index, positions, 3 * sizeof(float));
        if (all.count > std::numeric_limits<std::uint32_t>::max() - mesh_.vertices())
            fail("its scene has more than 2^32 - 1 vertices");
        // One mesh may stand in many places.
        require_memory(file_.name + ": its scene",
                       static_cast<double>(mesh_.vertices() + all.count) * sizeof(aabb::vec3f) +
                           static_cast<double>(faces_) * sizeof(std::array<std::uint32_t, 3>));
        for (std::size_t v = 0; v < all.count; ++v) {
            aabb::vec3f p{};
            std::memcpy(&p, all.first + v * all.stride, sizeof p);
            p = moved(place, p);
            if (!aabb::is_finite(p))
                fail("vertex " + std::to_string(mesh_.vertices()) + " has a coordinate that is not finite");
            mesh_.add_vertex(p);
        }
        return all.count;
    }

    template <class Index>
    [[nodiscard]] std::vector<std::uint32_t> read_indices(std::size_t index) const {
        const elements all = elements_of(index, accessor(index), sizeof(Index));
        std::vector<std::uint32_t> indices(all.count);
        for (std::size_t i = 0; i < all.count; ++i) {
            Index read{};
            std::memcpy(&read, all.first + i * all.stride, sizeof read);
            indices[i] = read;
        }
        return indices;
    }
    [[nodiscard]] std::vector<std::uint32_t> indices_of(std::size_t index) const {
        const gltf_accessor& all = accessor(index);
        if (all.type == "SCALAR" && all.component == gltf_byte) return read_indices<std::uint8_t>(index);
        if (all.type == "SCALAR" && all.component == gltf_short) return read_indices<std::uint16_t>(index);
        if (all.type == "SCALAR" && all.component == gltf_int) return read_indices<std::uint32_t>(index);
        fail(gltf_place("accessors", index) + " must be of whole numbers and SCALAR, as it has indices");
    }

    void add_mesh(std::size_t index, const gltf_matrix& place) {
        if (index >= asset_.meshes.size()) fail_missing("meshes", index);
        for (const gltf_primitive& primitive : asset_.meshes[index]) {
            if (!primitive.positions) fail(gltf_place("meshes", index) + " has a primitive without positions");
            if (primitive.mode > static_cast<std::size_t>(gltf_mode::triangle_fan))
                fail(gltf_place("meshes", index) + " has a primitive of mode " + std::to_string(primitive.mode) +
                     "; modes are 0 to 6");
            const std::size_t first = mesh_.vertices();
            const std::size_t count = add_vertices(*primitive.positions, place);
            std::vector<std::uint32_t> corners;
            if (primitive.indices) {
                corners = indices_of(*primitive.indices);
            } else {
                corners.resize(count);
                for (std::size_t v = 0; v < count; ++v) corners[v] = static_cast<std::uint32_t>(v);
            }
            for (std::uint32_t& corner : corners) {
                if (corner >= count)
                    fail(gltf_place("meshes", index) + " has a face that uses vertex " + std::to_string(corner) +
                         ", but there are " + std::to_string(count) + " vertices, counted from 0");
                corner += static_cast<std::uint32_t>(first);
            }
            add_faces(static_cast<gltf_mode>(primitive.mode), corners);
        }
    }

    void add_faces(gltf_mode mode, const std::vector<std::uint32_t>& corners) {
        const std::size_t count = corners.size();
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
            mesh_.add_face({{corners[a], corners[b], corners[c]}}, faces_++);
        };
        const auto drop = [&](std::size_t faces) {
            for (std::size_t i = 0; i < faces; ++i) mesh_.drop();
        };
        switch (mode) {
            case gltf_mode::points: drop(count); break;
            case gltf_mode::lines: drop(count / 2); break;
            case gltf_mode::line_loop: drop(count); break;
            case gltf_mode::line_strip: drop(count > 0 ? count - 1 : 0); break;
            case gltf_mode::triangles:
                for (std::size_t i = 2; i < count; i += 3) add(i - 2, i - 1, i);
                break;
            case gltf_mode::triangle_strip:  // every other one is turned, so that all face one way
                for (std::size_t i = 2; i < count; ++i) add(i - 2, i - (i + 1) % 2, i - i % 2);
                break;
            case gltf_mode::triangle_fan:
                for (std::size_t i = 2; i < count; ++i) add(0, i - 1, i);
                break;
        }
    }

    const file_text& file_;
    gltf_asset asset_;
    mesh_builder mesh_;
    std::size_t faces_ = 0;
};

}  // namespace

loaded_mesh read_gltf(const file_text& file) {
    const gltf_parts parts = gltf_parts_of(file);
    gltf_asset asset = parse_gltf(file, parts);
    load_gltf_buffers(asset, file, parts.binary);
    return gltf_reader(file, std::move(asset)).read();
}

}  // namespace aabblab
