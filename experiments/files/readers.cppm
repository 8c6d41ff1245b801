/// The readers, one a format.
module aabblab.files:readers;

import aabb.std;
import :file_text;
import :loaded_mesh;

namespace aabblab {

// Files that are text come as `as_text` makes it.
[[nodiscard]] loaded_mesh read_off(const file_text& file);
[[nodiscard]] loaded_mesh read_obj(const file_text& file);
[[nodiscard]] loaded_mesh read_ply(const file_text& file);
[[nodiscard]] loaded_mesh read_stl(const file_text& file);
/// None where the file does not have the size that a binary one of its header has; then it may be text.
[[nodiscard]] std::optional<loaded_mesh> read_binary_stl(const std::filesystem::path& file, std::size_t size);
/// glTF 2.0, as text or binary, with its buffers inside or beside it.
[[nodiscard]] loaded_mesh read_gltf(const file_text& file);

/// Whether the bytes of such a file are text.
[[nodiscard]] bool is_text_ply(std::string_view bytes);
[[nodiscard]] bool is_text_stl(std::string_view bytes);

}  // namespace aabblab
