module;
// Not aabb.std: with CGAL's headers, clang 19 cannot instantiate all of its exports.
#include <memory>

/// The exact intersection of triangles.
export module aabb.exact_intersection;

import aabb.geometry;

export namespace aabb {

/// The errors of the corners of a computed intersection.
struct corner_errors {
    bool same = false;    ///< kind and number of corners agree; otherwise the rest is unset
    bool within = false;  ///< no coordinate exceeds the stated error, compared exactly
    /// The greatest ratio of a coordinate's error to the stated error; infinite if the latter is zero.
    double of_bound = 0;
    double greatest = 0;  ///< the greatest error of a coordinate
    double bound = 0;     ///< the stated error of that coordinate
};

/// The intersection of two closed triangles (segments or points if degenerate) by CGAL's kernel of exact constructions.
class exact_intersection {
public:
    exact_intersection(const triangle3d& s, const triangle3d& t) : exact_intersection({}, s, t) {}
    /// The same for triangles of meshes at poses, in world coordinates R v + t.
    exact_intersection(const pose_pair& poses, const triangle3d& s, const triangle3d& t);
    ~exact_intersection();

    [[nodiscard]] intersection_kind kind() const;

    /// Corners rounded once. The stated error is the gap of the doubles around a coordinate, or 0 if all are doubles.
    [[nodiscard]] triangle_intersection rounded() const;

    /// Compares corners in their order around the polygon, for any first corner and either orientation.
    [[nodiscard]] corner_errors errors_of(const triangle_intersection& computed) const;

private:
    struct construction;
    std::unique_ptr<construction> construction_;
};

}  // namespace aabb
