module;
#include <boost/multiprecision/cpp_int.hpp>

module aabb.engines;

import :engine;
import :mesh_engine;

namespace aabb {

namespace {

using integer = boost::multiprecision::cpp_int;

/// A point or vector; unlike those of vec3, its operations may run out of memory.
struct point {
    std::array<integer, 3> at;

    integer& operator[](int k) { return at[static_cast<std::size_t>(k)]; }
    const integer& operator[](int k) const { return at[static_cast<std::size_t>(k)]; }

    friend point operator-(const point& p, const point& q) { return {{p[0] - q[0], p[1] - q[1], p[2] - q[2]}}; }
    friend integer dot(const point& p, const point& q) { return p[0] * q[0] + p[1] * q[1] + p[2] * q[2]; }
    friend point cross(const point& p, const point& q) {
        const auto along = [&](int x, int y) { return integer(p[x] * q[y] - p[y] * q[x]); };
        return {{along(1, 2), along(2, 0), along(0, 1)}};
    }
};

/// x / 2^unit as an integer; 2^unit must divide x. A double is an integer of 53 bits times a power of two.
integer in_units(double x, int unit) {
    int exponent = 0;
    const double fraction = std::frexp(x, &exponent);
    integer units = static_cast<std::int64_t>(std::ldexp(fraction, 53));
    // With a negative shift, the bits below the unit are zeros.
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
int unit_of(std::span<const double> numbers) {
    int unit = std::numeric_limits<int>::max();
    for (const double x : numbers) unit = std::min(unit, last_bit(x));
    return unit == std::numeric_limits<int>::max() ? 0 : unit;
}

struct world_triangle {
    std::array<point, 3> corners;

    [[nodiscard]] const integer& low(int k) const {
        return std::min(std::min(corners[0][k], corners[1][k]), corners[2][k]);
    }
    [[nodiscard]] const integer& high(int k) const {
        return std::max(std::max(corners[0][k], corners[1][k]), corners[2][k]);
    }
};

/// The triangles of a mesh in world coordinates R v + t, in integers of 2^unit.
struct world_mesh {
    std::vector<world_triangle> triangles;
    int unit;

    /// Computes R v + t for each corner. 2^unit divides all products and t, so that the integers are exact.
    world_mesh(const pose& p, std::span<const triangle3d> given) {
        std::vector<double> coordinates;
        for (const triangle3d& t : given)
            for (const vec3d& corner : t.corner)
                coordinates.insert(coordinates.end(), std::begin(corner.at), std::end(corner.at));
        const int unit_of_matrix = unit_of(p.rotation), unit_of_vertices = unit_of(coordinates);
        unit = std::min(unit_of_matrix + unit_of_vertices, unit_of(p.translation.at));
        const auto to_unit = static_cast<unsigned>(unit_of_matrix + unit_of_vertices - unit);
        for (const triangle3d& t : given) {
            world_triangle& world = triangles.emplace_back();
            for (int i = 0; i < 3; ++i)
                for (int k = 0; k < 3; ++k) {
                    integer sum = 0;
                    for (int j = 0; j < 3; ++j)
                        sum += in_units(p.rotation[static_cast<std::size_t>(3 * k + j)], unit_of_matrix) *
                               in_units(t[i][j], unit_of_vertices);
                    world.corners[static_cast<std::size_t>(i)][k] = (sum << to_unit) + in_units(p.translation[k], unit);
                }
        }
    }

    void change_unit(int smaller) {
        for (world_triangle& t : triangles)
            for (point& corner : t.corners)
                for (int k = 0; k < 3; ++k) corner[k] <<= static_cast<unsigned>(unit - smaller);
        unit = smaller;
    }
};

bool boxes_overlap(const world_triangle& s, const world_triangle& t) {
    return std::ranges::all_of(std::array{0, 1, 2},
                               [&](int k) { return s.low(k) <= t.high(k) && t.low(k) <= s.high(k); });
}

/// Whether all projections of `s` on the axis lie on one side of those of `t`.
bool separates(const point& axis, const world_triangle& s, const world_triangle& t) {
    const auto on_axis = [&](const world_triangle& of) {
        return std::array<integer, 3>{dot(axis, of.corners[0]), dot(axis, of.corners[1]), dot(axis, of.corners[2])};
    };
    const std::array<integer, 3> of_s = on_axis(s), of_t = on_axis(t);
    return std::ranges::max(of_s) < std::ranges::min(of_t) || std::ranges::max(of_t) < std::ranges::min(of_s);
}

/// Axes that include a separating one if `s` and `t` are disjoint, also if they degenerate to segments or points:
/// normals of the Minkowski difference, by its dimension:
/// - 3: the normals of its facets, each a cross product of two edges;
/// - 2: the normal of its plane, again a cross product, and in the plane the normals of its edges;
/// - 1: its direction, which is an edge, and the part of `between` that is perpendicular to it;
/// - 0: `between`, the vector between two corners.
std::vector<point> candidate_axes(const world_triangle& s, const world_triangle& t) {
    std::vector<point> edges;
    for (const world_triangle* const of : {&s, &t})
        for (std::size_t i = 0; i < 3; ++i) edges.push_back(of->corners[(i + 1) % 3] - of->corners[i]);
    std::vector<point> axes;
    bool has_volume = false;  // dimension 3
    for (std::size_t i = 0; i < edges.size(); ++i)
        for (std::size_t j = i + 1; j < edges.size(); ++j) {
            axes.push_back(cross(edges[i], edges[j]));
            for (const point& edge : edges) has_volume = has_volume || dot(axes.back(), edge) != 0;
        }
    if (!has_volume) {
        const std::vector<point> normals = axes;
        for (const point& normal : normals)
            for (const point& edge : edges) axes.push_back(cross(normal, edge));
        const point between = t.corners[0] - s.corners[0];
        axes.push_back(between);
        for (const point& edge : edges) {
            axes.push_back(edge);
            axes.push_back(cross(edge, cross(between, edge)));
        }
    }
    return axes;
}

bool intersect(const world_triangle& s, const world_triangle& t) {
    const std::vector<point> axes = candidate_axes(s, t);
    return std::ranges::none_of(axes, [&](const point& axis) { return separates(axis, s, t); });
}

/// Passes each intersecting pair of triangles to `emit`, until it returns true. Both meshes are integers of one unit.
template <class Emit>
void for_each_pair(const pose_pair& poses, std::span<const triangle3d> of_a, std::span<const triangle3d> of_b,
                   Emit emit) {
    world_mesh a(poses.a, of_a), b(poses.b, of_b);
    const int unit = std::min(a.unit, b.unit);
    a.change_unit(unit);
    b.change_unit(unit);
    for (std::uint32_t s = 0; s < a.triangles.size(); ++s)
        for (std::uint32_t t = 0; t < b.triangles.size(); ++t)
            if (boxes_overlap(a.triangles[s], b.triangles[t]) && intersect(a.triangles[s], b.triangles[t]) &&
                emit(index_pair{s, t}))
                return;
}

/// A mesh as it is given.
struct given_model : engine_model {
    std::vector<triangle3d> triangles{};

    [[nodiscard]] std::size_t bytes() const { return bytes_of(triangles); }
};

class integer_engine final : public model_engine<given_model> {
    void update_model(given_model& changed) override {
        changed.triangles.clear();
        for (std::uint32_t t = 0; t < changed.count; ++t)
            changed.triangles.push_back(changed.source->given_triangle(t));
    }
    /// Rejects what a composed stage rejects, though integers need no frame.
    static void require_valid_poses(const model_query& q) {
        (void)relative_pose(q.pose_a, q.pose_b, q.b.bounds, q.a.source->frame, q.b.source->frame);
    }
    void append_pairs(const model_query& q, std::vector<index_pair>& pairs) override {
        require_valid_poses(q);
        for_each_pair({q.pose_a, q.pose_b}, q.a.triangles, q.b.triangles, [&](index_pair pair) {
            pairs.push_back(pair);
            return false;
        });
    }
    [[nodiscard]] std::optional<index_pair> any_pair(const model_query& q) override {
        require_valid_poses(q);
        std::optional<index_pair> first;
        for_each_pair({q.pose_a, q.pose_b}, q.a.triangles, q.b.triangles, [&](index_pair pair) {
            first = pair;
            return true;
        });
        return first;
    }
};

}  // namespace

bool intersect_in_integers(const pose_pair& poses, const triangle3d& s, const triangle3d& t) {
    bool do_intersect = false;
    for_each_pair(poses, std::span(&s, 1), std::span(&t, 1), [&](index_pair) { return do_intersect = true; });
    return do_intersect;
}

engine boost_integers_engine() {
    return {.name = "boost_integers",
            .summary =
                "every pair of triangles by separating axes, in Boost's integers of any size: shares no code with "
                "another method, but is slow",
            .meshes = make_stage<local_stage, integer_engine>};
}

}  // namespace aabb
