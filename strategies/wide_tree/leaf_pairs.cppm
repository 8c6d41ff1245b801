export module aabb.wide_tree.leaf_pairs;

import aabb.std;
export import aabb.wide_tree.leaf_reader;
export import aabb.wide_tree.leaf_slab;

export namespace aabb {

/// The triangles of a leaf and their boxes, in A's frame.
struct read_leaf {
    leaf_boxes boxes;
    triangle_block block;
};

struct read_leaf_of_b : read_leaf {
    leaf_slab slab;
    bool has_slab;
};

/// Reads the leaves of two trees, those of B in A's frame, and caches them: a leaf occurs in many pairs.
template <WideTreePolicy Tree>
class leaf_pairs {
public:
    struct query_options {
        bool shares_corners = false;          ///< A and B are one mesh, so that triangles may share corners
        bool rejects_by_exact_boxes = false;  ///< for inexact tests: results must not depend on the grid's rounding
    };
    /// Starts a query: fits the grid to both meshes and empties the caches.
    /// @param margin the distance along each axis up to which triangles count as close: at least the error of images
    void begin(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a, query_options options,
               float margin = 0) {
        grid_.begin(a.bounds(), to_a(b.bounds()));
        options_ = options;
        margin_ = margin;
        cache_a_.begin(leaves_of(a));
        cache_b_.begin(leaves_of(b));
        if (!options.shares_corners) return;
        corners_of_a_.resize(cache_a_.slots());
        corners_of_b_.resize(cache_b_.slots());
    }

    /// Passes on, in order, the pairs of leaves whose triangles may intersect: their boxes overlap, and triangles of A
    /// enter the slab of B's leaf, the space between two planes around its triangles. Each test runs over many pairs
    /// before the next one starts, which avoids branch mispredictions, and writes to its own list, which avoids
    /// store-to-load stalls.
    /// @param take called with the index of a pair, its leaves, and a mask of pairs of triangles (bit 8 j + i for
    /// triangle i of A's leaf and j of B's); returns whether to stop
    template <class Counters, class Take>
    [[nodiscard]] bool for_each_meeting(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                                        std::span<const std::uint32_t> leaves_a,
                                        std::span<const std::uint32_t> leaves_b, Counters& counters, const Take& take) {
        return for_each_group(
            a, b, to_a, leaves_a, leaves_b, counters,
            [&](std::span<const overlap> overlapping) {
                fit_missing_slabs(leaves_b, overlapping);
                std::size_t count = 0;
                for (const auto& [pair, box_mask] : overlapping) {
                    const std::uint64_t mask =
                        box_mask &
                        copied_to_rows(cache_b_[leaves_b[pair]].slab.triangles_inside(cache_a_[leaves_a[pair]].block));
                    in_slab_[count] = {pair, mask};
                    count += mask != 0;
                }
                return std::span<const overlap>(in_slab_).first(count);
            },
            [&](const overlap& o) {
                return take(o.pair, cache_a_[leaves_a[o.pair]], cache_b_[leaves_b[o.pair]], o.mask);
            });
    }

    /// Passes on, in order, the pairs of leaves whose triangles may lie within the margin of each other: by their boxes
    /// and by the slabs of both leaves, each the space between two planes around a leaf's triangles. `take` gets the
    /// index of a pair and a mask (bit 8 j + i for triangle i of A's leaf and j of B's).
    template <class Counters, class Take>
    [[nodiscard]] bool for_each_within_margin(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                                              std::span<const std::uint32_t> leaves_a,
                                              std::span<const std::uint32_t> leaves_b, Counters& counters,
                                              const Take& take) {
        return for_each_group(
            a, b, to_a, leaves_a, leaves_b, counters,
            [&](std::span<const overlap> overlapping) {
                fit_missing_slabs(leaves_b, overlapping);
                return overlapping;
            },
            [&](const overlap& o) {
                const read_leaf& leaf_a = cache_a_[leaves_a[o.pair]];
                const read_leaf_of_b& leaf_b = cache_b_[leaves_b[o.pair]];
                leaf_slab slab_of_a;
                slab_of_a.fit(leaf_a.block, grid_.edges(), margin_);
                const std::uint64_t mask = o.mask & expanded_to_rows(slab_of_a.triangles_inside(leaf_b.block)) &
                                           copied_to_rows(leaf_b.slab.triangles_inside(leaf_a.block));
                return mask != 0 && take(o.pair, mask);
            });
    }

