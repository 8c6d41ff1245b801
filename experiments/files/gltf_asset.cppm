module;
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// What a glTF 2.0 file says about its meshes, as plain numbers: which indices are in range and which bytes are there
/// is checked where they are used. (Khronos Group, "glTF 2.0 Specification", 2021.)
module aabblab.files:gltf_asset;

import :file_text;

namespace aabblab {

struct gltf_view {
    std::size_t buffer = 0;
    std::size_t offset = 0;
    std::size_t length = 0;
    std::optional<std::size_t> stride;
};

/// The numbers that stand for types in the format.
inline constexpr std::size_t gltf_byte = 5121, gltf_short = 5123, gltf_int = 5125, gltf_float = 5126;

struct gltf_accessor {
    std::optional<std::size_t> view;
    std::size_t offset = 0;
    std::size_t component = 0;
    std::size_t count = 0;
    std::string type;  ///< "SCALAR", "VEC3" and so on
    bool sparse = false;
};

struct gltf_primitive {
    std::optional<std::size_t> positions;
    std::optional<std::size_t> indices;
    std::size_t mode = 4;
};

/// Four columns, without the last row, which is 0 0 0 1.
using gltf_matrix = std::array<std::array<double, 3>, 4>;

struct gltf_node {
    gltf_matrix place{};  ///< in its parent
    std::optional<std::size_t> mesh;
    std::vector<std::size_t> children;
};

struct gltf_buffer {
    std::string bytes;
    std::size_t length = 0;  ///< that it must have at least
    std::optional<std::string> uri;
};

struct gltf_asset {
    std::vector<gltf_buffer> buffers;
    std::vector<gltf_view> views;
    std::vector<gltf_accessor> accessors;
    std::vector<std::vector<gltf_primitive>> meshes;
    std::vector<gltf_node> nodes;
    std::vector<std::size_t> roots;  ///< nodes of the scene
};

/// "accessors[3]"
[[nodiscard]] inline std::string gltf_place(std::string_view list, std::size_t index) {
    return std::string(list) + "[" + std::to_string(index) + "]";
}

/// The two parts of a .glb file; a .gltf file is all JSON.
struct gltf_parts {
    std::string_view json;
    std::optional<std::string_view> binary;
    bool is_text = false;
};
/// @throws aabb::input_error where a chunk is cut off, or the version is another.
[[nodiscard]] gltf_parts gltf_parts_of(const file_text& file);

/// Everything but the bytes of the buffers.
/// @throws aabb::input_error on what is no JSON, or where something is missing or of the wrong type.
[[nodiscard]] gltf_asset parse_gltf(const file_text& file, const gltf_parts& parts);

/// Fills the buffers: from the binary part, from data: URIs and from files beside this one.
/// @throws aabb::input_error where one is not there or shorter than announced.
void load_gltf_buffers(gltf_asset& asset, const file_text& file, std::optional<std::string_view> binary);

}  // namespace aabblab
