module;
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

module aabblab.files;

import aabb.base;
import :file_text;
import :gltf_asset;

namespace aabblab {

namespace {

using nlohmann::json;

/// An object in the file with the way to it, as in "accessors[3]", and its members by type.
class object {
public:
    object(const file_text& file, std::string place, const json& content)
        : file_(file), place_(std::move(place)), content_(content) {
        if (!content.is_object()) fail("must be an object");
    }

    [[noreturn]] void fail(const std::string& sentence) const {
        throw aabb::input_error(file_.name + ": " + (place_.empty() ? "the file" : place_) + " " + sentence);
    }

    [[nodiscard]] std::optional<std::size_t> index(const char* key) const {
        const auto found = content_.find(key);
        if (found == content_.end()) return {};
        if (!found->is_number_unsigned()) fail_member(key, "a whole number");
        return found->get<std::size_t>();
    }
    [[nodiscard]] std::size_t needed_index(const char* key) const {
        const std::optional<std::size_t> found = index(key);
        if (!found) throw aabb::input_error(file_.name + ": " + named(key) + " is missing");
        return *found;
    }

    [[nodiscard]] std::optional<std::string> text(const char* key) const {
        const auto found = content_.find(key);
        if (found == content_.end()) return {};
        if (!found->is_string()) fail_member(key, "a string");
        return found->get<std::string>();
    }

    [[nodiscard]] bool has(const char* key) const { return content_.contains(key); }
    /// False where there is none.
    [[nodiscard]] bool flag(const char* key) const {
        const auto found = content_.find(key);
        if (found == content_.end()) return false;
        if (!found->is_boolean()) fail_member(key, "true or false");
        return found->get<bool>();
    }

    [[nodiscard]] std::optional<object> member(const char* key) const {
        const auto found = content_.find(key);
        if (found == content_.end()) return {};
        return object(file_, named(key), *found);
    }
    [[nodiscard]] object needed_member(const char* key) const {
        const std::optional<object> found = member(key);
        if (!found) throw aabb::input_error(file_.name + ": " + named(key) + " is missing");
        return *found;
    }

    /// Empty where there is none.
    [[nodiscard]] std::vector<object> objects(const char* key) const {
        std::vector<object> all;
        const json* const items = list(key);
        if (!items) return all;
        for (std::size_t i = 0; i < items->size(); ++i) all.emplace_back(file_, gltf_place(named(key), i), (*items)[i]);
        return all;
    }
    [[nodiscard]] std::vector<std::size_t> indices(const char* key) const {
        std::vector<std::size_t> all;
        const json* const items = list(key);
        if (!items) return all;
        for (const json& item : *items) {
            if (!item.is_number_unsigned()) fail_member(key, "a list of whole numbers");
            all.push_back(item.get<std::size_t>());
        }
        return all;
    }
    [[nodiscard]] std::vector<std::string> texts(const char* key) const {
        std::vector<std::string> all;
        const json* const items = list(key);
        if (!items) return all;
        for (const json& item : *items) {
            if (!item.is_string()) fail_member(key, "a list of texts");
            all.push_back(item.get<std::string>());
        }
        return all;
    }
    template <std::size_t Count>
    [[nodiscard]] std::array<double, Count> numbers(const char* key, std::array<double, Count> fallback) const {
        const json* const items = list(key);
        if (!items) return fallback;
        if (items->size() != Count || !std::ranges::all_of(*items, &json::is_number))
            fail_member(key, "a list of " + std::to_string(Count) + " numbers");
        std::array<double, Count> all{};
        for (std::size_t i = 0; i < Count; ++i) all[i] = (*items)[i].get<double>();
        return all;
    }
    [[nodiscard]] std::optional<std::vector<double>> numbers(const char* key) const {
        const json* const items = list(key);
        if (!items) return {};
        if (!std::ranges::all_of(*items, &json::is_number)) fail_member(key, "a list of numbers");
        return items->get<std::vector<double>>();
    }

private:
    [[noreturn]] void fail_member(const char* key, const std::string& expected) const {
        throw aabb::input_error(file_.name + ": " + named(key) + " must be " + expected);
    }
    [[nodiscard]] std::string named(const char* key) const { return (place_.empty() ? "" : place_ + ".") + key; }
    [[nodiscard]] const json* list(const char* key) const {
        const auto found = content_.find(key);
        if (found == content_.end()) return nullptr;
        if (!found->is_array()) fail_member(key, "a list");
        return &*found;
    }

