module aabblab.scenes:motion;

import aabb.pipeline;
import aabb.std;
import aabblab.files;

namespace aabblab {

/// Meshes of the user with poses from a file; object i is mesh i modulo the number of meshes.
struct motion {
    static constexpr std::string_view name = "motion";
    static constexpr std::string_view summary = "meshes, which must be named, at the poses of a motion file";

    struct config {
        std::string file;
    };
    static constexpr std::tuple parameters{
        aabb::text_parameter{"file", &config::file, "the path of a file", "the poses, frame by frame"}};

    [[nodiscard]] static std::unique_ptr<aabb::mesh_scene> open(const config& c, std::vector<aabb::mesh> meshes) {
        return open_motion(c.file, std::move(meshes));
    }
};

}  // namespace aabblab
