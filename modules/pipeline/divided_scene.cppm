module;
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

export module aabb.pipeline:divided_scene;

import aabb.geometry;
import :scene;
import :stage;

export namespace aabb {

/// What both stages see of a scene whose meshes are divided. Global search sees pieces: parts of objects, and objects
/// that are whole, numbered in the order of the objects. Local detection sees models: meshes, of parts and whole ones.
///
/// A part is a mesh with its own, tighter box, which stands where its object does. So what is shown of meshes holds for
/// parts (`relative_pose`, `world_bounds`): the image of a vertex is the same, and triangles that meet are found.
class divided_scene {
public:
    /// @param scene must outlive this; its meshes are valid
    divided_scene(const mesh_scene& scene, mesh_division division);
    divided_scene(divided_scene&&) = default;  // models keep their places
    divided_scene(const divided_scene&) = delete;
    divided_scene& operator=(divided_scene&&) = delete;
    divided_scene& operator=(const divided_scene&) = delete;

    [[nodiscard]] std::uint32_t pieces() const noexcept { return static_cast<std::uint32_t>(pieces_.size()); }
    [[nodiscard]] std::uint32_t object_of(std::uint32_t piece) const noexcept { return pieces_[piece].object; }
    [[nodiscard]] std::uint32_t model_of(std::uint32_t piece) const noexcept { return pieces_[piece].model; }
    /// From the first one to behind the last one.
    [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> pieces_of(std::uint32_t object) const noexcept;

    [[nodiscard]] std::uint32_t models() const noexcept { return static_cast<std::uint32_t>(models_.size()); }
    /// Stays where it is as long as this does.
    [[nodiscard]] const mesh& mesh_of(std::uint32_t model) const noexcept;
    [[nodiscard]] bool deforms(std::uint32_t model) const { return scene_.deforms(models_[model].source); }
    /// In the mesh of the scene, of a triangle of the model.
    [[nodiscard]] std::uint32_t triangle_of(std::uint32_t model, std::uint32_t triangle) const noexcept {
        const std::uint32_t part = models_[model].part;
        return part == whole ? triangle : parts_[part].triangles[triangle];
    }

    /// After vertices of meshes that deform have moved.
    /// @throws input_error when a mesh is no longer valid or of as many triangles.
    void follow();
    /// @param poses one an object of the scene
    /// @throws input_error as `posed_boxes`.
    void place(std::span<const pose> poses);
    /// In the world, by piece.
    [[nodiscard]] std::span<const box> boxes() const noexcept { return boxes_; }

    [[nodiscard]] std::size_t bytes() const noexcept;

private:
    static constexpr std::uint32_t whole = 0xffffffff;

    struct part {
        mesh own;
        std::vector<std::uint32_t> vertices;   // of the mesh that it is of, by own number
        std::vector<std::uint32_t> triangles;  // the same
    };
    struct model {
        std::uint32_t source;  // mesh of the scene
        std::uint32_t part;    // or `whole`
        box bounds;
    };
    struct piece {
        std::uint32_t object;
        std::uint32_t model;
    };

    [[nodiscard]] static part part_of(const mesh& m, std::vector<std::uint32_t> triangles);

    const mesh_scene& scene_;
    std::vector<std::size_t> triangles_;  // of the scene's meshes
    std::vector<part> parts_;
    std::vector<model> models_;
    std::vector<piece> pieces_;
    std::vector<box> boxes_;
};

}  // namespace aabb
