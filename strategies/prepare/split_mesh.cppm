export module aabb.prepare.split_mesh;

import aabb.pipeline;
import aabb.prepare.pieces;
import aabb.std;

export namespace aabb {

/// The paper's pre-processing (section 2) applied to meshes: "if a few objects are very large" each is divided into
/// smaller objects with boxes of their own, before the broad phase. The pieces of `split_large` fill the box of their
/// object, whereas a part of a mesh has a tight box around its triangles, and a BVH of its own.
///
/// A mesh that is longer, on an axis of its local frame, than `size` times the mean extent of all objects is cut as
/// `split_large` cuts a box; each triangle belongs to the cell that contains its centroid, and empty cells yield no
/// parts. The division is fixed before the first frame; parts follow deforming meshes. When to use: see claim C9.
struct split_mesh_prepare : dividing_prepare {
    using dividing_prepare::dividing_prepare;

    static constexpr std::string_view name = "split_mesh";
    static constexpr std::string_view summary =
        "meshes much longer than the mean are divided into parts with boxes and trees of their own";
    static constexpr std::string_view needs_meshes =
        "split_mesh divides meshes, but the scene has only boxes; split_large divides boxes";

    [[nodiscard]] std::unique_ptr<global_stage> before(std::unique_ptr<global_stage> search,
                                                       instrumentation counted) const;
};

static_assert(PreparePolicy<split_mesh_prepare>);

}  // namespace aabb
