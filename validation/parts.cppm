module;
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

/// What the engines share; seen by this module only.
module aabb.validation:parts;

import aabb;

namespace aabb {

/// What every engine of boxes does alike: who is present, and refusing what a composed stage refuses. None counts its
/// work.
class box_engine : public global_stage {
public:
    void insert(std::uint32_t id) final { objects_.insert(id); }
    void remove(std::uint32_t id) final { objects_.remove(id); }
    void update(std::span<const box> boxes) final;
    void search(std::vector<index_pair>& pairs) final;
    [[nodiscard]] work_counters counters() const final { return {}; }
    [[nodiscard]] std::vector<std::string> left_out() const final { return {}; }

protected:
    [[nodiscard]] bool is_present(std::uint32_t id) const { return objects_.contains(id); }

    /// Takes the boxes of the present objects, whose ids are ascending.
    virtual void take(std::span<const box> boxes, std::span<const std::uint32_t> ids) = 0;
    /// Appends the overlapping pairs of what was taken.
    virtual void find(std::vector<index_pair>& pairs) = 0;

private:
    membership objects_;
    std::vector<std::uint32_t> ids_;
    frame_state frame_;
};

/// What every engine of meshes does alike, in terms of all pairs of two models. None counts its work or shows a tree.
class mesh_engine : public local_stage {
public:
    void all_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                   std::vector<index_pair>& pairs) final;
    [[nodiscard]] std::uint64_t count_pairs(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b,
                                            const pose& pose_b) final;
    void self_pairs(std::uint32_t model, std::vector<index_pair>& pairs) final;
    [[nodiscard]] std::optional<tree_survey> survey(std::uint32_t) const final { return std::nullopt; }
    [[nodiscard]] work_counters counters() const final { return {}; }
    [[nodiscard]] std::vector<std::string> left_out() const final { return {}; }

protected:
    /// Appends the intersecting pairs.
    virtual void find(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                      std::vector<index_pair>& pairs) = 0;
};

/// Finds pairs of triangles whose boxes overlap: triangle i of `a` and t of `b` as {i, t}, in any order.
using candidate_search = std::vector<index_pair>(std::span<const box> a, std::span<const box> b);
candidate_search candidates_by_double_loop;
candidate_search candidates_by_cgal;

/// Decides on two triangles in one frame.
using triangle_decision = bool(const triangle3f&, const triangle3f&);
triangle_decision gjk_intersect;

/// An engine that takes B's triangles into A's frame (`relative_pose`), finds candidates by boxes and decides them.
std::unique_ptr<local_stage> make_pairwise_engine(candidate_search& search, triangle_decision& decide);

std::unique_ptr<global_stage> make_brute_force_boxes();
std::unique_ptr<global_stage> make_cgal_boxes();
std::unique_ptr<global_stage> make_fcl_boxes();
std::unique_ptr<local_stage> make_fcl_meshes();

}  // namespace aabb
