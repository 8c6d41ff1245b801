module;
#include <Eigen/Geometry>

module aabblab.files;

import aabblab.json;
import :gltf_asset;

namespace aabblab {

namespace {

using object = json_value;

constexpr std::string_view quantization = "KHR_mesh_quantization";

/// Rejects required extensions unless they are supported or affect only the appearance.
void require_no_extension(const object& root) {
    for (const std::string& name : root.texts("extensionsRequired")) {
        const auto is_about = [&](std::string_view topic) { return name.find(topic) != std::string::npos; };
        if (!is_about("material") && !is_about("texture") && !is_about("light") && name != quantization)
            root.fail("requires the extension " + in_quotes(name) + ", which is not supported");
    }
}

/// The transform of a node relative to its parent: its matrix, or else [R S | t] of rotation, scale and translation.
gltf_matrix transform_of(const object& node) {
    gltf_matrix transform;
    if (!node.has("matrix")) {
        const auto rotation = node.numbers<4>("rotation", {0, 0, 0, 1});
        const double squared_length = std::inner_product(rotation.begin(), rotation.end(), rotation.begin(), 0.0);
        // As exporters round, the tolerance is generous.
        if (!(std::abs(squared_length - 1) < 1e-3)) node.fail("has a rotation that is not a quaternion of length 1");
        const auto translation = node.numbers<3>("translation", {});
        const auto scale = node.numbers<3>("scale", {1, 1, 1});
        const Eigen::Matrix3d rotation_matrix = Eigen::Quaterniond(rotation.data()).toRotationMatrix();
        transform << rotation_matrix * Eigen::Vector3d(scale.data()).asDiagonal(), Eigen::Vector3d(translation.data());
        return transform;
    }
    const auto m = node.numbers<16>("matrix", {});  // by columns
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) node.fail("has a matrix whose last row is not 0 0 0 1");
    return Eigen::Map<const Eigen::Matrix4d>(m.data()).topRows<3>();
}

gltf_sparse::part part_of(const object& part) {
    return {part.needed_index("bufferView"), part.index("byteOffset").value_or(0)};
}

/// Parses an accessor: place, type and number of elements in a buffer view; a sparse one lists replaced ones.
gltf_accessor accessor_of(const object& accessor) {
    gltf_accessor parsed{.view = accessor.index("bufferView"),
                         .offset = accessor.index("byteOffset").value_or(0),
                         .component = gltf_component{accessor.needed_index("componentType")},
                         .count = accessor.needed_index("count"),
                         .type = accessor.text("type").value_or(""),
                         .normalized = accessor.flag("normalized").value_or(false),
                         .sparse = {}};
    if (const auto sparse = accessor.member("sparse")) {
        const object indices = sparse->needed("indices");
        parsed.sparse = {sparse->needed_index("count"), part_of(indices),
                         gltf_component{indices.needed_index("componentType")}, part_of(sparse->needed("values"))};
    }
    return parsed;
}

/// The accessors of the attributes NAME_0, NAME_1 and so on.
std::vector<std::size_t> numbered_attributes(const object& attributes, const std::string& name) {
    std::vector<std::size_t> accessors;
    while (const auto next = attributes.index(name + "_" + std::to_string(accessors.size())))
        accessors.push_back(*next);
    return accessors;
}

/// Parses what determines the surface of a primitive: accessors of positions, skinning and corners, and its mode.
gltf_primitive primitive_of(const object& primitive) {
    gltf_primitive parsed;
    if (const auto attributes = primitive.member("attributes")) {
        parsed.positions = attributes->index("POSITION");
        parsed.joints = numbered_attributes(*attributes, "JOINTS");
        parsed.weights = numbered_attributes(*attributes, "WEIGHTS");
    }
    parsed.indices = primitive.index("indices");
    parsed.mode = primitive.index("mode").value_or(parsed.mode);
    for (const object& target : primitive.objects("targets")) parsed.targets.push_back(target.index("POSITION"));
    return parsed;
}

gltf_mesh mesh_of(const object& mesh) {
    gltf_mesh parsed{{}, mesh.numbers("weights")};
    for (const object& primitive : mesh.objects("primitives")) parsed.primitives.push_back(primitive_of(primitive));
    return parsed;
}

/// The first unsupported extension that moves, repeats or hides the node's mesh; empty if there is none.
std::string surface_extension_of(const object& node) {
    if (const auto extensions = node.member("extensions"))
        for (const char* const name : {"EXT_mesh_gpu_instancing", "KHR_node_visibility"})
            if (extensions->has(name)) return name;
    return {};
}

gltf_node node_of(const object& node) {
    return {transform_of(node),      node.index("mesh"),       node.index("skin"),
            node.numbers("weights"), node.indices("children"), surface_extension_of(node)};
}

/// The root nodes of the scene that the file says to show; the first scene if it says nothing.
std::vector<std::size_t> roots_of(const object& root) {
    const std::vector<object> scenes = root.objects("scenes");
    if (scenes.empty()) root.fail("has no scene");
    const std::size_t shown = root.index("scene").value_or(0);
    if (shown >= scenes.size())
        root.fail("shows scene " + std::to_string(shown) + ", but it has " + std::to_string(scenes.size()));
    return scenes[shown].indices("nodes");
}

}  // namespace

/// Parses the JSON part of glTF 2.0 into plain data. Indices are checked later, where they are used.
gltf_asset parse_gltf(const file_text& file, const gltf_parts& parts) {
    const object root(file.name, parts.json, "is not a glTF file",
                      parts.is_text ? object::position::line : object::position::byte);
    const std::optional<object> metadata = root.member("asset");
    const std::string version = metadata ? metadata->text("version").value_or("") : "";
    if (!version.starts_with("2.")) file.fail("is glTF of version " + in_quotes(version) + "; only version 2 is read");
    require_no_extension(root);
    gltf_asset asset;
    for (const object& buffer : root.objects("buffers"))
        asset.buffers.push_back({{}, buffer.needed_index("byteLength"), buffer.text("uri")});
    for (const object& view : root.objects("bufferViews"))
        asset.views.push_back({view.needed_index("buffer"), view.index("byteOffset").value_or(0),
                               view.needed_index("byteLength"), view.index("byteStride")});
    for (const object& accessor : root.objects("accessors")) asset.accessors.push_back(accessor_of(accessor));
    for (const object& mesh : root.objects("meshes")) asset.meshes.push_back(mesh_of(mesh));
    for (const object& skin : root.objects("skins"))
        asset.skins.push_back({skin.indices("joints"), skin.index("inverseBindMatrices")});
    for (const object& node : root.objects("nodes")) asset.nodes.push_back(node_of(node));
    asset.animations = root.objects("animations").size();
    const std::vector<std::string> extensions = root.texts("extensionsUsed");
    asset.has_quantized_positions = std::ranges::find(extensions, quantization) != extensions.end();
    asset.roots = roots_of(root);
    return asset;
}

}  // namespace aabblab
