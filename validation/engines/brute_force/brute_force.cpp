module aabb.engines;

import :box_engine;
import :engine;
import :pairwise;

namespace aabb {

namespace {

/// Tests all pairs in the simplest loop that vectorises: without sorting or data structures, which could have bugs.
class brute_force_boxes final : public box_engine {
public:
    [[nodiscard]] std::vector<part_bytes> bytes() const override { return {{"engine", bytes_of(ids_, min_, max_)}}; }

private:
    using block_hits = std::array<std::uint32_t, 512>;  // 1 where a box of the block overlaps

    /// Copies the bounds of the present boxes into one array per axis and end, as vectorised loops need them.
    void take_boxes(std::span<const box> boxes, std::span<const std::uint32_t> ids) override {
        ids_.assign(ids.begin(), ids.end());
        for (std::size_t k = 0; k < 3; ++k) {
            min_[k].clear();
            max_[k].clear();
            for (const std::uint32_t id : ids) {
                min_[k].push_back(boxes[id].min[static_cast<int>(k)]);
                max_[k].push_back(boxes[id].max[static_cast<int>(k)]);
            }
        }
    }

    /// Tests blocks of boxes without branches, which vectorises, then searches the few blocks with an overlap.
    void find_pairs(std::vector<index_pair>& pairs) override {
        block_hits hits{};
        for (std::size_t i = 0; i < ids_.size(); ++i)
            for (std::size_t begin = i + 1; begin < ids_.size(); begin += hits.size()) {
                const std::size_t count = std::min(hits.size(), ids_.size() - begin);
                if (!test_block(i, begin, count, hits)) continue;
                for (std::size_t j = 0; j < count; ++j)
                    if (hits[j]) pairs.push_back({ids_[i], ids_[begin + j]});
            }
    }

    /// Tests box i against `count` boxes from `begin` on; returns whether it overlaps any.
    /// @param hits output: hits[j] is whether box i overlaps box begin + j
    [[nodiscard]] bool test_block(std::size_t i, std::size_t begin, std::size_t count, block_hits& hits) const {
        const box tested{{min_[0][i], min_[1][i], min_[2][i]}, {max_[0][i], max_[1][i], max_[2][i]}};
        const std::array<const float*, 3> low = {&min_[0][begin], &min_[1][begin], &min_[2][begin]};
        const std::array<const float*, 3> high = {&max_[0][begin], &max_[1][begin], &max_[2][begin]};
        std::uint32_t any = 0;
        for (std::size_t j = 0; j < count; ++j) {
            hits[j] = overlaps(tested, {{low[0][j], low[1][j], low[2][j]}, {high[0][j], high[1][j], high[2][j]}});
            any |= hits[j];
        }
        return any != 0;
    }

    // The bounds of the present objects by axis, in ascending order of ids.
    std::vector<std::uint32_t> ids_;
    std::array<std::vector<float>, 3> min_, max_;
};

std::vector<index_pair> candidates_by_double_loop(std::span<const box> a, std::span<const box> b) {
    std::vector<index_pair> pairs;
    for (std::uint32_t s = 0; s < a.size(); ++s)
        for (std::uint32_t t = 0; t < b.size(); ++t)
            if (overlaps(a[s], b[t])) pairs.push_back({s, t});
    return pairs;
}

}  // namespace

engine brute_force_engine() {
    return {.name = "brute_force",
            .summary = "every pair of boxes; every pair of triangles whose boxes overlap, by CGAL's exact kernel",
            .boxes = make_stage<global_stage, brute_force_boxes>,
            .meshes = [] { return make_pairwise_engine(candidates_by_double_loop, intersect_exactly); }};
}

}  // namespace aabb
