export module aabb.policy:omission;

import aabb.std;

export namespace aabb {

/// A feature that a stage may lack.
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
    {"partition", "sort", "sorted intervals on x", "sorted intervals on y", "sorted intervals on z",
     "sorted intervals beside those of the sweep itself", "Verlet list", "division of large objects", "narrow phase",
     "boxes of single triangles", "node indices", "work counters"});
static_assert(absence_texts.size() == static_cast<std::size_t>(absence::counters) + 1);

[[nodiscard]] inline std::string to_text(absence feature) {
    return std::string(absence_texts[static_cast<std::size_t>(feature)]);
}

/// A feature that a stage lacks, and the reason.
struct omission {
    absence feature;
    std::string_view reason{};  ///< must outlive this object; empty if the strategy never has the feature

    bool operator==(const omission&) const = default;
};
/// "sort: so few boxes are tested by brute force"
[[nodiscard]] inline std::string to_text(const omission& o) {
    return to_text(o.feature) + (o.reason.empty() ? "" : ": ") + std::string(o.reason);
}

}  // namespace aabb
