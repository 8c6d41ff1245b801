export module aabb.counters;

import aabb.std;

export namespace aabb {

/// What the work of a run is counted in. The names are the CSV columns.
enum class work : std::uint8_t {
    comparisons,         ///< key comparisons of the sort, and of bringing what it sorted back into the list
    moves,               ///< entries of lists moved by the same
    inversions,          ///< pairs in the wrong order in the lists handed to the sort
    restarts,            ///< times that a sweep gave up following swaps and started anew
    box_tests,           ///< overlap tests of two boxes, full or on the axes left
    subsets,             ///< subsets that the partition made, empty ones too
    subset_copies,       ///< entries of boxes in subsets of the partition
    segments_wanted,     ///< into which an axial cut was to cut its axes, summed over the axes
    segments_got,        ///< and into which it did
    pieces,              ///< that split_large made of boxes, split_mesh of meshes, of those that it split
    node_visits,         ///< pairs of tree nodes taken from the stack
    triangle_box_tests,  ///< tests of a leaf's triangle against a box
    triangle_tests,      ///< tests of two triangles
};

inline constexpr std::array<std::string_view, 13> work_names = {
    "comparisons",   "moves",           "inversions",   "restarts", "box_tests",   "subsets",
    "subset_copies", "segments_wanted", "segments_got", "pieces",   "node_visits", "triangle_box_tests",
    "triangle_tests"};

/// Counts nothing and costs nothing: what timing runs are made with.
struct no_counters {
    static constexpr bool enabled = false;
    static constexpr void add(work, std::uint64_t = 1) noexcept {}
    [[nodiscard]] constexpr std::uint64_t operator[](work) const noexcept { return 0; }
};

/// Counts every kind of work; for passes that are not timed.
struct work_counters {
    static constexpr bool enabled = true;
    std::array<std::uint64_t, work_names.size()> counts{};

    constexpr void add(work what, std::uint64_t times = 1) noexcept { counts[static_cast<std::size_t>(what)] += times; }
    [[nodiscard]] constexpr std::uint64_t operator[](work what) const noexcept {
        return counts[static_cast<std::size_t>(what)];
    }
};

/// What was counted, whatever the policy.
[[nodiscard]] constexpr work_counters work_of(const work_counters& counters) noexcept {
    return counters;
}
[[nodiscard]] constexpr work_counters work_of(const no_counters& /*counters*/) noexcept {
    return {};
}

/// A policy that receives the work done.
template <class C>
concept CounterPolicy = requires(C counters, work what) {
    { C::enabled } -> std::convertible_to<bool>;
    counters.add(what);
    counters.add(what, std::uint64_t{2});
};

}  // namespace aabb
