module;
// With CGAL's headers beside it, clang 19 cannot instantiate all that aabb.std exports.
#include <memory>

/// What triangles have in common, exactly.
export module aabb.exact_intersection;

import aabb.geometry;

export namespace aabb {

/// How far the corners of a computed intersection lie from the exact ones.
struct corner_errors {
    bool same = false;    ///< kind and number of corners agree; without that nothing else is known
    bool within = false;  ///< no coordinate is off by more than the stated error, compared without rounding
    /// The greatest error of a coordinate over the stated one; infinite where none is stated and there is one.
    double of_bound = 0;
    double greatest = 0;  ///< the greatest error of a coordinate
    double bound = 0;     ///< that is stated for that coordinate
};

/// What two closed triangles have in common, with nothing rounded, by CGAL's kernel with exact constructions; zero-area
/// triangles as the segments or points they are.
class exact_intersection {
public:
    exact_intersection(const triangle3d& s, const triangle3d& t);
    ~exact_intersection();

    [[nodiscard]] intersection_kind kind() const;

    /// Corners rounded once: the stated error is the distance of the doubles on both sides of a coordinate, 0 where all
    /// corners are doubles.
    [[nodiscard]] triangle_intersection rounded() const;

    /// Corners are held against each other as they stand around the polygon, from whichever it begins and whichever way
    /// it runs.
    [[nodiscard]] corner_errors errors_of(const triangle_intersection& computed) const;

private:
    struct construction;
    std::unique_ptr<construction> made_;
};

}  // namespace aabb
