export module aabb.counters;

import aabb.std;

export namespace aabb {

/// The kinds of counted work. Their names are CSV columns.
enum class work : std::uint8_t {
    comparisons,         ///< key comparisons of the sort, and of merging the sorted entries into the list
    moves,               ///< entries of lists moved by the same
    inversions,          ///< inversions in the lists passed to the sort
    restarts,            ///< frames in which a sweep stopped following swaps and restarted
    box_tests,           ///< overlap tests of two boxes, on all or the remaining axes
    subsets,             ///< subsets of the partition, including empty ones
    subset_copies,       ///< entries of boxes in subsets of the partition
    segments_wanted,     ///< desired segments of an axial cut, summed over the axes
    segments_got,        ///< actual segments of an axial cut, summed over the axes
    pieces,              ///< pieces of the boxes divided by split_large, or of the meshes divided by split_mesh
    node_visits,         ///< pairs of tree nodes taken from the stack
    triangle_box_tests,  ///< tests of a leaf's triangle against a box
    triangle_tests,      ///< tests of two triangles
};

inline constexpr std::array<std::string_view, 13> work_names = {
    "comparisons",   "moves",           "inversions",   "restarts", "box_tests",   "subsets",
    "subset_copies", "segments_wanted", "segments_got", "pieces",   "node_visits", "triangle_box_tests",
    "triangle_tests"};

/// Counts nothing at no cost, for timed runs.
struct no_counters {
    static constexpr bool enabled = false;
    static constexpr void add(work, std::uint64_t = 1) noexcept {}
    [[nodiscard]] constexpr std::uint64_t operator[](work) const noexcept { return 0; }
};

/// Counts all kinds of work, for runs that are not timed.
struct work_counters {
    static constexpr bool enabled = true;
    std::array<std::uint64_t, work_names.size()> counts{};

    constexpr void add(work kind, std::uint64_t times = 1) noexcept { counts[static_cast<std::size_t>(kind)] += times; }
    [[nodiscard]] constexpr std::uint64_t operator[](work kind) const noexcept {
        return counts[static_cast<std::size_t>(kind)];
    }
};

[[nodiscard]] constexpr work_counters work_of(const work_counters& counters) noexcept {
    return counters;
}
[[nodiscard]] constexpr work_counters work_of(const no_counters& /*counters*/) noexcept {
    return {};
}

template <class C>
concept CounterPolicy = requires(C counters, work kind) {
    { C::enabled } -> std::convertible_to<bool>;
    counters.add(kind);
    counters.add(kind, std::uint64_t{2});
};

}  // namespace aabb
