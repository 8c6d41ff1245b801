export module aabb.wide_tree.leaf_reader;

import aabb.std;
export import aabb.wide_tree.bvtt_front;
export import aabb.wide_tree.triangle_block;

export namespace aabb {

inline constexpr std::size_t most_claims = 128;  ///< pairs per group

/// A direct-mapped cache of leaves, by number. A group first claims all leaves that it needs, then reads the missing
/// ones, so that their memory accesses overlap. A leaf stays valid until another leaf is read into its slot.
template <class Leaf>
class leaf_cache {
public:
    /// Invalidates the cache, by a new epoch, and grows it if the tree has many leaves, to a power of two of slots.
    void begin(std::size_t leaves_of_tree) {
        if (leaves_.size() < most_slots && 2 * leaves_.size() <= leaves_of_tree)
            leaves_.resize(std::min(most_slots, std::bit_floor(leaves_of_tree)));
        if (++epoch_ != 0) return;
        // The 32-bit epoch wrapped around: entries of old epochs must not become valid again.
        keys_of_slots_.fill(0);
        epoch_ = 1;
    }

    /// Releases all claims. The missing leaves of the previous group must have been read.
    void begin_group() noexcept { ++group_, missing_count_ = 0; }

    /// Reserves a slot for a leaf of the current group of pairs, and lists it as missing if it is not cached.
    /// @returns false if another leaf of the group occupies the slot, which ends the group
    [[nodiscard]] inline bool claim(std::uint32_t leaf) noexcept {
        const std::size_t slot = slot_of(leaf);
        const std::uint64_t key = std::uint64_t{epoch_} << 32U | leaf;
        const bool is_missing = keys_of_slots_[slot] != key;
        // Fails if the group has claimed the slot for another leaf. The first condition is mostly false, the second
        // hard to predict: marked as unpredictable, the conjunction compiles to one branch instead of two.
        if (__builtin_unpredictable(static_cast<int>(is_missing) & static_cast<int>(claimants_[slot] == group_)))
            return false;
        missing_[missing_count_] = leaf;
        missing_count_ += is_missing;
        keys_of_slots_[slot] = key;
        claimants_[slot] = group_;
        return true;
    }

    [[nodiscard]] inline std::span<const std::uint32_t> missing() const noexcept {
        return std::span(missing_).first(missing_count_);
    }
    [[nodiscard]] inline Leaf& operator[](std::uint32_t leaf) noexcept { return leaves_[slot_of(leaf)]; }
    [[nodiscard]] std::size_t slots() const noexcept { return leaves_.size(); }
    [[nodiscard]] inline std::size_t slot_of(std::uint32_t leaf) const noexcept { return leaf & (leaves_.size() - 1); }
    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(leaves_); }

private:
    static constexpr std::size_t most_slots = 256;

    std::array<std::uint64_t, most_slots> keys_of_slots_{};  // epoch, then the leaf's number
    std::uint32_t epoch_ = 0;                                // the epoch; 0 marks an empty slot
    std::array<std::uint64_t, most_slots> claimants_{};      // by slot: the last group that claimed it
    std::uint64_t group_ = 1;
    std::array<std::uint32_t, most_claims + 1> missing_{};
    std::size_t missing_count_ = 0;
    std::vector<Leaf> leaves_;
};

/// Reads the leaves of pairs in groups that fit into two caches. It prefetches a group's vertex lists while the
/// previous group is tested, and vertices a few leaves ahead. Not all at once: processors drop more than some twenty.
template <WideTreePolicy Tree>
class leaf_reader {
public:
    /// Forms the next group of pairs: reserves slots in both caches for its leaves, up to the first leaf that finds no
    /// slot, and prefetches the vertex lists of the leaves that are not cached. The previous group must have been read;
    /// its leaves stay valid until the next group is read.
    /// @param begin,end the remaining pairs
    /// @param pair_at returns the leaves of pair i, in A's tree and in B's
    /// @returns the end of the group
    template <class LeafOfA, class LeafOfB, class PairAt>
    [[nodiscard]] inline std::size_t claim(const model<Tree>& a, leaf_cache<LeafOfA>& cache_a, const model<Tree>& b,
                                           leaf_cache<LeafOfB>& cache_b, std::size_t begin, std::size_t end,
                                           const PairAt& pair_at) {
        end = std::min(end, begin + most_claims);
        cache_a.begin_group();
        cache_b.begin_group();
        for (; begin < end; ++begin) {
            const auto [leaf_a, leaf_b] = pair_at(begin);
            if (!cache_a.claim(leaf_a) || !cache_b.claim(leaf_b)) break;
        }
        for (const std::uint32_t number : cache_a.missing()) a.tree().prefetch_vertices(number);
        for (const std::uint32_t number : cache_b.missing()) b.tree().prefetch_vertices(number);
        return begin;
    }

