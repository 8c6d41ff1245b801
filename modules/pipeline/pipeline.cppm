module;
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

export module aabb.pipeline;

export import :divided_scene;
export import :posed_boxes;
export import :prepare_policy;
export import :scene;
export import :stage;
export import :tested_by;

import aabb.base;
import aabb.geometry;

export namespace aabb {

/// Both stages together on a scene of moving meshes: global search proposes pairs of objects, local detection decides.
/// Neither stage knows the other; the buffer of candidate pairs is all there is between them. Where global search asks
/// for it (`global_stage::divide`) both see parts of objects in place of whole ones; contacts are those of objects all
/// the same.
class pipeline {
public:
    /// Takes the objects and builds the models of the scene. Scene and stages must outlive the pipeline.
    pipeline(const mesh_scene& scene, global_stage& global, local_stage& local);
    /// Without global search every two objects are candidates, and no boxes are made of them in the world, so that they
    /// may lie anywhere.
    pipeline(const mesh_scene& scene, local_stage& local);

    /// One frame, in three steps that can be timed apart. The first takes the poses, one an object, and fits the trees
    /// of meshes that have deformed.
    /// @throws input_error on a pose that is not rigid or takes an object beyond the range of float, by its number.
    void update(std::span<const pose> poses);
    /// @throws input_error when the last update did not succeed, or there was none.
    void search();
    /// @throws input_error when the last search did not succeed, or there was none since the last update.
    void detect();

    /// In place of `detect`: any one contact, how many there are.
    /// @throws input_error as `detect`.
    [[nodiscard]] std::optional<contact> first_contact();
    [[nodiscard]] std::uint64_t count_contacts();

    /// In the world, by object; by piece where meshes are divided; empty without global search.
    [[nodiscard]] std::span<const box> boxes() const noexcept {
        return divided_ ? divided_->boxes() : world_ ? world_->boxes() : std::span<const box>();
    }
    /// Pairs of objects whose boxes overlap, in no particular order; where meshes are divided, one for each two pieces
    /// of two objects whose boxes do.
    [[nodiscard]] std::span<const index_pair> candidates() const noexcept { return candidates_; }
    /// In no particular order.
    [[nodiscard]] std::span<const contact> contacts() const noexcept { return contacts_; }
    /// Of local detection: the meshes, or what they are divided into.
    [[nodiscard]] std::uint32_t models() const noexcept;
    [[nodiscard]] std::size_t bytes() const noexcept;
    /// What the division of meshes takes beside that.
    [[nodiscard]] std::size_t division_bytes() const noexcept { return divided_ ? divided_->bytes() : 0; }

private:
    /// A candidate as local detection sees it.
    struct model_pair {
        std::uint32_t a;
        std::uint32_t b;
    };

    void add_models();
    void follow_meshes();
    void require_searched() const;
    [[nodiscard]] model_pair models_of(std::size_t candidate) const noexcept;
    [[nodiscard]] contact contact_of(std::size_t candidate, index_pair triangles) const noexcept;

    const mesh_scene& scene_;
    global_stage* global_ = nullptr;
    local_stage& local_;
    std::optional<divided_scene> divided_;  // with global search that asks for it
    std::optional<posed_boxes> world_;      // with any other
    std::vector<pose> poses_;
    std::vector<index_pair> candidates_;
    std::vector<index_pair> pieces_;  // by candidate, where meshes are divided
    std::vector<index_pair> triangle_pairs_;
    std::vector<contact> contacts_;
    frame_state frame_;
    bool searched_ = false;
};

}  // namespace aabb
