module;
#include <boost/multiprecision/cpp_int.hpp>

module aabb.truth;

namespace aabb {

namespace {

using integer = boost::multiprecision::cpp_int;
using point = vec3<integer>;

/// x / 2^unit, for a unit that divides x.
integer in_units(double x, int unit) {
    int exponent = 0;
    const double fraction = std::frexp(x, &exponent);
    integer units = static_cast<std::int64_t>(std::ldexp(fraction, 53));
    // Zeros at the end may lie below the unit.
    const int shift = exponent - 53 - unit;
    return shift >= 0 ? integer(units << static_cast<unsigned>(shift))
                      : integer(units / (integer(1) << static_cast<unsigned>(-shift)));
}

/// The exponent of the last bit of x that is set; the greatest number for 0.
int last_bit(double x) {
    if (x == 0) return std::numeric_limits<int>::max();
    int exponent = 0;
    const auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(x, &exponent), 53));
    return exponent - 53 + std::countr_zero(static_cast<std::uint64_t>(mantissa));
}

/// The common unit of some numbers; 0 if all are 0.
template <class Numbers>
int unit_of(const Numbers& numbers) {
    int unit = std::numeric_limits<int>::max();
    for (const double x : numbers) unit = std::min(unit, last_bit(x));
    return unit == std::numeric_limits<int>::max() ? 0 : unit;
}

struct exact_triangle {
    std::array<point, 3> corners;
    int unit;
};

/// R v + t in integers, and their unit.
exact_triangle in_world(const pose& p, const triangle3d& t) {
    std::vector<double> coordinates;
    for (int i = 0; i < 3; ++i) coordinates.insert(coordinates.end(), std::begin(t[i].at), std::end(t[i].at));
    const int unit_of_matrix = unit_of(p.rotation), unit_of_vertices = unit_of(coordinates);
    const int unit = std::min(unit_of_matrix + unit_of_vertices, unit_of(p.translation.at));
    const auto to_unit = static_cast<unsigned>(unit_of_matrix + unit_of_vertices - unit);
    exact_triangle world{{}, unit};
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) {
            integer sum = 0;
            for (int j = 0; j < 3; ++j)
                sum += in_units(p.rotation[static_cast<std::size_t>(3 * k + j)], unit_of_matrix) *
                       in_units(t[i][j], unit_of_vertices);
            world.corners[static_cast<std::size_t>(i)][k] = (sum << to_unit) + in_units(p.translation[k], unit);
        }
    return world;
}

/// Whether all projections of `s` on the axis lie on one side of those of `t`.
bool separates(const point& axis, const std::array<point, 3>& s, const std::array<point, 3>& t) {
    const std::array<integer, 3> of_s{dot(axis, s[0]), dot(axis, s[1]), dot(axis, s[2])};
    const std::array<integer, 3> of_t{dot(axis, t[0]), dot(axis, t[1]), dot(axis, t[2])};
    return std::ranges::max(of_s) < std::ranges::min(of_t) || std::ranges::max(of_t) < std::ranges::min(of_s);
}

}  // namespace

/// Triangles, segments and points are disjoint exactly if the normal of a facet of their Minkowski difference separates
/// them, or if the origin is not in the affine hull of that difference. A difference of dimension 3 has facets that two
/// edges span; one of dimension 2, such a normal of its plane, and in it normals of one edge; one on a line, the edge,
/// and what of the way between two corners is perpendicular to it; and a point, that way.
bool intersect_in_integers(const pose_pair& poses, const triangle3d& s, const triangle3d& t) {
    exact_triangle a = in_world(poses.a, s), b = in_world(poses.b, t);
    const int unit = std::min(a.unit, b.unit);
    for (exact_triangle* const of : {&a, &b})
        for (point& p : of->corners)
            for (int k = 0; k < 3; ++k) p[k] <<= static_cast<unsigned>(of->unit - unit);
    const point between = b.corners[0] - a.corners[0];
    std::vector<point> edges;
    for (const exact_triangle* const of : {&a, &b})
        for (std::size_t i = 0; i < 3; ++i) edges.push_back(of->corners[(i + 1) % 3] - of->corners[i]);
    std::vector<point> axes{between};
    for (const point& edge : edges) {
        axes.push_back(edge);
        axes.push_back(cross(edge, cross(between, edge)));
        for (const point& other : edges) {
            const point normal = cross(edge, other);
            axes.push_back(normal);
            for (const point& in_plane : edges) axes.push_back(cross(normal, in_plane));
        }
    }
    return std::ranges::none_of(axes, [&](const point& axis) { return separates(axis, a.corners, b.corners); });
}

}  // namespace aabb
