export module aabb.build.median;

import aabb.build.top_down;
import aabb.std;

export namespace aabb {

/// The paper's balanced build (section 3.1): splits a node at the median of its triangles' centroids along the longest
/// axis of its box. The depth for n triangles is ⌈log₂ n⌉, paired leaves or not. When to use: to bound depth and time.
struct median_build : top_down_build<median_split, axis_rule::longest> {
    using top_down_build::top_down_build;

    static constexpr std::string_view name = "median";
    static constexpr std::string_view summary =
        "splits at the median of the triangles' centroids along the longest axis: balanced, as in the paper";
};

static_assert(BuildPolicy<median_build>);

}  // namespace aabb