    const file_text& file_;
    std::string place_;
    const json& content_;
};

json parsed(const file_text& file, const gltf_parts& parts) {
    try {
        return json::parse(parts.json);
    } catch (const json::parse_error& error) {
        const std::size_t read = std::min(error.byte, parts.json.size());
        if (!parts.is_text)
            throw aabb::input_error(file.name + ": is no glTF file: its JSON is malformed at byte " +
                                    std::to_string(read));
        const auto line = 1 + std::ranges::count(parts.json.substr(0, read), '\n');
        throw aabb::input_error(file.name + ":" + std::to_string(line) + ": is no glTF file: its JSON is malformed");
    } catch (const json::out_of_range&) {
        throw aabb::input_error(file.name + ": is no glTF file: a number in it does not fit a double");
    }
}

constexpr std::string_view quantization = "KHR_mesh_quantization";

/// What the file cannot be read without, unless it is about looks only.
void require_no_extension(const object& root) {
    for (const std::string& name : root.texts("extensionsRequired")) {
        const auto is_about = [&](std::string_view looks) { return name.find(looks) != std::string::npos; };
        if (!is_about("material") && !is_about("texture") && !is_about("light") && name != quantization)
            root.fail("requires the extension " + in_quotes(name) + ", which is not supported");
    }
}

/// @param rotation a quaternion of length 1, x y z w
gltf_matrix placed(const std::array<double, 3>& translation, const std::array<double, 4>& rotation,
                   const std::array<double, 3>& scale) {
    const auto [x, y, z, w] = rotation;
    gltf_matrix place = {{{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
                          {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                          {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)},
                          translation}};
    for (std::size_t column = 0; column < 3; ++column)
        for (double& entry : place[column]) entry *= scale[column];
    return place;
}

gltf_matrix place_of(const object& node) {
    if (!node.has("matrix")) {
        const auto rotation = node.numbers<4>("rotation", {0, 0, 0, 1});
        const double square = std::inner_product(rotation.begin(), rotation.end(), rotation.begin(), 0.0);
        if (!(std::abs(square - 1) < 1e-3)) node.fail("has a rotation that is not a quaternion of length 1");
        return placed(node.numbers<3>("translation", {}), rotation, node.numbers<3>("scale", {1, 1, 1}));
    }
    const auto m = node.numbers<16>("matrix", {});
    if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) node.fail("has a matrix whose last row is not 0 0 0 1");
    gltf_matrix place{};
    for (std::size_t column = 0; column < 4; ++column)
        place[column] = {m[4 * column], m[4 * column + 1], m[4 * column + 2]};
    return place;
}

gltf_sparse::part part_of(const object& part) {
    return {part.needed_index("bufferView"), part.index("byteOffset").value_or(0)};
}

gltf_accessor accessor_of(const object& accessor) {
    gltf_accessor read{.view = accessor.index("bufferView"),
                       .offset = accessor.index("byteOffset").value_or(0),
                       .component = gltf_component{accessor.needed_index("componentType")},
                       .count = accessor.needed_index("count"),
                       .type = accessor.text("type").value_or(""),
                       .normalized = accessor.flag("normalized"),
                       .sparse = {}};
    if (const auto sparse = accessor.member("sparse")) {
        const object indices = sparse->needed_member("indices");
        read.sparse = {sparse->needed_index("count"), part_of(indices),
                       gltf_component{indices.needed_index("componentType")}, part_of(sparse->needed_member("values"))};
    }
    return read;
}

/// NAME_0, NAME_1 and so on.
std::vector<std::size_t> numbered_attributes(const object& attributes, const std::string& name) {
    std::vector<std::size_t> accessors;
    while (const auto next = attributes.index((name + "_" + std::to_string(accessors.size())).c_str()))
        accessors.push_back(*next);
    return accessors;
}

gltf_primitive primitive_of(const object& primitive) {
    gltf_primitive read;
    if (const auto attributes = primitive.member("attributes")) {
        read.positions = attributes->index("POSITION");
        read.joints = numbered_attributes(*attributes, "JOINTS");
        read.weights = numbered_attributes(*attributes, "WEIGHTS");
    }
    read.indices = primitive.index("indices");
    read.mode = primitive.index("mode").value_or(read.mode);
    for (const object& target : primitive.objects("targets")) read.targets.push_back(target.index("POSITION"));
    return read;
}

gltf_mesh mesh_of(const object& mesh) {
    gltf_mesh read{{}, mesh.numbers("weights")};
    for (const object& primitive : mesh.objects("primitives")) read.primitives.push_back(primitive_of(primitive));
    return read;
}

/// An extension that says where the mesh of a node stands, or whether it is there.
std::string surface_extension_of(const object& node) {
    if (const auto extensions = node.member("extensions"))
        for (const char* const name : {"EXT_mesh_gpu_instancing", "KHR_node_visibility"})
            if (extensions->has(name)) return name;
    return {};
}

gltf_node node_of(const object& node) {
    return {place_of(node),          node.index("mesh"),       node.index("skin"),
            node.numbers("weights"), node.indices("children"), surface_extension_of(node)};
}

std::vector<std::size_t> roots_of(const object& root) {
    const std::vector<object> scenes = root.objects("scenes");
    if (scenes.empty()) root.fail("has no scene");
    const std::size_t shown = root.index("scene").value_or(0);
    if (shown >= scenes.size())
        root.fail("shows scene " + std::to_string(shown) + ", but it has " + std::to_string(scenes.size()));
    return scenes[shown].indices("nodes");
}

}  // namespace

gltf_asset parse_gltf(const file_text& file, const gltf_parts& parts) {
    const json content = parsed(file, parts);
    const object root(file, "", content);
    const std::optional<object> about = root.member("asset");
    const std::string version = about ? about->text("version").value_or("") : "";
    if (!version.starts_with("2."))
        throw aabb::input_error(file.name + ": is glTF of version " + in_quotes(version) + "; only version 2 is read");
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
