module aabblab.files;

import aabblab.fmt;
import :gltf_asset;
import :scalar;

namespace aabblab {

namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

constexpr std::size_t header_bytes = 12;
constexpr std::size_t chunk_header_bytes = 8;
constexpr std::uint32_t json_chunk = 0x4e4f534a;    // "JSON"
constexpr std::uint32_t binary_chunk = 0x004e4942;  // "BIN"

struct chunk {
    std::uint32_t type = 0;
    std::string_view bytes;
};
/// Removes the first chunk from the rest of a .glb file: its length and type, 4 bytes each, then its bytes.
chunk take_chunk(const file_text& file, std::string_view& rest) {
    const std::string offset = std::to_string(file.text.size() - rest.size());
    if (rest.size() < chunk_header_bytes)
        file.fail("is not a glTF file: it ends in the header of the chunk at byte " + offset);
    const std::size_t length = u32_at(rest, 0);
    const chunk first{u32_at(rest, 4), rest.substr(chunk_header_bytes, length)};
    if (first.bytes.size() != length)
        file.fail(
            fmt::format("is not a glTF file: the chunk at byte {} announces {} bytes, but the file has {} of them",
                        offset, length, first.bytes.size()));
    rest.remove_prefix(chunk_header_bytes + length);
    return first;
}

/// The value of a base64 digit; -1 for any other character.
int digit_of(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// Decodes base64, in which each character holds six bits and '=' pads the end; nullopt if the text is malformed.
std::optional<std::string> decoded_base64(std::string_view text) {
    for (int i = 0; i < 2 && text.ends_with('='); ++i) text.remove_suffix(1);
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int pending = 0;  // how many of the bits are in no byte yet
    for (const char c : text) {
        const int digit = digit_of(c);
        if (digit < 0) return {};
        bits = bits << 6U | static_cast<std::uint32_t>(digit);
        pending += 6;
        if (pending < 8) continue;
        pending -= 8;
        bytes += static_cast<char>(bits >> static_cast<unsigned>(pending) & 0xffU);
    }
    // Up to four bits left are padding. Six would be a whole character that belongs to no byte.
    return pending < 6 ? std::optional(bytes) : std::nullopt;
}

/// Decodes the percent-encoding of a URI, as the name of a file may have blanks. A '%' before other characters stays.
std::string unescaped(std::string_view uri) {
    const auto hex = [](char c) { return std::string_view("0123456789abcdef").find(static_cast<char>(c | 0x20)); };
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool is_escaped = uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) < 16 && hex(uri[i + 2]) < 16;
        text += is_escaped ? static_cast<char>(hex(uri[i + 1]) * 16 + hex(uri[i + 2])) : uri[i];
        i += is_escaped ? 2 : 0;
    }
    return text;
}

/// The bytes that a data: URI holds itself, in base64.
std::string bytes_of_data_uri(std::string_view uri) {
    constexpr std::string_view mark = ";base64,";
    const std::size_t begin = uri.find(mark);
    if (begin == std::string_view::npos) throw aabb::input_error("is a data: URI without ;base64,");
    std::optional<std::string> bytes = decoded_base64(uri.substr(begin + mark.size()));
    if (!bytes) throw aabb::input_error("is a data: URI that is not base64");
    return *std::move(bytes);
}

/// The bytes of a buffer: from the binary chunk of the .glb file, a data: URI or a file in the folder of this one.
/// @param binary the binary chunk, for the only buffer that may refer to it
/// @param loaded total bytes of the previous buffers: the memory limit is for all of them, as many may name one file
std::string bytes_of_buffer(const gltf_buffer& buffer, const file_text& file, std::optional<std::string_view> binary,
                            std::size_t loaded) {
    if (!buffer.uri) {
        if (!binary) throw aabb::input_error("has neither a uri nor the binary chunk of a .glb file");
        return std::string(*binary);
    }
    if (buffer.uri->starts_with("data:")) return bytes_of_data_uri(*buffer.uri);
    if (buffer.uri->find("://") != std::string::npos)
        throw aabb::input_error("is at " + in_quotes(*buffer.uri) + ", but only files and data: URIs are read");
    const std::filesystem::path neighbour = std::filesystem::path(file.name).replace_filename(unescaped(*buffer.uri));
    const std::size_t size = require_file(neighbour);
    require_memory(file.name + ": its buffers", static_cast<double>(loaded) + static_cast<double>(size));
    return read_file(neighbour, size, /*memory_factor=*/1).text;
}

