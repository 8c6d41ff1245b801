module;
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

module aabb.engines:mesh_engine;

import aabb.counters;
import aabb.geometry;
import aabb.local_detection;
import aabb.pipeline;

namespace aabb {

/// The vertices of B seen from A, by number. Those outside B's box, which no triangle uses, stay as they are.
/// @param bounds of B, in its own frame
[[nodiscard]] std::vector<vec3f> moved_vertices(const pose& pose_a, const pose& pose_b, const mesh& b,
                                                const box& bounds);

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
    [[nodiscard]] std::vector<omission> left_out() const final { return {}; }

protected:
    /// Appends the intersecting pairs.
    virtual void find(std::uint32_t model_a, const pose& pose_a, std::uint32_t model_b, const pose& pose_b,
                      std::vector<index_pair>& pairs) = 0;
};

}  // namespace aabb
