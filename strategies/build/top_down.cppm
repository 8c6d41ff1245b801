/// A top-down build with an arbitrary split rule.
export module aabb.build.top_down;

export import aabb.build.balanced;
import aabb.std;

export namespace aabb {

/// Chooses the split of a node from its elements and their box. It is type-erased, so that the build is compiled once
/// for all rules, and must be thread-safe.
using split_rule = std::function<split_choice(std::span<const build_element> range, const box& bounds)>;

/// Orders elements along an axis; ties are broken by index, so that the tree does not depend on the library.
struct centroid_order {
    int axis;

    [[nodiscard]] bool operator()(const build_element& p, const build_element& q) const noexcept {
        return p.centroid[axis] != q.centroid[axis] ? p.centroid[axis] < q.centroid[axis] : p.triangle < q.triangle;
    }
};

/// The nodes do not depend on the number of threads.
[[nodiscard]] std::vector<build_node> build_top_down(const mesh& m, leaf_arrangement arrangement,
                                                     const split_rule& split, std::uint32_t threads);

/// Splits at the median along the longest axis of the box: the fallback of rules that would leave a side empty.
[[nodiscard]] inline split_choice median_split(std::span<const build_element> range, const box& bounds) {
    return {longest_axis(bounds), range.size() / 2};
}

/// A build by two rules: one for binary trees, one for layouts that prescribe how many triangles go to each side.
template <split_choice (*Split)(std::span<const build_element> range, const box& bounds), axis_rule Rule>
struct top_down_build : threaded_build {
    using threaded_build::threaded_build;

    [[nodiscard]] std::vector<build_node> build(const mesh& m, leaf_arrangement arrangement) const {
        return build_top_down(m, arrangement, Split, threads);
    }
    [[nodiscard]] balanced_order order(const mesh& m) const { return order_balanced(m, Rule, threads); }
};

}  // namespace aabb
