module;
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

export module aabb.pipeline;

export import :posed_boxes;
export import :prepare_policy;
export import :scene;
export import :stage;
export import :tested_by;

import aabb.base;
import aabb.geometry;

export namespace aabb {

/// Both stages together on a scene of moving meshes: global search proposes pairs of objects, local detection decides.
/// Neither stage knows the other; the buffer of candidate pairs is all there is between them.
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

    /// In the world, by object; empty without global search.
    [[nodiscard]] std::span<const box> boxes() const noexcept {
        return world_ ? world_->boxes() : std::span<const box>();
    }
    /// Pairs of objects whose boxes overlap, in no particular order.
    [[nodiscard]] std::span<const index_pair> candidates() const noexcept { return candidates_; }
    /// In no particular order.
    [[nodiscard]] std::span<const contact> contacts() const noexcept { return contacts_; }
    [[nodiscard]] std::size_t bytes() const noexcept;

private:
    void add_models();

    const mesh_scene& scene_;
    global_stage* global_ = nullptr;
    local_stage& local_;
    std::optional<posed_boxes> world_;  // with global search
    std::vector<pose> poses_;
    std::vector<index_pair> candidates_;
    std::vector<index_pair> triangle_pairs_;
    std::vector<contact> contacts_;
    frame_state frame_;
    bool searched_ = false;
};

}  // namespace aabb