constexpr std::pair<gltf_component, scalar> scalars[] = {
    {gltf_component::i8, scalar::i8},   {gltf_component::u8, scalar::u8},   {gltf_component::i16, scalar::i16},
    {gltf_component::u16, scalar::u16}, {gltf_component::u32, scalar::u32}, {gltf_component::f32, scalar::f32}};

/// Strided elements whose range has been checked.
struct elements {
    const char* first = nullptr;
    std::size_t stride = 0;
    std::size_t count = 0;

    [[nodiscard]] const char* operator[](std::size_t i) const { return first + i * stride; }
};

class number_reader {
public:
    number_reader(const gltf_asset& asset, const file_text& file, std::size_t accessor)
        : asset_(asset),
          file_(file),
          name_(gltf_path("accessors", accessor)),
          accessor_(gltf_element(file, asset.accessors, "accessors", accessor)) {}

    /// Reads the numbers of the accessor: elements of a buffer view, or zeros; a sparse accessor replaces some.
    /// @param no_view_means_zeros whether an accessor without data is all zeros; otherwise it is rejected, as its data
    /// may be where only an extension finds it
    [[nodiscard]] std::vector<double> read(bool no_view_means_zeros) const {
        const gltf_accessor& a = accessor_;
        if (!a.view && !a.sparse && !no_view_means_zeros)
            file_.fail(name_ + " has no bufferView, so its numbers are not in the file");
        const std::size_t width = width_of(a.type);  // numbers per element
        const scalar type = scalar_of(a.component);
        const std::size_t bytes = width * bytes_of(type);
        const elements dense = a.view ? elements_of(*a.view, a.offset, a.count, bytes) : elements{};
        // Without a view, no data bounds the count, so a short file could request any amount of memory.
        require_memory(file_.name + ": " + name_, static_cast<double>(a.count) * static_cast<double>(width) * 8);
        std::vector<double> numbers(a.count * width);
        if (a.view)
            for (std::size_t i = 0; i < a.count; ++i) read_element(dense[i], type, width, &numbers[i * width]);
        if (a.sparse) replace(*a.sparse, type, width, numbers);
        return numbers;
    }

private:
    [[nodiscard]] std::size_t width_of(std::string_view type) const {
        for (const auto& [name, width] : {std::pair("SCALAR", 1), {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}})
            if (type == name) return static_cast<std::size_t>(width);
        file_.fail(name_ + " has the type " + in_quotes(type) + ", which is not read");
    }
    /// The type with the code that the file gives, which may be none of the format.
    [[nodiscard]] scalar scalar_of(gltf_component component) const {
        for (const auto& [code, type] : scalars)
            if (code == component) return type;
        file_.fail(fmt::format("{} has the unknown componentType {}", name_, static_cast<std::size_t>(component)));
    }

    /// The elements at an offset of buffer view `index`. Rejects elements beyond the view, and a view beyond its
    /// buffer.
    /// @param bytes of one element; the view's stride, from one element to the next, may be greater
    [[nodiscard]] elements elements_of(std::size_t index, std::size_t offset, std::size_t count,
                                       std::size_t bytes) const {
        const std::string view_name = gltf_path("bufferViews", index);
        const gltf_view& view = gltf_element(file_, asset_.views, "bufferViews", index);
        const std::string& buffer = gltf_element(file_, asset_.buffers, "buffers", view.buffer).bytes;
        if (view.offset > buffer.size() || view.length > buffer.size() - view.offset)
            file_.fail(view_name + " reaches beyond the end of " + gltf_path("buffers", view.buffer));
        const std::size_t stride = view.stride.value_or(bytes);
        if (stride < bytes)
            file_.fail(view_name + " has a byteStride below the " + std::to_string(bytes) + " bytes of one");
        // The last element begins (count - 1) * stride bytes after the first. The product could overflow.
        if (count > 0 && (offset > view.length || view.length - offset < bytes ||
                          (view.length - offset - bytes) / stride < count - 1))
            file_.fail(name_ + " reaches beyond the end of " + view_name);
        return {count > 0 ? buffer.data() + view.offset + offset : nullptr, stride, count};
    }

