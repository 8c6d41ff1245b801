/// Polygons become triangles. Every decision is exact, on the coordinates as they stand in the mesh.
module aabblab.files:polygon;

import aabb.geometry;
import aabb.std;

namespace aabblab {

/// An exact sum of doubles: parts that do not overlap, the largest last (Shewchuk, "Adaptive precision floating-point
/// arithmetic and fast robust geometric predicates", 1997, grow-expansion).
class exact_sum {
public:
    void clear() noexcept { parts_.clear(); }
    void add(double x);
    /// |a| - |b|
    void set_difference_of_magnitudes(const exact_sum& a, const exact_sum& b);
    [[nodiscard]] int sign() const noexcept;

private:
    std::vector<double> parts_;
};

enum class polygon_shape : std::uint8_t {
    convex,         ///< or of fewer than four corners, once repeated ones are counted once
    concave,        ///< not convex, and its boundary goes once around what it bounds
    no_normal,      ///< the normal is exactly zero
    crosses_itself  ///< parts of the plane are not bounded once
};

/// A polygon is looked at along the dominant axis of its Newell normal (the first one of equals), where it bounds what
/// its boundary winds around. Convex, it is fan-triangulated from its first corner. Concave, it is ear-clipped: corners
/// whose triangle with their neighbours lies in what is left, which then loses this triangle. The result depends on the
/// cycle of corners, not on the first of them; the reversed polygon gets the same triangles, reversed.
///
/// An ear is a corner that turns to the left (seen counter-clockwise), at whose triangle the winding number is 1, and
/// into whose interior no edge of the boundary reaches, so that the number is 1 all over it. Cutting the ear makes it 0
/// there and changes it nowhere else. An ear that no other corner touches is preferred: a simple polygon always has
/// one. So triangles never overlap, and when nothing is left, each point of the plane was wound around once or not at
/// all: that all corners could be cut proves that the boundary does not cross itself. It may touch itself or go back
/// along itself, as it does on the way to a hole (Meisters, "Polygons have ears", 1975; Held, "FIST: fast
/// industrial-strength triangulation of polygons", 2001).
class polygon_cutter {
public:
    /// @param triangles the fan of the polygon from its first corner, n - 2 triangles; replaced where it is concave
    [[nodiscard]] polygon_shape cut(std::span<const aabb::vec3f> vertices,
                                    std::span<std::array<std::uint32_t, 3>> triangles);

private:
    enum class ear : std::uint8_t {
        unknown,
        none,     // as long as its neighbours stay
        touched,  // by another corner, which would come to lie on an edge
        clear
    };
    struct corner {
        aabb::vec3d p;
        std::uint32_t vertex = 0;
        std::uint32_t before = 0;  // the neighbours among the corners that are left
        std::uint32_t next = 0;
        ear kind = ear::unknown;
    };

    [[nodiscard]] std::size_t distinct_corners() const noexcept;
    /// Sets the axis.
    /// @returns the sign of the normal there
    [[nodiscard]] int project();
    /// @param way the sign of the normal
    [[nodiscard]] bool is_convex(int way) const noexcept;
    void begin_at_least_corner();

    [[nodiscard]] int turn(const aabb::vec3d& a, const aabb::vec3d& b, const aabb::vec3d& c) const noexcept;
    /// In the order of the projection, first by one coordinate, then by the other.
    [[nodiscard]] bool precedes(const aabb::vec3d& a, const aabb::vec3d& b) const noexcept;

    /// @returns false where the boundary crosses itself
    [[nodiscard]] bool cut_ears(std::span<std::array<std::uint32_t, 3>> triangles);
    void link() noexcept;
    [[nodiscard]] int turn_at(const corner& b) const noexcept;
    /// The boundary stands still or turns back; its triangle has no area.
    [[nodiscard]] bool is_needle(const corner& b) const noexcept;
    [[nodiscard]] ear kind_of(const corner& b) const noexcept;

    std::vector<corner> corners_;
    std::array<exact_sum, 3> normal_;
    exact_sum difference_;
    int axis_ = 0;
};

}  // namespace aabblab