    /// Reads the leaves of the group that are missing in a model's cache, by steps. Before the first step reads a
    /// leaf's vertices, its vertex list is read and the vertices are prefetched, `ahead` leaves earlier.
    /// @param first,others called as `step(leaf, number, vertices)`; each step runs over all leaves before the next one
    /// starts, so that no leaf stalls on its own previous step
    template <class Leaf, class First, class... Others>
    inline void read_missing(const model<Tree>& m, leaf_cache<Leaf>& cache, const First& first,
                             const Others&... others) {
        const std::span<const std::uint32_t> missing = cache.missing();
        const auto prefetch = [&](std::size_t i) {
            m.tree().read_vertices(missing[i], lists_[i]);
            lists_[i].prefetch(m.triangles());
        };
        const auto do_step = [&](std::size_t i, const auto& step) { step(cache[missing[i]], missing[i], lists_[i]); };
        for (std::size_t i = 0; i < std::min(ahead, missing.size()); ++i) prefetch(i);
        for (std::size_t i = 0; i < missing.size(); ++i) {
            if (i + ahead < missing.size()) prefetch(i + ahead);
            do_step(i, first);
        }
        const auto do_step_for_all = [&](const auto& step) {
            for (std::size_t i = 0; i < missing.size(); ++i) do_step(i, step);
        };
        (do_step_for_all(others), ...);
    }

private:
    static constexpr std::size_t ahead = 10;  // leaves; most of their vertices are cached already

    std::array<vertex_list, most_claims + 1> lists_{};
};

/// Reads the triangles of a front's pairs of leaves, those of B in A's frame.
template <WideTreePolicy Tree>
class front_leaves {
public:
    /// Passes on the pairs of a front in order, a group of pairs at a time whose leaves fit into the caches.
    /// @param take called with a pair and the triangles of both leaves; returns whether to stop
    /// @returns whether `take` stopped
    template <class Take>
    [[nodiscard]] bool for_each_pair(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                                     std::span<const front_pair> pairs, leaf_reader<Tree>& reader, const Take& take) {
        cache_a_.begin(leaves_of(a));
        cache_b_.begin(leaves_of(b));
        const auto claim = [&](std::size_t begin) {
            return reader.claim(a, cache_a_, b, cache_b_, begin, pairs.size(),
                                [&](std::size_t i) { return std::pair(pairs[i].leaf_a, pairs[i].leaf_b); });
        };
        std::size_t begin = 0;
        std::size_t end = claim(begin);
        while (begin < end) {
            reader.read_missing(a, cache_a_,
                                [&](triangle_block& leaf, std::uint32_t number, const vertex_list& vertices) {
                                    leaf.load(a.triangles(), a.tree(), number, vertices);
                                });
            reader.read_missing(b, cache_b_,
                                [&](triangle_block& leaf, std::uint32_t number, const vertex_list& vertices) {
                                    leaf.load(b.triangles(), b.tree(), number, vertices, to_a);
                                });
            // Vertex lists of the next group are prefetched while this one is tested.
            const std::size_t next = claim(end);
            for (const front_pair& p : pairs.subspan(begin, end - begin))
                if (take(p, cache_a_[p.leaf_a], cache_b_[p.leaf_b])) return true;
            begin = end;
            end = next;
        }
        return false;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return cache_a_.bytes() + cache_b_.bytes(); }

private:
    leaf_cache<triangle_block> cache_a_;
    leaf_cache<triangle_block> cache_b_;
};

}  // namespace aabb
