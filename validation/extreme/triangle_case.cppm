export module aabb.extreme:triangle_case;

import aabb.geometry;
import aabb.std;

export namespace aabb {

/// Two triangles that somebody found hard, and whether they intersect.
struct triangle_case {
    std::string name;
    std::string source;  ///< where it comes from
    std::string about;   ///< what is hard about it
    std::string kind;    ///< cases of one kind are told together
    triangle3d first;
    triangle3d second;
    bool intersect = false;  ///< with coordinates rounded to float
    bool intersect_double = false;
};

/// The two triangles as every order of their corners and both orders of themselves name them: 72 pairs.
/// @tparam Real float or double, to which coordinates are rounded
template <class Real>
[[nodiscard]] std::vector<triangle_pair<Real>> every_order(const triangle_case& one);

}  // namespace aabb
