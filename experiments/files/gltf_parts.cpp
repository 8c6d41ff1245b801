module aabblab.files;

import :file_text;
import :gltf_asset;
import :scalar;

namespace aabblab {

namespace {

static_assert(std::endian::native == std::endian::little, "glTF is little-endian");

constexpr std::size_t header_bytes = 12;
constexpr std::size_t chunk_header_bytes = 8;
constexpr std::uint32_t json_chunk = 0x4e4f534a;    // "JSON"
constexpr std::uint32_t binary_chunk = 0x004e4942;  // "BIN"

/// Takes a chunk off the front: its type and its bytes.
struct chunk {
    std::uint32_t type = 0;
    std::string_view bytes;
};
chunk take_chunk(const file_text& file, std::string_view& rest) {
    const std::string at = std::to_string(file.text.size() - rest.size());
    if (rest.size() < chunk_header_bytes) file.fail("is no glTF file: it ends in the head of the chunk at byte " + at);
    const std::size_t length = u32_at(rest, 0);
    const chunk taken{u32_at(rest, 4), rest.substr(chunk_header_bytes, length)};
    if (taken.bytes.size() != length)
        file.fail("is no glTF file: the chunk at byte " + at + " announces " + std::to_string(length) +
                  " bytes, but the file has " + std::to_string(taken.bytes.size()) + " of them");
    rest.remove_prefix(chunk_header_bytes + length);
    return taken;
}

}  // namespace

gltf_parts gltf_parts_of(const file_text& file) {
    std::string_view rest = file.text;
    if (!rest.starts_with("glTF")) return {rest, {}, true};
    if (rest.size() < header_bytes) file.fail("is no glTF file: it ends in the header of 12 bytes");
    if (const std::uint32_t version = u32_at(rest, 4); version != 2)
        file.fail("is glTF of version " + std::to_string(version) + "; only version 2 is read");
    if (const std::uint32_t length = u32_at(rest, 8); length != rest.size())
        file.fail("is no glTF file: its header announces " + std::to_string(length) + " bytes, but the file has " +
                  std::to_string(rest.size()));
    rest.remove_prefix(header_bytes);
    const chunk first = take_chunk(file, rest);
    if (first.type != json_chunk) file.fail("is no glTF file: its first chunk is not JSON");
    gltf_parts parts{first.bytes, {}};
    // Chunks of other types belong to extensions.
    while (!rest.empty())
        if (const chunk next = take_chunk(file, rest); next.type == binary_chunk && !parts.binary)
            parts.binary = next.bytes;
    return parts;
}

}  // namespace aabblab
