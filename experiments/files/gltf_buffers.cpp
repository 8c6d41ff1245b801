module aabblab.files;

import aabb.base;
import :file_text;
import :gltf_asset;

namespace aabblab {

namespace {

/// The number of a letter in base64; -1 for what is none.
int digit_of(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// None where it is not base64.
std::optional<std::string> decoded(std::string_view text) {
    for (int i = 0; i < 2 && text.ends_with('='); ++i) text.remove_suffix(1);
    std::string bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int digit = digit_of(c);
        if (digit < 0) return {};
        bits = bits << 6U | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count < 8) continue;
        count -= 8;
        bytes += static_cast<char>(bits >> static_cast<unsigned>(count) & 0xffU);
    }
    return count < 6 ? std::optional(bytes) : std::nullopt;
}

/// A URI writes some letters as % and two digits.
std::string unescaped(std::string_view uri) {
    const auto hex = [](char c) { return std::string_view("0123456789abcdef").find(static_cast<char>(c | 0x20)); };
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool escaped = uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) < 16 && hex(uri[i + 2]) < 16;
        text += escaped ? static_cast<char>(hex(uri[i + 1]) * 16 + hex(uri[i + 2])) : uri[i];
        i += escaped ? 2 : 0;
    }
    return text;
}

std::string bytes_of_data(std::string_view uri) {
    constexpr std::string_view mark = ";base64,";
    const std::size_t at = uri.find(mark);
    if (at == std::string_view::npos) throw aabb::input_error("is a data: URI without ;base64,");
    std::optional<std::string> bytes = decoded(uri.substr(at + mark.size()));
    if (!bytes) throw aabb::input_error("is a data: URI that is not base64");
    return *std::move(bytes);
}

/// @param loaded bytes of the buffers before it: many may name one file
std::string bytes_of(const gltf_buffer& buffer, const file_text& file, std::optional<std::string_view> binary,
                     std::size_t loaded) {
    if (!buffer.uri) {
        if (!binary) throw aabb::input_error("has neither a uri nor the binary chunk of a .glb file");
        return std::string(*binary);
    }
    if (buffer.uri->starts_with("data:")) return bytes_of_data(*buffer.uri);
    if (buffer.uri->find("://") != std::string::npos)
        throw aabb::input_error("is at " + in_quotes(*buffer.uri) + ", but only files and data: URIs are read");
    const std::filesystem::path beside = std::filesystem::path(file.name).replace_filename(unescaped(*buffer.uri));
    const std::size_t size = require_file(beside);
    require_memory(file.name + ": its buffers", static_cast<double>(loaded) + static_cast<double>(size));
    return read_whole(beside, size, 1).text;
}

}  // namespace

void load_gltf_buffers(gltf_asset& asset, const file_text& file, std::optional<std::string_view> binary) {
    std::size_t loaded = 0;
    for (std::size_t i = 0; i < asset.buffers.size(); ++i) {
        gltf_buffer& buffer = asset.buffers[i];
        try {
            // The binary chunk is the first buffer and no other.
            buffer.bytes = bytes_of(buffer, file, i == 0 ? binary : std::nullopt, loaded);
            loaded += buffer.bytes.size();
            if (buffer.bytes.size() < buffer.length)
                throw aabb::input_error("announces " + std::to_string(buffer.length) + " bytes, but has " +
                                        std::to_string(buffer.bytes.size()));
        } catch (const aabb::input_error& error) {
            file.fail(gltf_place("buffers", i) + ": " + error.what());
        }
    }
}

}  // namespace aabblab
