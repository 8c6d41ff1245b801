export module aabb.wide_tree.leaf_reader;

import aabb.std;
export import aabb.wide_tree.leaf_front;
export import aabb.wide_tree.triangle_block;

export namespace aabb {

inline constexpr std::size_t most_claims = 128;  ///< at once

/// Leaves that were read lately, found again by their number: each has one place, which it shares with others. First
/// all that are needed at a time are claimed, then those that are missing are read, so that none waits for another.
/// What a place holds can be read, by its own number, until another leaf is read into it.
template <class Leaf>
class leaf_store {
public:
    /// Forgets all, and takes few places where there will be few numbers.
    void begin(std::size_t numbers) {
        if (leaves_.size() < most_places && 2 * leaves_.size() <= numbers)
            leaves_.resize(std::min(most_places, std::bit_floor(numbers)));
        if (++begun_ != 0) return;
        // After all numbers of 32 bits: what was held under the first ones is not to come back.
        held_.fill(0);
        begun_ = 1;
    }

    void release_claims() noexcept { ++claim_; }

    /// @returns false where another one that is claimed has the place
    [[nodiscard]] inline bool claim(std::uint32_t number) noexcept {
        const std::size_t at = place(number);
        const std::uint64_t held = std::uint64_t{begun_} << 32U | number;
        const bool is_missing = held_[at] != held;
        // Of the two, one is mostly false and the other hard to foresee. What is told to be unforeseeable as a whole
        // stays one branch, where a compiler would make two of it.
        if (__builtin_unpredictable(static_cast<int>(is_missing) & static_cast<int>(claims_[at] == claim_)))
            return false;
        missing_[missing_count_] = number;
        missing_count_ += is_missing;
        held_[at] = held;
        claims_[at] = claim_;
        return true;
    }

    /// What was claimed and is not there, to be read before the next claim, or never before the next `begin`.
    [[nodiscard]] inline std::span<const std::uint32_t> take_missing() noexcept {
        return std::span(missing_).first(std::exchange(missing_count_, 0));
    }

    [[nodiscard]] inline Leaf& operator[](std::uint32_t number) noexcept { return leaves_[place(number)]; }

    [[nodiscard]] std::size_t places() const noexcept { return leaves_.size(); }
    [[nodiscard]] inline std::size_t place(std::uint32_t number) const noexcept {
        return number & (leaves_.size() - 1);
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return bytes_of(leaves_); }

private:
    static constexpr std::size_t most_places = 256;

    std::array<std::uint64_t, most_places> held_{};  // the number of the beginning, then that of the leaf
    std::uint32_t begun_ = 0;                        // how often; 0 stands for nothing held
    std::array<std::uint64_t, most_places> claims_{};
    std::uint64_t claim_ = 1;
    std::array<std::uint32_t, most_claims + 1> missing_{};
    std::size_t missing_count_ = 0;
    std::vector<Leaf> leaves_;
};

/// Reads the leaves of pairs, group by group: of as many pairs at a time as two stores have places for. Memory is told
/// of a group's lists of vertices while the group before is tested, and of vertices some leaves before they are read.
/// Not of all at once: a processor drops requests beyond some twenty that are under way.
template <WideTreePolicy Tree>
class leaf_reader {
public:
    /// Claims the leaves of pairs for the next group, once those of the group before are made, which can be read until
    /// the next ones are. Memory is told of the lists of those that are missing.
    /// @param begin of the group
    /// @param end of all pairs
    /// @param pair_at the leaves of pair i, of A's tree and of B's
    /// @returns the end of the group
    template <class LeafOfA, class LeafOfB, class PairAt>
    [[nodiscard]] inline std::size_t claim(const model<Tree>& a, leaf_store<LeafOfA>& of_a, const model<Tree>& b,
                                           leaf_store<LeafOfB>& of_b, std::size_t begin, std::size_t end,
                                           const PairAt& pair_at) {
        end = std::min(end, begin + most_claims);
        of_a.release_claims();
        of_b.release_claims();
        for (; begin < end; ++begin) {
            const auto [leaf_a, leaf_b] = pair_at(begin);
            if (!of_a.claim(leaf_a) || !of_b.claim(leaf_b)) break;
        }
        missing_a_ = of_a.take_missing();
        missing_b_ = of_b.take_missing();
        for (const std::uint32_t number : missing_a_) a.tree().fetch_vertices(number);
        for (const std::uint32_t number : missing_b_) b.tree().fetch_vertices(number);
        return begin;
    }

