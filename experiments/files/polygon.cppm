/// Triangulates polygons. Every predicate is exact.
module aabblab.files:polygon;

import aabb.geometry;
import aabb.std;

namespace aabblab {

/// An exact sum of doubles as a nonoverlapping expansion, the largest component last (Shewchuk, "Adaptive precision
/// floating-point arithmetic and fast robust geometric predicates", 1997, grow-expansion).
class exact_sum {
public:
    void clear() noexcept { parts_.clear(); }
    void add(double x);
    void set_difference_of_magnitudes(const exact_sum& a, const exact_sum& b);
    [[nodiscard]] int sign() const noexcept;

private:
    std::vector<double> parts_;
};

enum class polygon_shape : std::uint8_t {
    convex,         ///< or with fewer than four distinct consecutive corners
    concave,        ///< not convex, and its boundary winds once around its interior
    no_normal,      ///< the normal is exactly zero
    crosses_itself  ///< the winding number of some region is neither 0 nor 1
};

/// Projects a polygon along the dominant axis of its Newell normal (the first one of equals). A convex polygon is
/// fan-triangulated from its first corner. A concave polygon is ear-clipped: repeatedly, a corner is cut whose triangle
/// with its neighbours lies inside the remaining polygon. The result depends on the cycle of corners, not on which is
/// first; the reversed polygon yields the same triangles, reversed.
///
/// An ear is a corner that turns left, in counter-clockwise order, whose triangle has winding number 1 and no edge of
/// the boundary in its interior, so that the number is 1 throughout. Cutting the ear makes it 0 there and changes it
/// nowhere else. Ears that no other corner touches are preferred: a simple polygon always has one. Therefore triangles
/// never overlap, and once all corners are cut, each point had winding number 0 or 1, which proves that the boundary
/// does not cross itself. It may touch itself or run back along itself, as does the bridge to a hole (Meisters,
/// "Polygons have ears", 1975; Held, "FIST: fast industrial-strength triangulation of polygons", 2001).
class polygon_cutter {
public:
    /// @param triangles the fan of the polygon from its first corner, n - 2 triangles; replaced if it is concave
    [[nodiscard]] polygon_shape cut(std::span<const aabb::vec3d> vertices,
                                    std::span<std::array<std::uint32_t, 3>> triangles);

private:
    enum class ear : std::uint8_t {
        unknown,
        none,     // no ear as long as its neighbours are the same
        touched,  // an ear, but another corner would lie on the new edge
        clear
    };
    struct corner {
        aabb::vec3d p;
        std::uint32_t vertex = 0;
        std::uint32_t before = 0;  // the neighbours among the remaining corners
        std::uint32_t next = 0;
        ear kind = ear::unknown;
    };

    [[nodiscard]] std::size_t distinct_corners() const noexcept;
    [[nodiscard]] int project();
    [[nodiscard]] bool is_convex(int orientation) const noexcept;
    /// Rotates the cycle to start at a canonical corner, so that the result does not depend on the first one.
    void begin_at_least_corner();

    [[nodiscard]] int turn(const aabb::vec3d& a, const aabb::vec3d& b, const aabb::vec3d& c) const noexcept;
    /// Lexicographic order of the projected points.
    [[nodiscard]] bool precedes(const aabb::vec3d& a, const aabb::vec3d& b) const noexcept;

    [[nodiscard]] bool cut_ears(std::span<std::array<std::uint32_t, 3>> triangles);
    void link_neighbours() noexcept;
    [[nodiscard]] int turn_at(const corner& b) const noexcept;
    /// Whether the boundary stops or reverses at the corner, so that its triangle has no area.
    [[nodiscard]] bool is_needle(const corner& b) const noexcept;
    [[nodiscard]] ear kind_of(const corner& b) const noexcept;

    std::vector<corner> corners_;
    std::array<exact_sum, 3> normal_;
    exact_sum difference_;
    int axis_ = 0;
};

}  // namespace aabblab