    /// Sets bit 8 j + i where triangle i of A's leaf and j of B's share a corner; for one mesh only.
    [[nodiscard]] inline std::uint64_t pairs_sharing_corners(std::uint32_t leaf_a,
                                                             std::uint32_t leaf_b) const noexcept {
        return corners_of_a_[cache_a_.slot_of(leaf_a)].pairs_sharing_corners(corners_of_b_[cache_b_.slot_of(leaf_b)]);
    }

    [[nodiscard]] leaf_reader<Tree>& reader() noexcept { return reader_; }
    [[nodiscard]] std::size_t bytes() const noexcept {
        return cache_a_.bytes() + cache_b_.bytes() + bytes_of(corners_of_a_, corners_of_b_);
    }

private:
    static constexpr int many_overlaps = 32;  // of 64 pairs; leaves rarely have more

    /// Returns a function that reads a leaf's triangles.
    /// @param frame the pose relative to A, for leaves of B
    template <class Leaf, class... Frame>
    [[nodiscard]] static inline auto triangle_loader(const model<Tree>& m, const Frame&... frame) {
        return [&m, &frame...](Leaf& leaf, std::uint32_t number, const vertex_list& vertices) {
            leaf.block.load(m.triangles(), m.tree(), number, vertices, frame...);
        };
    }
    /// Returns a function that computes the boxes and corners of a leaf's triangles.
    /// @tparam OfB whether the leaf is B's, whose boxes the margin inflates
    template <bool OfB, class Leaf>
    [[nodiscard]] inline auto box_builder(const model<Tree>& m, const leaf_cache<Leaf>& cache,
                                          std::vector<corner_indices>& corners) const {
        return [this, &m, &cache, &corners](Leaf& leaf, std::uint32_t number, const vertex_list&) {
            auto bounds = leaf.block.bounds();
            if (OfB && margin_ > 0) grow(bounds);
            leaf.boxes.quantize(grid_, bounds, leaf.block.triangles);
            if constexpr (requires { leaf.slab; }) leaf.has_slab = false;
            if (options_.shares_corners) corners[cache.slot_of(number)].load(m.triangles(), m.tree(), number);
        };
    }

    /// Inflates boxes by the margin, clamped to the range of float.
    inline void grow(std::array<simd::eight_floats, 6>& bounds) const noexcept {
        const simd::eight_floats most = simd::eight_floats{} + std::numeric_limits<float>::max();
        for (std::size_t k = 0; k < 3; ++k) {
            const simd::eight_floats lower = bounds[k] - margin_;
            const simd::eight_floats upper = bounds[3 + k] + margin_;
            bounds[k] = lower > -most ? lower : -most;
            bounds[3 + k] = upper < most ? upper : most;
        }
    }

    /// The index of a pair of leaves, and a mask of its overlapping pairs of triangles.
    struct overlap {
        std::size_t pair;
        std::uint64_t mask;
    };

    /// Reads the leaves of one group of pairs at a time, which all fit into the caches, keeps the pairs with
    /// overlapping triangle boxes, filters them by `filter` and passes on the rest. The vertex lists of the next group
    /// are prefetched meanwhile.
    /// @returns whether `take` stopped the loop
    template <class Counters, class Filter, class Take>
    [[nodiscard]] inline bool for_each_group(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                                             std::span<const std::uint32_t> leaves_a,
                                             std::span<const std::uint32_t> leaves_b, Counters& counters,
                                             const Filter& filter, const Take& take) {
        const auto claim = [&](std::size_t begin) {
            return reader_.claim(a, cache_a_, b, cache_b_, begin, leaves_a.size(),
                                 [&](std::size_t i) { return std::pair(leaves_a[i], leaves_b[i]); });
        };
        std::size_t begin = 0;
        std::size_t end = claim(begin);
        while (begin < end) {
            reader_.read_missing(a, cache_a_, triangle_loader<read_leaf>(a),
                                 box_builder<false>(a, cache_a_, corners_of_a_));
            reader_.read_missing(b, cache_b_, triangle_loader<read_leaf_of_b>(b, to_a),
                                 box_builder<true>(b, cache_b_, corners_of_b_));
            const std::size_t next = claim(end);
            for (const overlap& o : filter(find_overlaps(leaves_a, leaves_b, begin, end, counters)))
                if (take(o)) return true;
            begin = end;
            end = next;
        }
        return false;
    }

