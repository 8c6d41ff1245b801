/// Builds from the root down, node by node, whatever says where a node is split.
export module aabb.build.top_down;

export import aabb.build.balanced;
import aabb.std;

export namespace aabb {

/// Takes the elements of a node and their box. Asked by a call, so that the rest is compiled once, whatever the rule;
/// by several threads at a time.
using split_rule = std::function<split_choice(std::span<const build_element> range, const box& bounds)>;

/// Along an axis; ties go by index, so that the tree does not depend on the library.
struct centroid_order {
    int axis;

    [[nodiscard]] bool operator()(const build_element& p, const build_element& q) const noexcept {
        return p.centroid[axis] != q.centroid[axis] ? p.centroid[axis] < q.centroid[axis] : p.triangle < q.triangle;
    }
};

/// The same nodes whatever the number of threads.
[[nodiscard]] std::vector<build_node> build_top_down(const mesh& m, leaf_arrangement arrangement,
                                                     const split_rule& split, std::uint32_t threads);

/// At the median of the longest axis of the box: what every split falls back to where its own rule leaves a side empty.
[[nodiscard]] inline split_choice median_split(std::span<const build_element> range, const box& bounds) {
    return {longest_axis(bounds), range.size() / 2};
}

/// A build by rules: one for the nodes of a binary tree, one for layouts that prescribe how many go to which side.
template <split_choice (*Split)(std::span<const build_element> range, const box& bounds), axis_rule Rule>
struct top_down_build : threaded_build {
    using threaded_build::threaded_build;

    [[nodiscard]] std::vector<build_node> build(const mesh& m, leaf_arrangement arrangement) const {
        return build_top_down(m, arrangement, Split, threads);
    }
    [[nodiscard]] balanced_order order(const mesh& m) const { return order_by_halves(m, Rule, threads); }
};

}  // namespace aabb
