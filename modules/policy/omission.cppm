export module aabb.policy:omission;

import aabb.std;

export namespace aabb {

/// What a stage may do without.
enum class absence : std::uint8_t {
    partition,
    sort,
    x_list,
    y_list,
    z_list,
    other_lists,
    neighbour_list,
    division,
    local_detection,
    triangle_boxes,
    node_indices,
    counters
};

inline constexpr std::array absence_texts = std::to_array<std::string_view>(
    {"no partition", "no sort", "no projection list of the x axis", "no projection list of the y axis",
     "no projection list of the z axis", "no projection lists beside those that the sweep keeps for itself",
     "no list of neighbours", "no division of large objects", "no local detection", "no boxes of single triangles",
     "no indices of nodes", "no work counters"});
static_assert(absence_texts.size() == static_cast<std::size_t>(absence::counters) + 1);

[[nodiscard]] inline std::string to_text(absence what) {
    return std::string(absence_texts[static_cast<std::size_t>(what)]);
}

/// What a stage does without, and why.
struct omission {
    absence what;
    std::string_view why{};  ///< that outlives it; empty where it is how the strategy is made

    bool operator==(const omission&) const = default;
};
/// "no sort: so few boxes are tested each against each"
[[nodiscard]] inline std::string to_text(const omission& one) {
    return to_text(one.what) + (one.why.empty() ? "" : ": ") + std::string(one.why);
}

}  // namespace aabb
