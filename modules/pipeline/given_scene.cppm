module;
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

export module aabb.pipeline:given_scene;

import aabb.base;
import aabb.geometry;
import :scene;

export namespace aabb {

/// Meshes and which one each object is, whose poses come from whoever has them: it plays no frames itself.
class given_scene final : public mesh_scene {
public:
    /// @param objects the mesh of each object, by its place in `all`
    /// @throws input_error on an object of a mesh that is not there.
    given_scene(std::vector<mesh> all, std::vector<std::uint32_t> objects) {
        for (std::size_t object = 0; object < objects.size(); ++object)
            if (objects[object] >= all.size())
                throw input_error("object " + std::to_string(object) + " is mesh " + std::to_string(objects[object]) +
                                  ", but there are " + std::to_string(all.size()) + " meshes");
        meshes = std::move(all);
        mesh_of = std::move(objects);
    }

    [[nodiscard]] std::size_t frames() const override { return 0; }
    bool next(std::vector<pose>& /*poses*/) override { return false; }
};

}  // namespace aabb
