export module aabb.prepare.split_large;

import aabb.pipeline;
import aabb.prepare.pieces;
import aabb.std;

export namespace aabb {

/// The paper's pre-processing (section 2): "if a few objects are very large" each is divided into smaller ones. Stands
/// before a global search, which sees pieces; pairs of pieces are mapped back to pairs of objects.
///
/// On each axis on which a box is longer than `size` times the mean extent of all boxes it is cut into equal pieces no
/// longer than that (by more than a hundredth, so that rounding splits nothing), 16 at most. Pieces keep their ids from
/// frame to frame, and with them their places in sorted lists. They are closed and share their faces, so boxes overlap
/// exactly when some pieces do. Of those that do, one pair of pieces holds the corner of greater lower ends, half-open,
/// and only that one counts: no set is needed to find duplicates. A frame in which nothing is split goes to the search
/// as it is. When to use: claim C9 asks.
struct split_large_prepare : dividing_prepare {
    using dividing_prepare::dividing_prepare;

    static constexpr std::string_view name = "split_large";
    static constexpr std::string_view summary = "boxes much longer than the mean are divided into pieces";

    [[nodiscard]] std::unique_ptr<global_stage> before(std::unique_ptr<global_stage> search,
                                                       instrumentation counted) const;
};

static_assert(PreparePolicy<split_large_prepare>);

}  // namespace aabb
