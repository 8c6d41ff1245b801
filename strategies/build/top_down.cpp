module aabb.build.top_down;

// Sums and products as they are written: see aabb.base:floating_point.
#pragma clang fp contract(off) reassociate(off) reciprocal(off)

namespace aabb {

namespace {

build_element element_of(const mesh& m, std::uint32_t triangle) {
    const triangle3f t = m.triangle(triangle);
    build_element e{bounds_of(t), {}, triangle};
    // In double, so that the sum cannot overflow.
    for (int k = 0; k < 3; ++k)
        e.centroid[k] = static_cast<float>((double{t[0][k]} + double{t[1][k]} + double{t[2][k]}) / 3);
    return e;
}

box bounds_of(std::span<const build_element> range) {
    box all = range[0].bounds;
    for (const build_element& e : range.subspan(1)) all = merged(all, e.bounds);
    return all;
}

/// The number of triangles nearest to `left` that leaves pairs on both sides. A balanced tree grows no deeper by it: of
/// 2m triangles, m odd, above 1 and so below some power of two, m + 1 still fit under that power.
std::size_t paired(std::size_t left, std::size_t all) {
    if (all % 2 != 0 || left % 2 == 0 || all == 2) return left;
    return left + 1 < all ? left + 1 : left - 1;
}

/// A range of elements to become a node.
struct task {
    std::size_t begin;
    std::size_t end;
    std::uint32_t node;

    [[nodiscard]] std::size_t size() const noexcept { return end - begin; }
};

class top_down {
public:
    top_down(const mesh& m, leaf_arrangement arrangement, const split_rule& split)
        : mesh_(m), arrangement_(arrangement), split_(split) {}

    [[nodiscard]] std::vector<build_node> build(std::uint32_t threads) {
        worker_threads workers(threads);
        const std::size_t n = mesh_.triangles.size();
        elements_.resize(n);
        workers.for_each_range(n, least_shared, [&](std::size_t begin, std::size_t end) {
            for (std::size_t t = begin; t < end; ++t) elements_[t] = element_of(mesh_, static_cast<std::uint32_t>(t));
        });
        nodes_.resize(2 * n - 1);
        halve(workers, task{0, n, 0}, [&](const task& t) { return halves_of(t); }, [&](const task& t) { finish(t); });
        return std::move(nodes_);
    }

private:
    [[nodiscard]] std::span<build_element> range_of(const task& t) noexcept {
        return std::span(elements_).subspan(t.begin, t.size());
    }

    [[nodiscard]] std::array<task, 2> halves_of(const task& t) {
        const std::span range = range_of(t);
        const box bounds = bounds_of(range);
        const split_choice chosen = split_(range, bounds);
        const std::size_t left =
            arrangement_ == leaf_arrangement::pairs ? paired(chosen.left, range.size()) : chosen.left;
        if (chosen.axis != split_choice::as_they_stand)
            std::ranges::nth_element(range, range.begin() + static_cast<std::ptrdiff_t>(left),
                                     centroid_order{chosen.axis});
        // The left child has 2 left - 1 nodes.
        const auto right = static_cast<std::uint32_t>(t.node + 2 * left);
        nodes_[t.node] = {bounds, right, range[0].triangle};
        return {task{t.begin, t.begin + left, t.node + 1}, task{t.begin + left, t.end, right}};
    }

    void finish(const task& whole) {
        // Deep trees must not cost stack.
        std::vector<task> tasks{whole};
        while (!tasks.empty()) {
            const task now = tasks.back();
            tasks.pop_back();
            if (now.size() == 1) {
                nodes_[now.node] = {elements_[now.begin].bounds, 0, elements_[now.begin].triangle};
            } else {
                const auto [left, right] = halves_of(now);
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
    return top_down(m, arrangement, split).build(threads);
}

}  // namespace aabb