    /// Makes those leaves of the group that are missing in A's store.
    /// @param steps each called for all of them before the next, as `step(leaf, number, its vertices)`, so that none
    /// waits for what was made just before
    template <class Leaf, class... Steps>
    inline void make_a(const model<Tree>& a, leaf_store<Leaf>& store, const Steps&... steps) {
        make(a, missing_a_, store, steps...);
    }
    /// The same of B's.
    template <class Leaf, class... Steps>
    inline void make_b(const model<Tree>& b, leaf_store<Leaf>& store, const Steps&... steps) {
        make(b, missing_b_, store, steps...);
    }

private:
    static constexpr std::size_t ahead = 10;  // leaves, of which most vertices are in the caches already

    template <class Leaf, class First, class... Others>
    inline void make(const model<Tree>& m, std::span<const std::uint32_t> missing, leaf_store<Leaf>& store,
                     const First& first, const Others&... others) {
        const auto fetch = [&](std::size_t i) {
            m.tree().read_vertices(missing[i], lists_[i]);
            lists_[i].fetch(m.triangles());
        };
        const auto do_step = [&](std::size_t i, const auto& step) { step(store[missing[i]], missing[i], lists_[i]); };
        for (std::size_t i = 0; i < std::min(ahead, missing.size()); ++i) fetch(i);
        for (std::size_t i = 0; i < missing.size(); ++i) {
            if (i + ahead < missing.size()) fetch(i + ahead);
            do_step(i, first);
        }
        const auto do_all = [&](const auto& step) {
            for (std::size_t i = 0; i < missing.size(); ++i) do_step(i, step);
        };
        (do_all(others), ...);
    }

    std::span<const std::uint32_t> missing_a_;
    std::span<const std::uint32_t> missing_b_;
    std::array<vertex_list, most_claims + 1> lists_{};
};

/// Reads the triangles of pairs of leaves of which is known which may meet, those of B in A's frame.
template <WideTreePolicy Tree>
class kept_leaves {
public:
    /// @param read shared with others
    /// @param take called with a pair and the triangles of both leaves; returns whether to stop
    template <class Take>
    [[nodiscard]] bool operator()(const model<Tree>& a, const model<Tree>& b, const relative_pose& to_a,
                                  std::span<const kept_pair> pairs, leaf_reader<Tree>& read, const Take& take) {
        of_a_.begin(leaves_of(a));
        of_b_.begin(leaves_of(b));
        const auto claim = [&](std::size_t begin) {
            return read.claim(a, of_a_, b, of_b_, begin, pairs.size(),
                              [&](std::size_t i) { return std::pair(pairs[i].leaf_a, pairs[i].leaf_b); });
        };
        std::size_t begin = 0;
        std::size_t end = claim(begin);
        while (begin < end) {
            read.make_a(a, of_a_, [&](triangle_block& leaf, std::uint32_t number, const vertex_list& vertices) {
                leaf.load(a.triangles(), a.tree(), number, vertices);
            });
            read.make_b(b, of_b_, [&](triangle_block& leaf, std::uint32_t number, const vertex_list& vertices) {
                leaf.load(b.triangles(), b.tree(), number, vertices, to_a);
            });
            const std::size_t next = claim(end);
            for (const kept_pair& p : pairs.subspan(begin, end - begin))
                if (take(p, of_a_[p.leaf_a], of_b_[p.leaf_b])) return true;
            begin = end;
            end = next;
        }
        return false;
    }

    [[nodiscard]] std::size_t bytes() const noexcept { return of_a_.bytes() + of_b_.bytes(); }

private:
    leaf_store<triangle_block> of_a_;
    leaf_store<triangle_block> of_b_;
};

}  // namespace aabb
