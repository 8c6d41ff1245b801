export module aabb.wide_tree.triangle_batch;

import aabb.std;
export import aabb.wide_tree.triangle_block;
import aabb.wide_tree.triangle_filter;

export namespace aabb {

/// Queues pairs of triangles, both in A's frame, until they fill SIMD vectors. For exact tests a floating-point filter
/// decides most pairs, and the test the rest; any other test decides all pairs.
template <TrianglePolicy Triangle>
class triangle_batch {
public:
    void clear() noexcept { pairs_ = leaf_pairs_ = 0; }
    [[nodiscard]] bool is_full() const noexcept { return pairs_ + most_per_leaf_pair > capacity; }

    /// Adds the pairs in the mask (bit 8 j + i for triangles i of `a` and j of `b`), not zero, to a queue that is not
    /// full: copies their corners by permutations, eight pairs at a time, and stores where they come from, for `emit`.
    inline void add(std::uint64_t mask, std::uint32_t leaf_a, const triangle_block& a, std::uint32_t leaf_b,
                    const triangle_block& b) noexcept {
        alignas(64) std::array<std::uint8_t, most_per_leaf_pair> bits{};
        simd::store_set_bits(bits.data(), mask);
        leaves_[leaf_pairs_] = {leaf_a, leaf_b};
        const auto leaf_pair = static_cast<std::uint32_t>(leaf_pairs_++ << pair_bits);
        const auto count = static_cast<std::size_t>(std::popcount(mask));
        // Almost always one iteration, so that the branch is predicted.
        std::size_t first = 0;
        do {
            const auto bit =
                __builtin_convertvector(simd::load_eight<simd::eight_bytes>(&bits[first]), simd::eight_words);
            const std::size_t to = pairs_ + first;
            for (std::size_t row = 0; row < rows; ++row) {
                simd::store_eight(&a_[row][to], simd::permuted(a.corner[row / 3][row % 3].data(), bit));
                simd::store_eight(&b_[row][to], simd::permuted(b.corner[row / 3][row % 3].data(), bit >> 3));
            }
            simd::store_eight(&origin_[to], bit | leaf_pair);
            first += triangle_block::width;
        } while (first < count);
        pairs_ += count;
    }

    /// Tests the queued pairs, a vector at a time, and passes those that intersect to `emit`, in one call. A
    /// floating-point filter decides most pairs of a vector, and the test itself the undecided ones.
    /// @param flush whether to test all pairs, instead of full vectors only
    /// @param triangles_at maps triangles i and j of two leaves to those of the meshes, as `(leaf_a, i, leaf_b, j)`
    /// @returns what `emit` returned: whether to stop
    template <class Query, class TrianglesAt, class Emit>
    [[nodiscard]] bool test_queued(const Query& test, bool flush, const TrianglesAt& triangles_at, const Emit& emit) {
        std::size_t done = 0;
        std::size_t hit_count = 0;
        for (; done + simd::width <= pairs_ || (flush && done < pairs_); done += simd::width) {
            const std::uint32_t present = simd::lanes_below(pairs_ - done);  // fewer than all in the last vector
            const filtered_pairs by_filter = filter(done, test.image_error());
            std::uint32_t hits = by_filter.hits & present;
            for (std::uint32_t open = by_filter.undecided & present; open != 0; open &= open - 1) {
                const auto lane = static_cast<std::uint32_t>(std::countr_zero(open));
                const std::size_t at = done + lane;
                if (test.intersects_unfiltered([&] { return pair_at(origin_[at], triangles_at); }, triangle(a_, at),
                                               triangle(b_, at)))
                    hits |= 1U << lane;
            }
            hit_count += simd::compress_store(&hits_[hit_count], simd::load(&origin_[done]), hits);
        }
        for (std::size_t i = 0; i < hit_count; ++i) pairs_of_hits_[i] = pair_at(hits_[i], triangles_at);
        drop_first(std::min(done, pairs_));
        return hit_count != 0 && emit(std::span<const index_pair>(pairs_of_hits_).first(hit_count));
    }

private:
    static constexpr std::size_t rows = 9;
    static constexpr std::size_t most_per_leaf_pair = 64;
    static constexpr std::size_t capacity = 144;
    static constexpr unsigned pair_bits = 6;  // of the number 8 j + i within a leaf pair
    using corners = std::array<std::array<float, capacity + triangle_block::width>, rows>;

    /// The triangles of the meshes, from the index of a pair of leaves and the places in them.
    template <class TrianglesAt>
    [[nodiscard]] inline index_pair pair_at(std::uint32_t origin, const TrianglesAt& triangles_at) const {
        const auto& [leaf_a, leaf_b] = leaves_[origin >> pair_bits];
        return triangles_at(leaf_a, origin & 7U, leaf_b, origin >> 3 & 7U);
    }

    [[nodiscard]] inline filtered_pairs filter(std::size_t first, const vec3f& image_error) const noexcept {
        if constexpr (requires { requires Triangle::filtered; })
            return triangle_filter::decide(&a_[0][first], &b_[0][first], a_[0].size(), image_error.at);
        else
            return {.hits = 0, .undecided = simd::every_lane};
    }

    [[nodiscard]] static inline triangle3f triangle(const corners& of, std::size_t at) noexcept {
        triangle3f t;
        for (std::size_t row = 0; row < rows; ++row)
            t[static_cast<int>(row / 3)][static_cast<int>(row % 3)] = of[row][at];
        return t;
    }

    /// Drops the tested pairs and moves the rest, less than a vector, to the beginning of each row.
    void drop_first(std::size_t done) noexcept {
        pairs_ -= done;
        if (pairs_ == 0) return clear();
        for (std::size_t row = 0; row < rows; ++row) {
            std::copy_n(&a_[row][done], simd::width, a_[row].data());
            std::copy_n(&b_[row][done], simd::width, b_[row].data());
        }
        // Drops the pairs of leaves before that of the first remaining pair, and shifts the origins' indices.
        const std::uint32_t first = origin_[done] >> pair_bits;
        simd::store(origin_.data(), simd::load(&origin_[done]) - (first << pair_bits));
        leaf_pairs_ -= first;
        std::copy_n(&leaves_[first], leaf_pairs_, leaves_.data());
    }

    std::size_t pairs_ = 0;
    std::size_t leaf_pairs_ = 0;
    alignas(64) corners a_{};
    alignas(64) corners b_{};
    std::array<std::uint32_t, capacity + triangle_block::width> origin_{};  // index of the leaf pair, then 8 j + i
    std::array<std::array<std::uint32_t, 2>, capacity> leaves_{};
    std::array<std::uint32_t, capacity + simd::width> hits_{};  // origins of the pairs that intersect
    std::array<index_pair, capacity> pairs_of_hits_{};          // the same as triangles of the meshes
};

}  // namespace aabb
