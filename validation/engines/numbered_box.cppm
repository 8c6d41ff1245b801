module aabb.engines:numbered_box;

import aabb.geometry;
import aabb.std;

namespace aabb {

/// A box as CGAL's algorithm takes it. Two boxes with one number count as the same box, which is never reported.
/// Coordinates are handed over in double: the algorithm takes the greatest value of their type for infinity, and boxes
/// may end at the greatest float.
struct numbered_box {
    using NT = double;         // NOLINT(readability-identifier-naming)
    using ID = std::uint64_t;  // NOLINT(readability-identifier-naming)

    box bounds;
    ID number;

    static inline int dimension() { return 3; }
    [[nodiscard]] inline ID id() const { return number; }
    [[nodiscard]] inline NT min_coord(int axis) const { return bounds.min[axis]; }
    [[nodiscard]] inline NT max_coord(int axis) const { return bounds.max[axis]; }
};

}  // namespace aabb
