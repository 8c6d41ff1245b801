module;
#include <Eigen/Core>

/// The meshes of a glTF 2.0 file as plain data. Indices and byte ranges are checked by the code that uses them, not by
/// the parser. (Khronos Group, "glTF 2.0 Specification", 2021.)
module aabblab.files:gltf_asset;

import :file_text;

namespace aabblab {

struct gltf_view {
    std::size_t buffer = 0;
    std::size_t offset = 0;
    std::size_t length = 0;
    std::optional<std::size_t> stride;
};

/// Component types by their codes in the format.
enum class gltf_component : std::size_t { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };

/// Elements of an accessor that replace those of its buffer view.
struct gltf_sparse {
    struct part {
        std::size_t view = 0;
        std::size_t offset = 0;
    };
    std::size_t count = 0;
    part indices;
    gltf_component index_component{};
    part values;
};

struct gltf_accessor {
    std::optional<std::size_t> view;
    std::size_t offset = 0;
    gltf_component component{};
    std::size_t count = 0;
    std::string type;  ///< "SCALAR", "VEC3" and so on
    bool normalized = false;
    std::optional<gltf_sparse> sparse;
};

struct gltf_primitive {
    std::optional<std::size_t> positions;
    std::optional<std::size_t> indices;
    std::size_t mode = 4;
    std::vector<std::optional<std::size_t>> targets;  ///< accessor of each morph target's position offsets, if any
    std::vector<std::size_t> joints;                  ///< JOINTS_0, JOINTS_1, …
    std::vector<std::size_t> weights;                 ///< WEIGHTS_0, WEIGHTS_1, …
};

struct gltf_mesh {
    std::vector<gltf_primitive> primitives;
    std::optional<std::vector<double>> weights;  ///< default weights of the morph targets
};

struct gltf_skin {
    std::vector<std::size_t> joints;  ///< indices of nodes
    std::optional<std::size_t> inverse_bind_matrices;
};

/// An affine transform without its last row, which is 0 0 0 1.
using gltf_matrix = Eigen::Matrix<double, 3, 4>;

struct gltf_node {
    gltf_matrix transform;  ///< relative to its parent
    std::optional<std::size_t> mesh;
    std::optional<std::size_t> skin;
    std::optional<std::vector<double>> weights;  ///< override those of its mesh
    std::vector<std::size_t> children;
    std::string extension;  ///< an unsupported one that changes the surface; empty if there is none
};

struct gltf_buffer {
    std::string bytes;
    std::size_t length = 0;  ///< the minimum number of bytes
    std::optional<std::string> uri;
};

struct gltf_asset {
    std::vector<gltf_buffer> buffers;
    std::vector<gltf_view> views;
    std::vector<gltf_accessor> accessors;
    std::vector<gltf_mesh> meshes;
    std::vector<gltf_skin> skins;
    std::vector<gltf_node> nodes;
    std::vector<std::size_t> roots;  ///< root nodes of the scene
    std::size_t animations = 0;
    bool has_quantized_positions = false;  ///< KHR_mesh_quantization: positions may be integers
};

/// The path of a list element in messages: "accessors[3]".
[[nodiscard]] inline std::string gltf_path(std::string_view list, std::size_t index) {
    return std::string(list) + "[" + std::to_string(index) + "]";
}

template <class Element>
[[nodiscard]] inline const Element& gltf_element(const file_text& file, const std::vector<Element>& list,
                                                 std::string_view name, std::size_t index) {
    if (index >= list.size()) file.fail(gltf_path(name, index) + " is used, but does not exist");
    return list[index];
}

/// The components of an accessor in order; normalized ones are mapped to [-1, 1] or [0, 1].
/// @param no_view_means_zeros as the format specifies; but an accessor whose data only an extension has looks the same
[[nodiscard]] std::vector<double> gltf_numbers(const gltf_asset& asset, const file_text& file, std::size_t accessor,
                                               bool no_view_means_zeros);

struct gltf_parts {
    std::string_view json;
    std::optional<std::string_view> binary;
    bool is_text = false;
};
[[nodiscard]] gltf_parts gltf_parts_of(const file_text& file);
[[nodiscard]] gltf_asset parse_gltf(const file_text& file, const gltf_parts& parts);
void load_gltf_buffers(gltf_asset& asset, const file_text& file, std::optional<std::string_view> binary);

}  // namespace aabblab
