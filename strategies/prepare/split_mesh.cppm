export module aabb.prepare.split_mesh;

import aabb.pipeline;
import aabb.prepare.pieces;
import aabb.std;

export namespace aabb {

/// The paper's pre-processing (section 2) done to what objects are made of: "if a few objects are very large" each is
/// divided into smaller objects, with boxes of their own, before the search. Where `split_large` cuts a box, and its
/// pieces fill it, a part of a mesh has a box around its triangles only, and a tree.
///
/// A mesh that is longer, on an axis of its own frame, than `size` times the mean extent of all objects is cut as
/// `split_large` cuts a box; a triangle belongs to the cell in which its centroid lies. Cells without triangles are no
/// parts. All is decided before the first frame; parts follow a mesh that deforms. When to use: claim C9 asks.
struct split_mesh_prepare : dividing_prepare {
    using dividing_prepare::dividing_prepare;

    static constexpr std::string_view name = "split_mesh";
    static constexpr std::string_view summary =
        "meshes much longer than the mean are divided into parts with boxes and trees of their own";
    static constexpr std::string_view needs_meshes =
        "split_mesh divides meshes, and there are only boxes here; split_large divides boxes";

    [[nodiscard]] std::unique_ptr<global_stage> before(std::unique_ptr<global_stage> search,
                                                       instrumentation counted) const;
};

static_assert(PreparePolicy<split_mesh_prepare>);

}  // namespace aabb