    /// @param components receives `width` numbers
    void read_element(const char* bytes, scalar type, std::size_t width, double* components) const {
        for (std::size_t k = 0; k < width; ++k) {
            double& number = components[k];
            number = number_at(bytes + k * bytes_of(type), type);
            if (accessor_.normalized && is_integer(type)) number = std::max(number / greatest(type), -1.0);
        }
    }

    /// Replaces elements by those of a sparse accessor, which lists their indices and values.
    /// @param width numbers per element, each of `type` in the file
    void replace(const gltf_sparse& sparse, scalar type, std::size_t width, std::vector<double>& numbers) const {
        if (sparse.index_component == gltf_component::f32)
            file_.fail(name_ + ".sparse.indices must be of whole numbers, as it has indices");
        const scalar index_type = scalar_of(sparse.index_component);
        const elements indices =
            elements_of(sparse.indices.view, sparse.indices.offset, sparse.count, bytes_of(index_type));
        const elements values =
            elements_of(sparse.values.view, sparse.values.offset, sparse.count, width * bytes_of(type));
        for (std::size_t i = 0; i < sparse.count; ++i) {
            std::uint32_t index = 0;  // both the format and the machine are little-endian
            std::memcpy(&index, indices[i], bytes_of(index_type));
            if (index >= accessor_.count)
                file_.fail(
                    fmt::format("{} replaces element {}, but has {}, counted from 0", name_, index, accessor_.count));
            read_element(values[i], type, width, &numbers[index * width]);
        }
    }

    const gltf_asset& asset_;
    const file_text& file_;
    std::string name_;
    const gltf_accessor& accessor_;
};

}  // namespace

/// Splits a binary file (.glb) into its JSON and its binary chunk; a file without the binary header is all JSON.
gltf_parts gltf_parts_of(const file_text& file) {
    std::string_view rest = file.text;
    if (!rest.starts_with("glTF")) return {.json = rest, .binary = {}, .is_text = true};
    if (rest.size() < header_bytes) file.fail("is not a glTF file: it ends in the header of 12 bytes");
    if (const std::uint32_t version = u32_at(rest, 4); version != 2)
        file.fail("is glTF of version " + std::to_string(version) + "; only version 2 is read");
    if (const std::uint32_t length = u32_at(rest, 8); length != rest.size())
        file.fail(
            fmt::format("is not a glTF file: its header announces {} bytes, but the file has {}", length, rest.size()));
    rest.remove_prefix(header_bytes);
    const chunk first = take_chunk(file, rest);
    if (first.type != json_chunk) file.fail("is not a glTF file: its first chunk is not JSON");
    gltf_parts parts{first.bytes, {}};
    // Chunks of other types belong to extensions and are skipped.
    while (!rest.empty())
        if (const chunk next = take_chunk(file, rest); next.type == binary_chunk && !parts.binary)
            parts.binary = next.bytes;
    return parts;
}

/// Loads the bytes of all buffers. `binary` is the binary chunk of a .glb file.
void load_gltf_buffers(gltf_asset& asset, const file_text& file, std::optional<std::string_view> binary) {
    std::size_t loaded = 0;
    for (std::size_t i = 0; i < asset.buffers.size(); ++i) {
        gltf_buffer& buffer = asset.buffers[i];
        try {
            // Only the first buffer can refer to the binary chunk.
            buffer.bytes = bytes_of_buffer(buffer, file, i == 0 ? binary : std::nullopt, loaded);
            loaded += buffer.bytes.size();
            if (buffer.bytes.size() < buffer.length)
                throw aabb::input_error(
                    fmt::format("announces {} bytes, but has {}", buffer.length, buffer.bytes.size()));
        } catch (const aabb::input_error& error) {
            file.fail(gltf_path("buffers", i) + ": " + error.what());
        }
    }
}

std::vector<double> gltf_numbers(const gltf_asset& asset, const file_text& file, std::size_t accessor,
                                 bool no_view_means_zeros) {
    return number_reader(asset, file, accessor).read(no_view_means_zeros);
}

}  // namespace aabblab