    /// Finds the pairs of leaves, from `begin` to `end`, with overlapping triangle boxes: on the grid, or in float too.
    template <class Counters>
    [[nodiscard]] inline std::span<const overlap> find_overlaps(std::span<const std::uint32_t> leaves_a,
                                                                std::span<const std::uint32_t> leaves_b,
                                                                std::size_t begin, std::size_t end,
                                                                Counters& counters) {
        std::size_t count = 0;
        for (; begin < end; ++begin) {
            const read_leaf& leaf_a = cache_a_[leaves_a[begin]];
            const read_leaf& leaf_b = cache_b_[leaves_b[begin]];
            counters.add(work::box_tests, std::uint64_t{leaf_a.block.triangles} * leaf_b.block.triangles);
            std::uint64_t mask = leaf_a.boxes.overlaps(leaf_b.boxes);
            // With many overlaps, the grid may be too coarse for these leaves.
            if (options_.rejects_by_exact_boxes || std::popcount(mask) > many_overlaps)
                mask &= float_overlaps(leaf_a, leaf_b);
            overlapping_[count] = {begin, mask};
            count += mask != 0;
        }
        return std::span(overlapping_).first(count);
    }

    /// Fits the missing slabs of B's leaves in these pairs. Slabs are fitted lazily, because many leaves have no
    /// overlapping boxes, and for B's leaves, which are read less often: a node of B is opened with many of A in a row.
    inline void fit_missing_slabs(std::span<const std::uint32_t> leaves_b,
                                  std::span<const overlap> overlapping) noexcept {
        std::size_t missing = 0;
        for (const overlap& o : overlapping) {
            read_leaf_of_b& leaf = cache_b_[leaves_b[o.pair]];
            missing_slabs_[missing] = &leaf;
            missing += !leaf.has_slab;
            leaf.has_slab = true;
        }
        for (read_leaf_of_b* const leaf : std::span(missing_slabs_).first(missing))
            leaf->slab.fit(leaf->block, grid_.edges(), margin_);
    }

    /// Sets bit 8 j + i where the float boxes of triangle i of A's leaf and j of B's overlap or lie within the margin.
    /// Sets all bits, without a test, where 16 bits are precise enough.
    [[nodiscard, gnu::noinline]] std::uint64_t float_overlaps(const read_leaf& leaf_a,
                                                              const read_leaf& leaf_b) const noexcept {
        const bool are_coarse = leaf_a.boxes.are_coarse() && leaf_b.boxes.are_coarse();
        if (!are_coarse && !options_.rejects_by_exact_boxes) return ~std::uint64_t{0};
        eight_boxes boxes_a;
        eight_boxes boxes_b;
        auto bounds_b = leaf_b.block.bounds();
        grow(bounds_b);
        boxes_a.set(leaf_a.block.bounds(), leaf_a.block.triangles);
        boxes_b.set(bounds_b, leaf_b.block.triangles);
        return boxes_a.overlaps(boxes_b);
    }

    /// Expands bit j to all bits of row j.
    [[nodiscard]] static constexpr std::uint64_t expanded_to_rows(std::uint64_t bits) noexcept {
        const std::uint64_t bit_of_row = bits * 0x0101010101010101 & 0x8040201008040201;
        constexpr std::uint64_t low_bits = 0x7f7f7f7f7f7f7f7f;
        return ((((bit_of_row & low_bits) + low_bits) | bit_of_row) >> 7U & 0x0101010101010101) * 0xff;
    }

    /// Copies bit i to bit i of each row.
    [[nodiscard]] static constexpr std::uint64_t copied_to_rows(std::uint64_t bits) noexcept {
        return bits * 0x0101010101010101;
    }

    leaf_grid grid_;
    query_options options_;
    float margin_ = 0;
    leaf_cache<read_leaf> cache_a_;
    leaf_cache<read_leaf_of_b> cache_b_;
    std::vector<corner_indices> corners_of_a_;  // for one mesh only; indexed as the leaves
    std::vector<corner_indices> corners_of_b_;
    std::array<overlap, most_claims + 1> overlapping_{};
    std::array<read_leaf_of_b*, most_claims + 1> missing_slabs_{};
    std::array<overlap, most_claims + 1> in_slab_{};  // those with triangles of A in the slab of B's leaf
    leaf_reader<Tree> reader_;
};

}  // namespace aabb
