export module aabb.prepare.split_large;

import aabb.pipeline;
import aabb.prepare.pieces;
import aabb.std;

export namespace aabb {

/// The paper's pre-processing (section 2): "if a few objects are very large" each is divided into smaller ones. It
/// precedes the broad phase, which sees pieces; pairs of pieces are mapped back to pairs of objects.
///
/// On each axis on which a box is longer than `size` times the mean extent of all boxes, it is cut into equal pieces no
/// longer than that (with a tolerance of 1%, so that rounding errors cut nothing), 16 at most. Pieces keep their ids
/// between frames, and with them their places in sorted lists. They are closed and share their faces, so two boxes
/// overlap exactly when some of their pieces do. Exactly one pair of pieces, taken as half-open, contains the lower
/// corner of the overlap, and only this pair is reported, so that no set is needed to remove duplicates. A frame
/// without splits is searched as it is. When to use: see claim C9.
struct split_large_prepare : dividing_prepare {
    using dividing_prepare::dividing_prepare;

    static constexpr std::string_view name = "split_large";
    static constexpr std::string_view summary = "boxes much longer than the mean are divided into pieces";

    [[nodiscard]] std::unique_ptr<global_stage> before(std::unique_ptr<global_stage> search,
                                                       instrumentation counted) const;
};

static_assert(PreparePolicy<split_large_prepare>);

}  // namespace aabb
