/// The readers, one a format.
module aabblab.files:readers;

import :file_text;
import :loaded_mesh;

namespace aabblab {

[[nodiscard]] loaded_mesh read_off(const file_text& file);
[[nodiscard]] loaded_mesh read_obj(const file_text& file);
[[nodiscard]] loaded_mesh read_ply(const file_text& file);
[[nodiscard]] loaded_mesh read_stl(const file_text& file);
/// Reads through assimp, which opens the file (and those it refers to) itself.
[[nodiscard]] loaded_mesh read_gltf(const file_text& file);

}  // namespace aabblab
