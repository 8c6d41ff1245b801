#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

import aabb.geometry;
import aabb.pipeline;
import aabb.policy;

namespace aabblab {

/// The triangle test of a command with --geometry.
/// @throws aabb::input_error where there is none of this name, or it only decides, with the names of those that do not.
/// @param composed only strategies are meant, as part of a composition
[[nodiscard]] std::unique_ptr<aabb::triangle_test> constructing_test(const aabb::strategy_choice& choice,
                                                                     bool composed);

/// @throws aabb::input_error where one is asked for, which has no triangle test to construct anything.
void require_no_engine(const std::optional<std::string>& engine);

/// What triangles of two posed meshes have in common: found in the frame of the first mesh, in which they are tested
/// (`relative_pose`), and carried to the world.
class hit_geometry {
public:
    /// @throws aabb::input_error as `constructing_test`.
    explicit hit_geometry(const aabb::strategy_choice& triangle);

    /// The meshes of the hits that follow, which must stay.
    void take(const aabb::mesh& a, const aabb::pose& pose_a, const aabb::mesh& b, const aabb::pose& pose_b);
    [[nodiscard]] aabb::triangle_intersection operator()(aabb::index_pair triangles) const;

private:
    std::unique_ptr<aabb::triangle_test> test_;
    const aabb::mesh* a_ = nullptr;
    const aabb::mesh* b_ = nullptr;
    aabb::pose pose_a_;
    std::optional<aabb::relative_pose> to_a_;
};

}  // namespace aabblab
