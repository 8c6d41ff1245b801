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

    [[nodiscard]] std::optional<object> member(const char* key) const {
        const auto found = content_.find(key);
        if (found == content_.end()) return {};
        return object(file_, place_.empty() ? key : place_ + "." + key, *found);
    }

    /// Empty where there is none.
    [[nodiscard]] std::vector<object> objects(const char* key) const {
        std::vector<object> all;
        const json* const items = list(key);
        if (!items) return all;
        for (std::size_t i = 0; i < items->size(); ++i)
            all.emplace_back(file_, gltf_place(place_.empty() ? key : place_ + "." + key, i), (*items)[i]);
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
        const auto is_number = [](const json& item) { return item.is_number(); };
        if (items->size() != Count || !std::ranges::all_of(*items, is_number))
            fail_member(key, "a list of " + std::to_string(Count) + " numbers");
        std::array<double, Count> all{};
        for (std::size_t i = 0; i < Count; ++i) all[i] = (*items)[i].get<double>();
        return all;
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

/// What the file cannot be read without, unless it is about looks only.
void require_no_extension(const object& root) {
    for (const std::string& name : root.texts("extensionsRequired")) {
        const auto is_about = [&](std::string_view looks) { return name.find(looks) != std::string::npos; };
        if (!is_about("material") && !is_about("texture") && !is_about("light"))
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

gltf_primitive primitive_of(const object& primitive) {
    gltf_primitive made;
    if (const auto attributes = primitive.member("attributes")) made.positions = attributes->index("POSITION");
    made.indices = primitive.index("indices");
    made.mode = primitive.index("mode").value_or(made.mode);
    return made;
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
    for (const object& accessor : root.objects("accessors"))
        asset.accessors.push_back({accessor.index("bufferView"), accessor.index("byteOffset").value_or(0),
                                   accessor.needed_index("componentType"), accessor.needed_index("count"),
                                   accessor.text("type").value_or(""), accessor.has("sparse")});
    for (const object& mesh : root.objects("meshes")) {
        asset.meshes.emplace_back();
        for (const object& primitive : mesh.objects("primitives"))
            asset.meshes.back().push_back(primitive_of(primitive));
    }
    for (const object& node : root.objects("nodes"))
        asset.nodes.push_back({place_of(node), node.index("mesh"), node.indices("children")});
    asset.roots = roots_of(root);
    return asset;
}

}  // namespace aabblab
