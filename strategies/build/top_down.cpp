module aabb.build.top_down;

#pragma clang fp contract(off) reassociate(off) reciprocal(off)  // see aabb.base:floating_point

namespace aabb {

namespace {

/// The triangle with its box and its centroid, rounded to float: what a split rule sees.
build_element element_of_triangle(const mesh& m, std::uint32_t triangle) {
    const triangle3f t = m.triangle(triangle);
    build_element e{.bounds = bounds_of(t), .centroid = {}, .triangle = triangle};
    // In double, so that the sum cannot overflow.
    for (int k = 0; k < 3; ++k)
        e.centroid[k] = static_cast<float>((double{t[0][k]} + double{t[1][k]} + double{t[2][k]}) / 3);
    return e;
}

box bounds_of(std::span<const build_element> range) {
    box bounds = range[0].bounds;
    for (const build_element& e : range.subspan(1)) bounds = merged(bounds, e.bounds);
    return bounds;
}

/// The number of triangles nearest to `left` that leaves pairs on both sides. It does not deepen a balanced tree: for
/// 2m triangles, m odd and above 1, hence below some power of two, m + 1 do not exceed that power.
std::size_t rounded_to_pairs(std::size_t left, std::size_t count) {
    if (count % 2 != 0 || left % 2 == 0 || count == 2) return left;
    return left + 1 < count ? left + 1 : left - 1;
}

/// A range of elements that becomes a node.
struct task {
    std::size_t begin;
    std::size_t end;
    std::uint32_t node;

    [[nodiscard]] std::size_t size() const noexcept { return end - begin; }
};

class top_down_builder {
public:
    top_down_builder(const mesh& m, leaf_arrangement arrangement, const split_rule& split)
        : mesh_(m), arrangement_(arrangement), split_(split) {}

    /// Splits the triangles down to one per leaf; the number of threads does not change the result.
    /// @returns the nodes in preorder: n leaves and n - 1 internal nodes for n triangles
    [[nodiscard]] std::vector<build_node> build(std::uint32_t threads) {
        worker_threads workers(threads);
        const std::size_t n = mesh_.triangles.size();
        elements_.resize(n);
        workers.for_each_range(n, share_size, [&](std::size_t begin, std::size_t end) {
            for (std::size_t t = begin; t < end; ++t)
                elements_[t] = element_of_triangle(mesh_, static_cast<std::uint32_t>(t));
        });
        nodes_.resize(2 * n - 1);
        split_recursively(
            workers, task{.begin = 0, .end = n, .node = 0}, [&](const task& t) { return split_node(t); },
            [&](const task& t) { build_subtree(t); });
        return std::move(nodes_);
    }

private:
    /// Writes an internal node and partitions its elements, two or more. Nodes are in preorder: the left child follows
    /// its parent, and the right child the 2 n - 1 nodes of the left subtree of n triangles.
    [[nodiscard]] std::array<task, 2> split_node(const task& t) {
        const std::span range = std::span(elements_).subspan(t.begin, t.size());
        const box bounds = bounds_of(range);
        const split_choice chosen = split_(range, bounds);
        const std::size_t left =
            arrangement_ == leaf_arrangement::pairs ? rounded_to_pairs(chosen.left, range.size()) : chosen.left;
        if (chosen.axis != split_choice::in_current_order)
            std::ranges::nth_element(range, range.begin() + static_cast<std::ptrdiff_t>(left),
                                     centroid_order{chosen.axis});
        const auto right = static_cast<std::uint32_t>(t.node + 2 * left);
        nodes_[t.node] = {.bounds = bounds, .right = right, .triangle = 0};
        return {task{t.begin, t.begin + left, t.node + 1}, task{t.begin + left, t.end, right}};
    }

    /// Builds the subtree of a range of elements, with an explicit stack, since trees may be too deep for recursion.
    void build_subtree(const task& whole) {
        std::vector<task> tasks{whole};
        while (!tasks.empty()) {
            const task current = tasks.back();
            tasks.pop_back();
            if (current.size() == 1) {
                const build_element& only = elements_[current.begin];
                nodes_[current.node] = {.bounds = only.bounds, .right = 0, .triangle = only.triangle};
            } else {
                const auto [left, right] = split_node(current);
                tasks.push_back(right);
                tasks.push_back(left);
            }
        }
    }

    const mesh& mesh_;
    leaf_arrangement arrangement_;
    const split_rule& split_;
    std::vector<build_element> elements_;
    std::vector<build_node> nodes_;
};

}  // namespace

std::vector<build_node> build_top_down(const mesh& m, leaf_arrangement arrangement, const split_rule& split,
                                       std::uint32_t threads) {
    return top_down_builder(m, arrangement, split).build(threads);
}

}  // namespace aabb
