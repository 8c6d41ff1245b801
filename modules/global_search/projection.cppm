export module aabb.global_search:projection;

import aabb.geometry;
import aabb.std;

export namespace aabb {

/// An entry of a projection list: the lower end of an object's interval on one axis.
struct projection {
    float key;
    std::uint32_t id;
};
static_assert(sizeof(projection) == 8);

/// The order of projections in a list. Equal keys may have any order.
[[nodiscard]] constexpr bool precedes(const projection& p, const projection& q) noexcept {
    return p.key < q.key;
}

/// A set of axes; bit k stands for axis k.
using axis_set = std::uint32_t;
inline constexpr axis_set every_axis = 0b111;

[[nodiscard]] constexpr bool has_axis(axis_set axes, std::size_t axis) noexcept {
    return (axes >> axis & 1U) != 0;
}

/// All objects of a frame as one subset: the boxes by id, and per axis a list of entries sorted by lower end, which is
/// empty for an axis that no strategy needs.
struct whole_subset {
    using entry = projection;
    std::span<const box> boxes;
    std::array<std::span<const projection>, 3> lists;

    /// The only subset owns every pair.
    static constexpr bool owns(axis_set, axis_set) noexcept { return true; }
    static constexpr axis_set owned(const projection&) noexcept { return every_axis; }
};

/// A copy of an object in one subset of a partition. Bit k of `owned` is set if the object's lower end on axis k lies
/// in this subset's segment of that axis.
struct subset_entry {
    std::uint32_t id;
    axis_set owned;
};

struct partition_subset {
    using entry = subset_entry;
    std::span<const box> boxes;
    std::array<std::span<const subset_entry>, 3> lists;

    /// A subset owns a pair if the greater of the two lower ends lies in it on every axis. Since both boxes overlap the
    /// subset, this holds if either lower end lies in it. No set of pairs is needed to remove duplicates.
    static constexpr bool owns(axis_set a, axis_set b) noexcept { return (a | b) == every_axis; }
    static constexpr axis_set owned(const subset_entry& e) noexcept { return e.owned; }
};

}  // namespace aabb
