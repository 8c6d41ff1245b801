/// The readers, one a format.
module aabblab.files:readers;

import :file_text;
import :loaded_mesh;

namespace aabblab {

[[nodiscard]] loaded_mesh read_off(const file_text& file);
[[nodiscard]] loaded_mesh read_obj(const file_text& file);
[[nodiscard]] loaded_mesh read_ply(const file_text& file);
[[nodiscard]] loaded_mesh read_stl(const file_text& file);
/// glTF 2.0, as text or binary, with its buffers inside or beside it.
[[nodiscard]] loaded_mesh read_gltf(const file_text& file);

}  // namespace aabblab
